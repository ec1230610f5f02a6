#include "pipeline/frame/render_frame.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "composite/film/film.h"
#include "pipeline/frame/cost/frame_recorder.h"
#include "pipeline/frame/film_readers.h"
#include "pipeline/frame/frame_checks.h"
#include "pipeline/frame/frame_memory.h"
#include "pipeline/frame/make_grids.h"
#include "pipeline/frame/post_effects.h"
#include "pipeline/frame/regions.h"
#include "pipeline/frame/tiles/resolve_tiles.h"
#include "pipeline/rays/light_meshes.h"
#include "pipeline/rays/ray_world.h"
#include "sample/visibility.h"
#include "shade/shading.h"

namespace trapeze {
namespace {

/// What all regions of a frame share.
struct FrameSetup {
    const RenderContext& asked;    ///< without the margin that glows into the picture
    const RenderContext& context;  ///< with it
    const Tessellation& tessellation;
    Shading& shading;
    const Sampler& sampler;
    const SamplePattern& pattern;
    size_t memory_budget;     ///< bytes, of a region's grids and tree
    bool leave_gamma;         ///< to what comes after the film
    CullHidden culls_hidden;  ///< before shading; not Auto where no shader traces rays
    int regions_at_least;
    FilmKeeper* keeper;    ///< null: nobody keeps
    FilmWatcher* watcher;  ///< null: nobody watches
};

/// Splits the scene's surfaces, within their bounds, into subpatches: each becomes a grid.
Tessellation bound_and_split(const RenderContext& context, const Shading& shading, size_t most_bytes) {
    TessellationOptions wanted;
    wanted.depth_heights = shading.depth_heights(), wanted.most_bytes = most_bytes;
    wanted.is_displaced = shading.displacing_surfaces();
    return Tessellation(context, wanted);
}

/// What rays of shaders meet, the lights' shapes among it; null where no shader traces any.
std::unique_ptr<RayWorld> prepare_rays(const RenderContext& context, Shading& shading, size_t most_bytes) {
    make_light_meshes(context, shading, most_bytes);
    std::unique_ptr<RayWorld> rays = make_ray_world(context, shading, most_bytes);
    shading.set_rays(rays.get());
    return rays;
}

/// The keeper of finished tiles, or null where there is none, or what they leave beside the picture would be
/// lost: a point cloud is of all grids.
FilmKeeper* keeper_of(const RenderSettings& settings, const Shading& shading) {
    if (!settings.keeper || settings.tile || !shading.may_bake()) return settings.keeper;
    settings.keeper->give_up("a shader may bake a point cloud, which must see all of the frame");
    return nullptr;
}

LayerLimits layer_limits(const FrameSetup& frame) {
    return LayerLimits::of(frame.context.most_layers, hit_list_bytes(frame.memory_budget),
                           tbb::this_task_arena::max_concurrency());
}

/// What is left to do of a film, in parts that fit the memory.
std::vector<Region> regions_of(const FrameSetup& frame, const Film& film) {
    const Options& options = frame.context.scene->options;
    const AwaitedTiles awaited = film.awaited_tiles();
    return split_into_regions(sampled_pixels(frame.context.camera, options), frame.tessellation.subpatches(),
                              {frame.memory_budget, frame.regions_at_least, aov_layout(options).channel_count,
                               &awaited, frame.sampler.build_memory()});
}

/// Takes out of a region what none of its samples sees, if that is wanted.
void cull_region(const FrameSetup& frame, Region& region, FrameRecorder& recorder) {
    if (frame.culls_hidden == CullHidden::Off) return;
    recorder.begin_cull();
    recorder.timed(&StageSeconds::cull, [&] {
        leave_out_hidden(frame.context, region, frame.tessellation, frame.shading, frame.sampler,
                         frame.pattern, layer_limits(frame), frame.culls_hidden == CullHidden::On,
                         recorder.stats());
    });
}

/// What the visibility method makes of a region's grids, a tree for one, to find what samples see.
std::unique_ptr<Visibility> build_region(const FrameSetup& frame, const PixelRect& pixels, const Grids& grids,
                                         FrameRecorder& recorder) {
    recorder.begin_build();
    check_region_memory(frame.context, pixels, grids.bytes() + frame.sampler.build_memory().bytes(grids),
                        frame.memory_budget);
    std::unique_ptr<Visibility> visibility =
        recorder.timed(&StageSeconds::build, [&] { return frame.sampler.prepare(frame.context, grids); });
    recorder.built(grids.bytes(), visibility->build_stats());
    return visibility;
}

/// Samples a region's pixels, tile by tile, and composites what samples see into the film.
void sample_region(const FrameSetup& frame, const PixelRect& pixels, const Grids& grids,
                   const Visibility& visibility, FrameRecorder& recorder, Film& film) {
    const bool adaptive = frame.pattern.levels() != nullptr;
    recorder.begin_tiles(tiles_of(pixels, adaptive ? kTileSide : visibility.tile_side()).size());
    resolve_tiles(frame.context, pixels, grids, visibility, frame.pattern, film, recorder.stats(),
                  [&recorder] { recorder.progress().step(); },
                  {layer_limits(frame), frame.watcher ? TileOrder::CoarseFirst : TileOrder::Rows});
}

/// Dices, shades and samples region after region. False when cancelled, or when a shader was found to be
/// endless: its loops end early from now on, so that regions before this one would be of another shader.
bool add_regions(const FrameSetup& frame, const std::vector<Region>& regions, FrameRecorder& recorder,
                 Film& film) {
    for (size_t r = 0; r < regions.size() && !frame.context.is_cancelled(); ++r) {
        Region region = regions[r];
        cull_region(frame, region, recorder);
        recorder.begin_grids(r, regions.size(), region.subpatches.size());
        const Grids grids = make_grids(frame.context, region, frame.tessellation, frame.shading,
                                       recorder.stats(), recorder.progress());
        if (frame.shading.found_endless_loops()) return false;
        if (frame.context.is_cancelled()) return false;
        const std::unique_ptr<Visibility> visibility = build_region(frame, region.pixels, grids, recorder);
        sample_region(frame, region.pixels, grids, *visibility, recorder, film);
    }
    return !frame.context.is_cancelled();
}

/// The film with all regions in it; null when cancelled, or when the keeper refuses. A frame whose shader is
/// found to be endless begins anew with that known, and then nobody keeps it.
std::unique_ptr<Film> film_of_regions(const FrameSetup& frame, FrameRecorder& recorder) {
    FilmKeeper* keeper = frame.keeper;
    while (!frame.context.is_cancelled()) {
        auto film = std::make_unique<Film>(frame.context, false, frame.leave_gamma);
        if (keeper && !keeper->begin(*film)) return {};
        FilmReaders readers(*film, frame.asked, keeper, frame.watcher);
        const std::vector<Region> regions = regions_of(frame, *film);
        recorder.stats().regions = static_cast<int>(regions.size());
        recorder.stats().shows_something = film->took_something();
        const bool is_whole = add_regions(frame, regions, recorder, *film);
        const bool is_endless = !is_whole && !frame.context.is_cancelled();
        if (keeper && is_endless) keeper->give_up("a shader's loops are endless");
        readers.end(frame.context.is_cancelled());
        if (is_whole) return film;
        keeper = nullptr;
        recorder.restart();
    }
    return {};
}

/// What shading leaves beside the picture, once all grids are shaded.
void finish_shading(Shading& shading, const RenderSettings& settings) {
    shading.report_displacement_bounds();
    // A point cloud is of all that the picture sees, of which a tile has a part.
    if (settings.tile)
        shading.leave_out_bakes();
    else
        shading.write_bakes();
}

FrameStats stats_of(FrameRecorder& recorder, const RenderContext& context, const RenderSettings& settings,
                    const Sampler& sampler, const RayWorld* rays) {
    FrameStats stats = recorder.finish(context);
    stats.sampler = sampler.name();
    stats.tile = settings.tile;
    if (rays) {
        stats.ray_micropolygons = rays->micropolygon_count();
        stats.ray_micropolygons_made = rays->micropolygons_made();
        stats.ray_bytes = rays->bytes();
        stats.ray_list_bytes = rays->list_bytes();
    }
    return stats;
}

}  // namespace

std::optional<FrameResult> render_frame(const RenderContext& asked, const RenderSettings& settings) {
    if (asked.lacks_colors) return {};
    const std::optional<Sampler> sampler = sampler_for(asked, settings);
    if (!sampler) return {};
    const PostEffects effects(asked, *settings.access);
    const RenderContext& context = effects.context();
    if (!picture_fits(context, settings)) return {};
    const MemoryBudget memory(settings);
    FrameRecorder recorder(settings.on_progress, settings.on_stage);

    // All of the scene: bounded and split, but neither diced nor shaded yet.
    Shading shading(context, *settings.access);
    shading.limit_clouds(memory.for_clouds());
    const Tessellation tessellation = recorder.timed(
        &StageSeconds::tessellate, [&] { return bound_and_split(context, shading, memory.bytes()); });
    recorder.bounded(tessellation.stats());
    const std::unique_ptr<RayWorld> rays =
        recorder.timed(&StageSeconds::rays, [&] { return prepare_rays(context, shading, memory.bytes()); });

    // Region by region: diced, shaded, built, sampled.
    const std::unique_ptr<SamplePattern> pattern = sampler->make_pattern(context);
    const CullHidden culls_hidden =
        settings.cull_hidden == CullHidden::Auto && !rays ? CullHidden::Off : settings.cull_hidden;
    FilmKeeper* const keeper = keeper_of(settings, shading);
    const int least_regions = std::max(settings.regions_at_least, keeper ? keeper->regions_at_least() : 1);
    const FrameSetup frame{asked,
                           context,
                           tessellation,
                           shading,
                           *sampler,
                           *pattern,
                           memory.for_region(rays != nullptr),
                           effects.takes_gamma(),
                           culls_hidden,
                           least_regions,
                           keeper,
                           settings.watcher};
    const std::unique_ptr<Film> film = film_of_regions(frame, recorder);
    if (!film) return {};
    finish_shading(shading, settings);

    // The picture: resolved from the film's sums of samples.
    FrameResult result;
    recorder.begin_composite();
    const bool is_whole = recorder.timed(&StageSeconds::composite, [&] {
        result.image = film->finish();
        return effects.apply(result.image);
    });
    if (!is_whole) return {};
    if (settings.watcher) settings.watcher->show(result.image, asked);
    note_matte_loss(context, result.image);
    result.stats = stats_of(recorder, context, settings, *sampler, rays.get());
    return result;
}

}  // namespace trapeze
