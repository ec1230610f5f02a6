#include "pipeline/frame/render_frame.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>
#include <tbb/task_arena.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <mutex>

#include "pipeline/frame/regions.h"
#include "pipeline/frame/stopwatch.h"
#include "sample/sample_pattern.h"
#include "sample/visibility_method.h"
#include "shade/shading.h"

namespace trapeze {
namespace {

/// Adds up the part of the frame that is done; calls back at most about a hundred times a region.
class Progress {
  public:
    explicit Progress(const std::function<void(double)>& on_progress) : on_progress_(on_progress) {}

    void begin_part(double from, double to, size_t steps) {
        from_ = from, to_ = to, steps_ = std::max<size_t>(1, steps), done_ = 0;
    }
    void step() {
        const size_t done = done_.fetch_add(1, std::memory_order_relaxed) + 1;
        if (!on_progress_ || (done * 100 / steps_ == (done - 1) * 100 / steps_)) return;
        const std::lock_guard lock(mutex_);
        const double fraction =
            from_ + (to_ - from_) * static_cast<double>(done) / static_cast<double>(steps_);
        if (fraction < last_) return;
        last_ = fraction;
        on_progress_(fraction);
    }

  private:
    const std::function<void(double)>& on_progress_;
    std::atomic<size_t> done_{0};
    double from_ = 0, to_ = 1, last_ = 0;
    size_t steps_ = 1;
    std::mutex mutex_;
};

/// What a thread needs to make grids.
struct GridMaker {
    ShadingGrid shading_grid;
    DiceScratch dice_scratch;
    ShadeScratch shade_scratch;
    ShadeStats shade_stats;
    GridArena arena;
    std::vector<Grid> grids;
    double dice_seconds = 0, shade_seconds = 0;
};

/// What a thread needs to resolve tiles.
struct TileResolver {
    SampleTile samples;
    HitBuffer hits;
    SampleScratch scratch;
    SampleStats stats;
    double trace_seconds = 0, composite_seconds = 0;
};

/// Shares a loop's wall time out in the proportion of what its threads spent on two kinds of work.
std::pair<double, double> shared_out(double wall, double first, double second) {
    const double sum = first + second;
    return sum > 0 ? std::pair{wall * first / sum, wall * second / sum} : std::pair{wall, 0.0};
}

/// Dices and shades a region's subpatches.
Grids make_grids(const RenderContext& context, const Region& region, const Tessellation& tessellation,
                 const Shading& shading, FrameStats& stats, Progress& progress) {
    Stopwatch wall;
    tbb::enumerable_thread_specific<GridMaker> makers;
    tbb::parallel_for(size_t{0}, region.subpatches.size(), [&](size_t i) {
        if (context.is_cancelled()) return;
        GridMaker& maker = makers.local();
        Stopwatch watch;
        tessellation.dice(region.subpatches[i], maker.shading_grid, maker.dice_scratch);
        maker.dice_seconds += watch.lap();
        shading.shade(maker.shading_grid, maker.shade_scratch, maker.shade_stats);
        int64_t not_finite = 0;
        maker.grids.push_back(pack_grid(maker.shading_grid, maker.arena, &not_finite));
        maker.shade_stats.not_finite_values += static_cast<uint64_t>(not_finite);
        maker.shade_seconds += watch.lap();
        progress.step();
    });

    Grids grids;
    double dice = 0, shade = 0;
    for (GridMaker& maker : makers) {
        grids.grids.insert(grids.grids.end(), maker.grids.begin(), maker.grids.end());
        grids.arenas.push_back(std::move(maker.arena));
        stats.shade += maker.shade_stats;
        dice += maker.dice_seconds, shade += maker.shade_seconds;
    }
    tbb::parallel_sort(grids.grids.begin(), grids.grids.end(),
                       [](const Grid& a, const Grid& b) { return a.ordinal < b.ordinal; });
    stats.tessellate.grids += grids.grids.size();
    stats.tessellate.micropolygons += grids.micropolygon_count();
    const auto [dice_wall, shade_wall] = shared_out(wall.lap(), dice, shade);
    stats.seconds.tessellate += dice_wall;
    stats.seconds.shade += shade_wall;
    return grids;
}

/// Finds what every sample of a region sees and adds it to the film.
void resolve_tiles(const RenderContext& context, const Region& region, const Grids& grids,
                   const Visibility& visibility, const SamplePattern& pattern, Film& film, FrameStats& stats,
                   Progress& progress) {
    Stopwatch wall;
    const std::vector<PixelRect> tiles = tiles_of(region.pixels);
    tbb::enumerable_thread_specific<TileResolver> resolvers;
    tbb::parallel_for(size_t{0}, tiles.size(), [&](size_t i) {
        if (context.is_cancelled()) return;
        TileResolver& resolver = resolvers.local();
        Stopwatch watch;
        pattern.make_tile(tiles[i], resolver.samples);
        visibility.resolve(resolver.samples, resolver.hits, resolver.scratch, resolver.stats);
        resolver.trace_seconds += watch.lap();
        film.add(resolver.samples, resolver.hits, grids);
        resolver.composite_seconds += watch.lap();
        progress.step();
    });
    double trace = 0, composite = 0;
    for (const TileResolver& resolver : resolvers) {
        stats.sample += resolver.stats;
        trace += resolver.trace_seconds, composite += resolver.composite_seconds;
    }
    const auto [trace_wall, composite_wall] = shared_out(wall.lap(), trace, composite);
    stats.seconds.trace += trace_wall;
    stats.seconds.composite += composite_wall;
}

void check_memory(const RenderContext& context, const Region& region, size_t used, size_t budget) {
    if (used <= budget) return;
    const auto mib = [](size_t bytes) { return std::to_string(bytes >> 20) + " MiB"; };
    context.diagnostics->warning({},
                                 "a region of " + std::to_string(region.pixels.width()) + "x" +
                                     std::to_string(region.pixels.height()) + " pixels takes " + mib(used) +
                                     " for grids and tree, more than the budget of " + mib(budget),
                                 "memory-budget");
}

}  // namespace

size_t default_memory_budget() {
    const long pages = sysconf(_SC_PHYS_PAGES), page_bytes = sysconf(_SC_PAGE_SIZE);
    if (pages <= 0 || page_bytes <= 0) return size_t{1} << 31;
    return static_cast<size_t>(pages) * static_cast<size_t>(page_bytes) / 4 * 3;
}

RenderContext make_context(const Scene& scene, const RenderSettings& settings, Diagnostics& diagnostics) {
    RenderContext context;
    context.scene = &scene;
    context.camera = make_camera(scene.options);
    context.samples_x = std::max(1, static_cast<int>(std::lround(scene.options.samples_x)));
    context.samples_y = std::max(1, static_cast<int>(std::lround(scene.options.samples_y)));
    context.seed = settings.seed;
    context.motion = std::any_of(scene.primitives.begin(), scene.primitives.end(),
                                 [](const Primitive& primitive) { return primitive.key_count() > 1; });
    context.diagnostics = &diagnostics;
    context.cancelled = settings.cancelled;
    return context;
}

std::optional<FrameResult> render_frame(const RenderContext& context, const RenderSettings& settings) {
    const VisibilityMethod* method = find_visibility_method(settings.sampler);
    if (!method) {
        context.diagnostics->error({}, "no visibility method \"" + settings.sampler + "\"");
        return {};
    }
    Stopwatch total, watch;
    Progress progress(settings.on_progress);
    FrameResult result;
    FrameStats& stats = result.stats;

    const Tessellation tessellation(context);
    stats.tessellate = tessellation.stats();
    stats.tessellate.grids = stats.tessellate.micropolygons = 0;  // counted as they are made
    stats.seconds.tessellate = watch.lap();
    const Shading shading(context);
    const SamplePattern pattern(context);
    Film film(context);

    const size_t budget = settings.memory_bytes ? settings.memory_bytes : default_memory_budget();
    const std::vector<Region> regions =
        split_into_regions(sampled_pixels(context.camera, context.scene->options), tessellation.subpatches(),
                           {budget, settings.regions_at_least});
    for (size_t r = 0; r < regions.size() && !context.is_cancelled(); ++r) {
        const Region& region = regions[r];
        const double begin = static_cast<double>(r) / regions.size(),
                     end = static_cast<double>(r + 1) / regions.size();
        progress.begin_part(begin, begin + 0.2 * (end - begin), region.subpatches.size());
        const Grids grids = make_grids(context, region, tessellation, shading, stats, progress);

        watch.lap();
        if (context.is_cancelled()) break;
        const std::unique_ptr<Visibility> visibility = method->prepare(context, grids);
        const BuildStats build = visibility->build_stats();
        stats.seconds.build += watch.lap();
        stats.build += build;
        stats.grid_bytes = std::max<uint64_t>(stats.grid_bytes, grids.bytes());
        stats.tree_bytes = std::max<uint64_t>(stats.tree_bytes, build.tree_bytes);
        stats.peak_region_bytes =
            std::max<uint64_t>(stats.peak_region_bytes, grids.bytes() + build.tree_bytes);
        check_memory(context, region, grids.bytes() + build.tree_bytes, budget);

        progress.begin_part(begin + 0.2 * (end - begin), end, tiles_of(region.pixels).size());
        resolve_tiles(context, region, grids, *visibility, pattern, film, stats, progress);
    }
    if (context.is_cancelled()) return {};
    shading.report_displacement_bounds();

    watch.lap();
    result.image = film.finish();
    stats.seconds.composite += watch.lap();
    stats.samples = stats.sample.rays;
    stats.regions = static_cast<int>(regions.size());
    stats.threads = tbb::this_task_arena::max_concurrency();
    stats.width = context.camera.width, stats.height = context.camera.height;
    stats.frame = context.scene->options.frame;
    stats.sampler = settings.sampler;
    stats.simd_target = simd_target_name();
    stats.seconds.total = total.lap();
    return result;
}

}  // namespace trapeze
