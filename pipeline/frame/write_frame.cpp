#include "pipeline/frame/write_frame.h"

#include "composite/write_displays.h"
#include "pipeline/frame/stopwatch.h"
#include "pipeline/frame/version.h"

namespace trapeze {

bool write_frame(FrameResult& frame, const RenderContext& context, std::vector<std::string>* written) {
    Stopwatch watch;
    FrameStats& stats = frame.stats;
    OutputInfo info;
    info.software = std::string("Trapeze ") + kVersion;
    info.metadata = {{"sampler", stats.sampler},
                     {"samples", std::to_string(context.samples_x) + "x" + std::to_string(context.samples_y)},
                     {"renderTime", std::to_string(stats.seconds.total)}};
    const bool all_written = write_displays(frame.image, context, info, written);
    const double seconds = watch.lap();
    stats.seconds.composite += seconds;
    stats.seconds.total += seconds;
    return all_written;
}

}  // namespace trapeze
