/// The frame: the whole algorithm on one page [Cook87].
#pragma once

#include <optional>

#include "composite/image.h"
#include "core/scene/render_context.h"
#include "pipeline/frame/cost/frame_stats.h"
#include "pipeline/frame/render_settings.h"

namespace trapeze {

/// The picture of a frame and what it cost.
struct FrameResult {
    Image image;
    FrameStats stats;
};

/// Renders with the threads of the calling task arena. Empty when cancelled, or (reported) when the picture
/// is too large or the context lacks its colours. `context` is make_context's.
std::optional<FrameResult> render_frame(const RenderContext& context, const RenderSettings& settings);

}  // namespace trapeze
