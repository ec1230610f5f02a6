/// What a frame costs and how far it is, kept away from the page that renders it.
#pragma once

#include <functional>
#include <string_view>

#include "core/scene/render_context.h"
#include "pipeline/frame/frame_stats.h"
#include "pipeline/frame/progress.h"
#include "pipeline/frame/stopwatch.h"

namespace trapeze {

class FrameRecorder {
  public:
    /// Both are as RenderSettings has them, and outlive the recorder.
    FrameRecorder(const std::function<void(double)>& on_progress,
                  const std::function<void(std::string_view)>& on_stage)
        : progress_(on_progress), on_stage_(on_stage) {}

    FrameStats& stats() { return stats_; }
    Progress& progress() { return progress_; }

    /// Runs a step of the frame; its wall seconds are added to a stage's.
    template <class Step>
    auto timed(double StageSeconds::*stage, const Step& step) {
        struct AtEnd {
            double& seconds;
            Stopwatch watch;
            ~AtEnd() { seconds += watch.elapsed(); }
        } at_end{stats_.seconds.*stage, {}};
        return step();
    }

    /// What bounding and splitting found. Grids and micropolygons count as they are made.
    void bounded(const TessellateStats& found);
    /// Region `index` of `count` begins with its grids, a step of progress for each of `steps`.
    void begin_grids(size_t index, size_t count, size_t steps);
    void begin_build();
    /// A region's grids and what a method made of them, in memory at once.
    void built(uint64_t grid_bytes, const BuildStats& build);
    /// The same region goes on with `steps` tiles of samples.
    void begin_tiles(size_t steps);
    void begin_composite();
    /// The frame begins again: nothing counts that came after bounded().
    void restart() { stats_ = at_start_; }
    /// What is known at the end, whatever was made.
    FrameStats finish(const RenderContext& context);

  private:
    void begin(std::string_view stage) const {
        if (on_stage_) on_stage_(stage);
    }

    FrameStats stats_, at_start_;
    Progress progress_;
    const std::function<void(std::string_view)>& on_stage_;
    Stopwatch total_;
    double region_begin_ = 0, region_end_ = 1;  ///< as parts of the frame's progress
};

}  // namespace trapeze
