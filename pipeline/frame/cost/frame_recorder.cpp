#include "pipeline/frame/cost/frame_recorder.h"

#include <tbb/task_arena.h>

#include <algorithm>

#include "sample/visibility.h"

namespace trapeze {
namespace {

/// The part of a region's progress that is dicing and shading.
constexpr double kMakingGrids = 0.2;

}  // namespace

void FrameRecorder::bounded(const TessellateStats& found) {
    stats_.tessellate = found;
    stats_.tessellate.grids = stats_.tessellate.micropolygons = 0;
    at_start_ = stats_;
}

void FrameRecorder::begin_grids(size_t index, size_t count, size_t steps) {
    begin("shade");
    region_begin_ = static_cast<double>(index) / static_cast<double>(count);
    region_end_ = static_cast<double>(index + 1) / static_cast<double>(count);
    progress_.begin_part(region_begin_, region_begin_ + kMakingGrids * (region_end_ - region_begin_), steps);
}

void FrameRecorder::begin_cull() {
    begin("cull");
}

void FrameRecorder::begin_build() {
    begin("build");
}

void FrameRecorder::built(uint64_t grid_bytes, const BuildStats& build) {
    stats_.build += build;
    stats_.grid_bytes = std::max(stats_.grid_bytes, grid_bytes);
    stats_.tree_bytes = std::max<uint64_t>(stats_.tree_bytes, build.tree_bytes);
    stats_.peak_region_bytes = std::max<uint64_t>(stats_.peak_region_bytes, grid_bytes + build.tree_bytes);
}

void FrameRecorder::begin_tiles(size_t steps) {
    begin("trace");
    progress_.begin_part(region_begin_ + kMakingGrids * (region_end_ - region_begin_), region_end_, steps);
}

void FrameRecorder::begin_composite() {
    begin("composite");
}

FrameStats FrameRecorder::finish(const RenderContext& context) {
    stats_.threads = tbb::this_task_arena::max_concurrency();
    stats_.width = context.camera.width, stats_.height = context.camera.height;
    stats_.frame = context.scene->options.frame;
    stats_.simd_target = simd_target_name();
    stats_.seconds.total = total_.elapsed();
    return stats_;
}

}  // namespace trapeze
