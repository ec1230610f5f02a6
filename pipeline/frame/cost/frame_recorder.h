/// What a frame costs and how far it is, kept away from the page that renders it.
#pragma once

#include <functional>
#include <string_view>

#include "core/scene/render_context.h"
#include "pipeline/frame/cost/frame_stats.h"
#include "pipeline/frame/cost/progress.h"
#include "pipeline/frame/cost/stopwatch.h"

namespace trapeze {

/// Times a frame's stages, tells how far it is, and adds up its statistics.
class FrameRecorder {
  public:
    /// Both functions are RenderSettings', may be empty, and outlive the recorder.
    FrameRecorder(const std::function<void(double)>& on_progress,
                  const std::function<void(std::string_view)>& on_stage)
        : progress_(on_progress), on_stage_(on_stage) {}

    FrameStats& stats() { return stats_; }
    Progress& progress() { return progress_; }

    /// Runs a step of the frame and returns what it returns; its wall seconds are added to those of a stage.
    template <class Step>
    auto timed(double StageSeconds::*stage, const Step& step) {
        struct AtEnd {
            double& seconds;
            Stopwatch watch;
            ~AtEnd() { seconds += watch.elapsed(); }
        } at_end{stats_.seconds.*stage, {}};
        return step();
    }

    /// Takes what bounding and splitting found. Grids and micropolygons are counted later, as they are made.
    void bounded(const TessellateStats& found);
    /// Region `index` of `count` begins with its grids, a step of progress for each of `steps`.
    void begin_grids(size_t index, size_t count, size_t steps);
    void begin_cull();
    void begin_build();
    /// Takes the bytes of a region's grids, and what the method has built for them: both are in memory at
    /// once.
    void built(uint64_t grid_bytes, const BuildStats& build);
    /// The same region goes on with `steps` tiles of samples.
    void begin_tiles(size_t steps);
    void begin_composite();
    /// Begins the frame again, when a shader was found to be endless: what was counted after bounded() counts
    /// no more.
    void restart() { stats_ = at_start_; }
    /// Completes the statistics, whatever has been made so far.
    FrameStats finish(const RenderContext& context);

  private:
    void begin(std::string_view stage) const {
        if (on_stage_) on_stage_(stage);
    }

    FrameStats stats_, at_start_;  ///< the second as bounded() left it
    Progress progress_;
    const std::function<void(std::string_view)>& on_stage_;
    Stopwatch total_;
    double region_begin_ = 0, region_end_ = 1;  ///< as parts of the frame's progress
};

}  // namespace trapeze
