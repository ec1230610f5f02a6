/// From a rendered frame to its files.
#pragma once

#include <string>
#include <vector>

#include "pipeline/frame/render_frame.h"

namespace trapeze {

/// Writes the displays of the context's scene, as write_displays does, with what a picture says of its
/// making; the time goes to the frame's statistics. False when a file was not written; that has been
/// reported.
bool write_frame(FrameResult& frame, const RenderContext& context,
                 std::vector<std::string>* written = nullptr);

}  // namespace trapeze
