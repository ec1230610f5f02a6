#include "pipeline/compare/shared_frame.h"

#include <tbb/task_arena.h>

#include "core/scene/adaptive_sampling.h"
#include "pipeline/frame/cost/frame_recorder.h"
#include "pipeline/frame/frame_memory.h"
#include "pipeline/frame/make_context.h"
#include "pipeline/frame/make_grids.h"
#include "pipeline/rays/light_meshes.h"
#include "pipeline/rays/ray_world.h"
#include "sample/visibility.h"

namespace trapeze {
namespace {

/// The whole picture as a region, or nothing (reported) when it has no pixels or does not fit.
std::optional<Region> whole_region(const SharedFrame& frame, const Tessellation& tessellation,
                                   size_t budget) {
    if (frame.pixels.empty()) {
        frame.context.diagnostics->error({}, "the crop window holds no pixels");
        return {};
    }
    Region region = split_into_regions(frame.pixels, tessellation.subpatches(), {~size_t{0}, 1, 0}).front();
    if (region.estimated_bytes <= budget) return region;
    frame.context.diagnostics->error({},
                                     "the grids and trees of the whole picture may take " +
                                         mebibytes_text(static_cast<double>(region.estimated_bytes)) +
                                         ", more than the budget of " +
                                         mebibytes_text(static_cast<double>(budget)) +
                                         "; a smaller --crop or --resolution, a larger --shading-rate or "
                                         "--memory helps",
                                     kTooLittleMemory);
    return {};
}

}  // namespace

RenderContext SharedFrame::adaptive_context(SampleRate most, float variance) const {
    Options options = scene->options;
    options.samples_x = static_cast<float>(most.x), options.samples_y = static_cast<float>(most.y);
    options.adaptive = true, options.pixel_variance = variance;
    const AdaptiveSampling sampling = adaptive_sampling(options);
    RenderContext adaptive = context_at({sampling.samples_x, sampling.samples_y});
    adaptive.sample_levels = sampling.levels, adaptive.pixel_variance = sampling.variance;
    return adaptive;
}

std::optional<SharedFrame> share_frame(Scene&& scene, const RenderSettings& settings,
                                       Diagnostics& diagnostics) {
    SharedFrame frame;
    // Methods are compared by colour and depth.
    for (Display& display : scene.options.displays) display.variable.reset();
    scene.options.adaptive = false;  // on the same samples
    frame.scene = std::make_unique<const Scene>(std::move(scene));
    frame.context = make_context(*frame.scene, settings, diagnostics);
    frame.pixels = sampled_pixels(frame.context.camera, frame.scene->options);
    if (frame.context.lacks_colors || !picture_fits(frame.context, settings)) return {};

    FrameRecorder recorder(settings.on_progress, settings.on_stage);
    Shading shading(frame.context, *settings.access);
    const Tessellation tessellation = recorder.timed(&StageSeconds::tessellate, [&] {
        TessellationOptions options;
        options.depth_heights = shading.depth_heights();
        options.is_displaced = shading.displacing_surfaces();
        return Tessellation(frame.context, options);
    });
    recorder.bounded(tessellation.stats());
    const size_t budget = settings.memory_bytes ? settings.memory_bytes : default_memory_budget();
    recorder.timed(&StageSeconds::rays, [&] { make_light_meshes(frame.context, shading, budget); });
    const std::unique_ptr<RayWorld> rays =
        recorder.timed(&StageSeconds::rays, [&] { return make_ray_world(frame.context, shading, budget); });
    shading.set_rays(rays.get());
    const auto region = whole_region(frame, tessellation, budget);
    if (!region) return {};

    recorder.progress().begin_part(0, 1, region->subpatches.size());
    do {
        recorder.restart();
        frame.grids =
            make_grids(frame.context, *region, tessellation, shading, recorder.stats(), recorder.progress());
    } while (!frame.context.is_cancelled() && shading.found_endless_loops());
    if (frame.context.is_cancelled()) return {};
    shading.report_displacement_bounds();
    frame.subpatches = tessellation.subpatches();
    frame.stats = recorder.finish(frame.context);
    frame.stats.grid_bytes = frame.grids.bytes();
    frame.memory_budget = budget;
    return frame;
}

}  // namespace trapeze
