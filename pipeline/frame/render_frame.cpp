#include "pipeline/frame/render_frame.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "composite/displays/display_plan.h"
#include "composite/mattes/matte_layers.h"
#include "core/scene/adaptive_sampling.h"
#include "core/scene/glow.h"
#include "pipeline/frame/frame_recorder.h"
#include "pipeline/frame/glow_picture.h"
#include "pipeline/frame/make_grids.h"
#include "pipeline/frame/open_colors.h"
#include "pipeline/frame/regions.h"
#include "pipeline/frame/resolve_tiles.h"
#include "pipeline/rays/light_meshes.h"
#include "pipeline/rays/ray_world.h"
#include "sample/visibility.h"
#include "shade/imager.h"
#include "shade/shading.h"

namespace trapeze {
namespace {

constexpr int kPictureChannels = 6;  ///< colour, opacity, depth and a weight or id, of four bytes each
/// Point clouds may take a part of the memory budget, but for small ones so much.
constexpr size_t kLeastCloudBytes = size_t{1} << 26;
constexpr int kPreviewChannels = 5;  ///< colour, opacity and depth, for whoever is watching
constexpr int kGlowChannels = 9;     ///< light spread along rows, three times

/// Lists of hits may take this part of the memory budget, beside a region's grids and tree.
constexpr size_t kListsShare = 8;

/// Bytes of physical memory; two gibibytes where the system does not tell.
size_t machine_memory() {
    const long pages = sysconf(_SC_PHYS_PAGES), page_bytes = sysconf(_SC_PAGE_SIZE);
    if (pages <= 0 || page_bytes <= 0) return size_t{1} << 31;
    return static_cast<size_t>(pages) * static_cast<size_t>(page_bytes);
}

/// Warns of a region that may take more than the budget, before it does: it is a single tile.
void check_memory(const RenderContext& context, const PixelRect& pixels, size_t used, size_t budget) {
    if (used <= budget) return;
    const auto mib = [](size_t bytes) { return std::to_string(bytes >> 20) + " MiB"; };
    context.diagnostics->warning({},
                                 "a region of " + std::to_string(pixels.width()) + "x" +
                                     std::to_string(pixels.height()) + " pixels may take " + mib(used) +
                                     " for grids and tree, more than the budget of " + mib(budget),
                                 "memory-budget");
}

/// Runs the imager shader over all pixels, a row at a time in parallel.
void run_imager(const Imager& imager, Image& image) {
    if (!imager.is_there()) return;
    const PixelRect& window = image.window;
    tbb::parallel_for(window.y0, window.y1, [&](int y) {
        imager.run(window.x0, y, window.width(), image.rgba.data() + 4 * image.index(window.x0, y));
    });
}

/// What all regions of a frame use.
struct Frame {
    const RenderContext& context;
    const Tessellation& tessellation;
    Shading& shading;
    const Sampler& sampler;
    const SamplePattern& pattern;
    size_t memory_budget;  ///< bytes, of a region's grids and tree
    bool leave_gamma;      ///< to what comes after the film
    bool culls_hidden;     ///< before shading
    int regions_at_least;
    FilmWatcher* watcher;        ///< null: nobody watches
    const RenderContext& asked;  ///< without the margin that glows into the picture
};

LayerLimits layer_limits(const Frame& frame) {
    return LayerLimits::of(frame.context.most_layers, frame.memory_budget / kListsShare,
                           tbb::this_task_arena::max_concurrency());
}

/// The keeper of finished tiles, or null where there is none, or what they leave beside the picture would be
/// lost: a point cloud is of all grids.
FilmKeeper* keeper_of(const RenderSettings& settings, const Shading& shading) {
    if (!settings.keeper || settings.tile || !shading.may_bake()) return settings.keeper;
    settings.keeper->give_up("a shader may bake a point cloud, which must see all of the frame");
    return nullptr;
}

/// Adds what samples see of the grids of their region to the film.
void sample_region(const Frame& frame, const PixelRect& pixels, const Grids& grids, FrameRecorder& recorder,
                   Film& film) {
    recorder.begin_build();
    check_memory(frame.context, pixels, grids.bytes() + frame.sampler.build_memory().bytes(grids),
                 frame.memory_budget);
    const std::unique_ptr<Visibility> visibility =
        recorder.timed(&StageSeconds::build, [&] { return frame.sampler.prepare(frame.context, grids); });
    const BuildStats build = visibility->build_stats();
    recorder.built(grids.bytes(), build);

    const bool adaptive = frame.pattern.levels() != nullptr;
    recorder.begin_tiles(tiles_of(pixels, adaptive ? kTileSide : visibility->tile_side()).size());
    resolve_tiles(frame.context, pixels, grids, *visibility, frame.pattern, film, recorder.stats(),
                  [&recorder] { recorder.progress().step(); },
                  {layer_limits(frame), frame.watcher ? TileOrder::CoarseFirst : TileOrder::Rows});
}

/// Dices, shades and samples region after region. False when cancelled, or when a shader was found to be
/// endless: its loops end early from now on, so that regions before this one would be of another shader.
bool add_regions(const Frame& frame, const std::vector<Region>& regions, FrameRecorder& recorder,
                 Film& film) {
    for (size_t r = 0; r < regions.size() && !frame.context.is_cancelled(); ++r) {
        Region region = regions[r];
        if (frame.culls_hidden) {
            recorder.begin_cull();
            recorder.timed(&StageSeconds::cull, [&] {
                leave_out_hidden(frame.context, region, frame.tessellation, frame.shading, frame.sampler,
                                 frame.pattern, layer_limits(frame), recorder.stats());
            });
        }
        recorder.begin_grids(r, regions.size(), region.subpatches.size());
        const Grids grids = make_grids(frame.context, region, frame.tessellation, frame.shading,
                                       recorder.stats(), recorder.progress());
        if (frame.shading.found_endless_loops()) return false;
        if (!frame.context.is_cancelled()) sample_region(frame, region.pixels, grids, recorder, film);
    }
    return !frame.context.is_cancelled();
}

/// What is left to do of a film, in parts that fit the memory.
std::vector<Region> regions_of(const Frame& frame, const Film& film) {
    const Options& options = frame.context.scene->options;
    const AwaitedTiles awaited = film.awaited_tiles();
    return split_into_regions(sampled_pixels(frame.context.camera, options), frame.tessellation.subpatches(),
                              {frame.memory_budget, frame.regions_at_least, aov_layout(options).channel_count,
                               &awaited, frame.sampler.build_memory()});
}

/// Whoever may read the film while regions are added to it: no longer than that, even where memory runs out.
class FilmReaders {
  public:
    /// The keeper has begun the film already.
    FilmReaders(const Frame& frame, const Film& film, FilmKeeper* keeper)
        : keeper_(keeper), watcher_(frame.watcher) {
        if (watcher_) watcher_->begin(film, frame.asked);
    }
    ~FilmReaders() { end(true); }
    FilmReaders(const FilmReaders&) = delete;
    FilmReaders& operator=(const FilmReaders&) = delete;

