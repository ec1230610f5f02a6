#include "pipeline/frame/render_frame.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "pipeline/frame/make_grids.h"
#include "pipeline/frame/progress.h"
#include "pipeline/frame/regions.h"
#include "pipeline/frame/resolve_tiles.h"
#include "pipeline/frame/stopwatch.h"
#include "sample/visibility.h"
#include "shade/imager.h"
#include "shade/shading.h"

namespace trapeze {
namespace {

constexpr int kPictureChannels = 6;  ///< colour, opacity, depth and a weight or id, of four bytes each

size_t machine_memory() {
    const long pages = sysconf(_SC_PHYS_PAGES), page_bytes = sysconf(_SC_PAGE_SIZE);
    if (pages <= 0 || page_bytes <= 0) return size_t{1} << 31;
    return static_cast<size_t>(pages) * static_cast<size_t>(page_bytes);
}

/// The part of a region's progress that is dicing and shading.
constexpr double kMakingGrids = 0.2;

void check_memory(const RenderContext& context, const Region& region, size_t used, size_t budget) {
    if (used <= budget) return;
    const auto mib = [](size_t bytes) { return std::to_string(bytes >> 20) + " MiB"; };
    context.diagnostics->warning({},
                                 "a region of " + std::to_string(region.pixels.width()) + "x" +
                                     std::to_string(region.pixels.height()) + " pixels takes " + mib(used) +
                                     " for grids and tree, more than the budget of " + mib(budget),
                                 "memory-budget");
}

void run_imager(const Imager& imager, Image& image) {
    if (!imager.is_there()) return;
    const PixelRect& window = image.window;
    tbb::parallel_for(window.y0, window.y1, [&](int y) {
        imager.run(window.x0, y, window.width(), image.rgba.data() + 4 * image.index(window.x0, y));
    });
}

/// What a frame's regions share.
struct FrameParts {
    const RenderContext& context;
    const Sampler& sampler;
    const SamplePattern& pattern;
    size_t memory_budget;  ///< bytes, of a region's grids and tree
    FrameStats& stats;
    Progress& progress;
    const std::function<void(std::string_view)>& on_stage;

    void begin(std::string_view stage) const {
        if (on_stage) on_stage(stage);
    }
};

/// Builds what the method needs of a region's grids, and adds what their samples see to the film. Of the
/// frame's progress these are the steps from `begin` to `end`.
void sample_region(const FrameParts& frame, const Region& region, const Grids& grids, double begin,
                   double end, Film& film) {
    Stopwatch watch;
    frame.begin("build");
    const std::unique_ptr<Visibility> visibility = frame.sampler.prepare(frame.context, grids);
    const BuildStats build = visibility->build_stats();
    FrameStats& stats = frame.stats;
    stats.seconds.build += watch.lap();
    stats.build += build;
    const size_t bytes = grids.bytes() + build.tree_bytes;
    stats.grid_bytes = std::max<uint64_t>(stats.grid_bytes, grids.bytes());
    stats.tree_bytes = std::max<uint64_t>(stats.tree_bytes, build.tree_bytes);
    stats.peak_region_bytes = std::max<uint64_t>(stats.peak_region_bytes, bytes);
    check_memory(frame.context, region, bytes, frame.memory_budget);

    frame.begin("trace");
    frame.progress.begin_part(begin, end, tiles_of(region.pixels, visibility->tile_side()).size());
    resolve_tiles(frame.context, region.pixels, grids, *visibility, frame.pattern, film, stats,
                  [&frame] { frame.progress.step(); });
}

}  // namespace

size_t default_memory_budget() {
    return machine_memory() / 4 * 3;
}

bool picture_fits(const RenderContext& context, const RenderSettings& settings) {
    const PixelRect pixels = sampled_pixels(context.camera, context.scene->options);
    if (pixels.empty()) return true;
    const int channels = kPictureChannels + aov_layout(context.scene->options).channel_count;
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
    std::string wrong;
    const auto sampler = choose_sampler(settings.sampler, settings.pattern, &wrong);
    if (!sampler) {
        context.diagnostics->error({}, wrong);
        return {};
    }
    if (!picture_fits(context, settings)) return {};
    Stopwatch total, watch;
    Progress progress(settings.on_progress);
    FrameResult result;
    FrameStats& stats = result.stats;

    Shading shading(context, *settings.access);
    watch.lap();
    const size_t budget = settings.memory_bytes ? settings.memory_bytes : default_memory_budget();
    const Tessellation tessellation(context, shading.depth_heights(), budget, shading.displacing_surfaces());
    stats.tessellate = tessellation.stats();
    stats.tessellate.grids = stats.tessellate.micropolygons = 0;  // counted as they are made
    stats.seconds.tessellate = watch.lap();
    const Imager imager(context, *settings.access);
    const auto pattern = sampler->make_pattern(context);

    const std::vector<Region> regions = split_into_regions(
        sampled_pixels(context.camera, context.scene->options), tessellation.subpatches(),
        {budget, settings.regions_at_least, aov_layout(context.scene->options).channel_count});
    const FrameParts parts{context, *sampler, *pattern, budget, stats, progress, settings.on_stage};
    std::optional<Film> film;
    const FrameStats before = stats;
    // Again from the start, when a shader is found to be endless: its limits are others then.
    const auto begin_film = [&] { stats = before, film.emplace(context); };
    begin_film();
    size_t r = 0;
    while (r < regions.size() && !context.is_cancelled()) {
        const Region& region = regions[r];
        const double begin = static_cast<double>(r) / regions.size(),
                     end = static_cast<double>(r + 1) / regions.size();
        parts.begin("shade");
        progress.begin_part(begin, begin + kMakingGrids * (end - begin), region.subpatches.size());
        const Grids grids = make_grids(context, region, tessellation, shading, stats, progress);
        if (shading.found_endless_loops()) {
            begin_film();
            r = 0;
            continue;
        }

        if (context.is_cancelled()) break;
        sample_region(parts, region, grids, begin + kMakingGrids * (end - begin), end, *film);
        ++r;
    }
    if (context.is_cancelled()) return {};
    shading.report_displacement_bounds();

    watch.lap();
    parts.begin("composite");
    result.image = film->finish();
    run_imager(imager, result.image);
    stats.seconds.composite += watch.lap();
    stats.samples = stats.sample.rays;
    stats.regions = static_cast<int>(regions.size());
    stats.threads = tbb::this_task_arena::max_concurrency();
    stats.width = context.camera.width, stats.height = context.camera.height;
    stats.frame = context.scene->options.frame;
    stats.sampler = sampler->name();
    stats.simd_target = simd_target_name();
    stats.seconds.total = total.lap();
    return result;
}

}  // namespace trapeze