    void end(bool is_cancelled) noexcept {
        if (watcher_) watcher_->end();
        if (keeper_) keeper_->end(is_cancelled);
        watcher_ = nullptr, keeper_ = nullptr;
    }

  private:
    FilmKeeper* keeper_;
    FilmWatcher* watcher_;
};

/// The film with all regions in it; null when cancelled, or when the keeper refuses.
std::unique_ptr<Film> film_of_regions(const Frame& frame, FilmKeeper* keeper, FrameRecorder& recorder) {
    while (!frame.context.is_cancelled()) {
        auto film = std::make_unique<Film>(frame.context, false, frame.leave_gamma);
        if (keeper && !keeper->begin(*film)) return {};
        FilmReaders readers(frame, *film, keeper);
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

}  // namespace

size_t default_memory_budget() {
    return machine_memory() / 4 * 3;
}

bool picture_fits(const RenderContext& context, const RenderSettings& settings) {
    const PixelRect pixels = sampled_pixels(context.camera, context.scene->options);
    if (pixels.empty()) return true;
    const int aovs = aov_layout(context.scene->options).channel_count;
    const int channels = kPictureChannels + aovs + (settings.watcher ? kPreviewChannels + aovs : 0) +
                         kMatteFloats * static_cast<int>(matte_layers(context.scene->options).size()) +
                         (find_glow(context.scene->options, nullptr) ? kGlowChannels : 0);
    const double bytes = 4.0 * channels * pixels.width() * pixels.height();
    // A stranger's has what there is for all.
    const size_t most =
        settings.access->is_confined() && settings.memory_bytes ? settings.memory_bytes : machine_memory();
    if (bytes <= static_cast<double>(most)) return true;
    constexpr double kMiB = 1 << 20;
    context.diagnostics->error(
        {},
        fmt::format("a picture of {}x{} pixels takes {:.0f} MiB, more than the {} of {:.0f} MiB; a smaller "
                    "--resolution or --crop helps",
                    pixels.width(), pixels.height(), bytes / kMiB,
                    most == machine_memory() ? "machine's memory" : "limit",
                    static_cast<double>(most) / kMiB),
        kPictureTooLarge);
    return false;
}

RenderContext make_context(const Scene& scene, const RenderSettings& settings, Diagnostics& diagnostics) {
    RenderContext context;
    context.scene = &scene;
    context.camera = make_camera(scene.options);
    if (settings.tile) context.camera.crop = part_of(context.camera.crop, *settings.tile);
    const AdaptiveSampling sampling = adaptive_sampling(scene.options);
    context.samples_x = sampling.samples_x, context.samples_y = sampling.samples_y;
    context.sample_levels = sampling.levels, context.pixel_variance = sampling.variance;
    context.seed = settings.seed;
    context.most_layers = layer_limit(scene.options);
    context.motion = std::any_of(scene.primitives.begin(), scene.primitives.end(),
                                 [](const Primitive& primitive) { return primitive.key_count() > 1; });
    context.float_colors = holds_more_than_halves(scene.options);
    OpenedColors opened = open_colors(scene.options, settings.colors, *settings.access, diagnostics);
    context.colors = std::move(opened.colors), context.lacks_colors = opened.failed;
    context.diagnostics = &diagnostics;
    context.cancelled = settings.cancelled;
    return context;
}

std::optional<FrameResult> render_frame(const RenderContext& asked, const RenderSettings& settings) {
    if (asked.lacks_colors) return {};
    std::string wrong;
    const std::optional<Sampler> sampler = choose_sampler(settings.sampler, settings.pattern, &wrong);
    if (!sampler) {
        asked.diagnostics->error({}, wrong);
        return {};
    }
    if (asked.sample_levels > 1 && !sampler->takes_levels()) {
        asked.diagnostics->error(
            {},
            "adaptive sampling needs a method that takes samples one by one, as raytrace "
            "does, and the pattern stratified; \"" +
                sampler->name() + "\" with \"" + sampler->pattern.name + "\" takes them all");
        return {};
    }
    const Imager imager(asked, *settings.access);
    const std::optional<Glow> glow =
        imager.is_there() ? std::nullopt : find_glow(asked.scene->options, asked.diagnostics);
    const RenderContext context = with_glow_margin(asked, glow);
    if (!picture_fits(context, settings)) return {};
    FrameRecorder recorder(settings.on_progress, settings.on_stage);

    Shading shading(context, *settings.access);
    const size_t budget = settings.memory_bytes ? settings.memory_bytes : default_memory_budget();
    shading.limit_clouds(std::max(budget / 4, kLeastCloudBytes));
    const Tessellation tessellation = recorder.timed(&StageSeconds::tessellate, [&] {
        TessellationOptions wanted;
        wanted.depth_heights = shading.depth_heights(), wanted.most_bytes = budget;
        wanted.is_displaced = shading.displacing_surfaces();
        return Tessellation(context, wanted);
    });
    recorder.bounded(tessellation.stats());
    recorder.timed(&StageSeconds::rays, [&] { make_light_meshes(context, shading, budget); });
    const std::unique_ptr<RayWorld> rays =
        recorder.timed(&StageSeconds::rays, [&] { return make_ray_world(context, shading, budget); });
    shading.set_rays(rays.get());
    const bool culls_hidden =
        settings.cull_hidden == CullHidden::On || (settings.cull_hidden == CullHidden::Auto && rays);
    const size_t region_budget = rays ? budget / 2 : budget;
    const std::unique_ptr<SamplePattern> pattern = sampler->make_pattern(context);
    FilmKeeper* const keeper = keeper_of(settings, shading);
    const int least_regions = std::max(settings.regions_at_least, keeper ? keeper->regions_at_least() : 1);

    const std::unique_ptr<Film> film =
        film_of_regions({context, tessellation, shading, *sampler, *pattern, region_budget, glow.has_value(),
                         culls_hidden, least_regions, settings.watcher, asked},
                        keeper, recorder);
    if (!film) return {};
    shading.report_displacement_bounds();
    // A point cloud is of all that the picture sees, of which a tile has a part.
    if (settings.tile)
        shading.leave_out_bakes();
    else
        shading.write_bakes();

    FrameResult result;
    recorder.begin_composite();
    recorder.timed(&StageSeconds::composite, [&] {
        result.image = film->finish();
        run_imager(imager, result.image);
        if (glow) glow_picture(*glow, context, asked.camera.crop, result.image);
    });
    if (glow && context.is_cancelled()) return {};
    if (settings.watcher) settings.watcher->show(result.image, asked);
    if (result.image.matte_loss > 0)
        context.diagnostics->note(
            {},
            fmt::format("pixels meet more than {} names: mattes have left out up to {:.2g} "
                        "of a pixel",
                        kMatteRanks, result.image.matte_loss),
            "matte-loss");
    result.stats = recorder.finish(context);
    result.stats.sampler = sampler->name();
    result.stats.tile = settings.tile;
    if (rays) {
        result.stats.ray_micropolygons = rays->micropolygon_count();
        result.stats.ray_micropolygons_made = rays->micropolygons_made();
        result.stats.ray_bytes = rays->bytes();
        result.stats.ray_list_bytes = rays->list_bytes();
    }
    return result;
}

}  // namespace trapeze
