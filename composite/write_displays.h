/// From the finished picture to files: the door to every Display.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "composite/image.h"
#include "core/render_context.h"

namespace trapeze {

struct OutputInfo {
    std::string software;                                       ///< "Trapeze 1.2.3"
    std::vector<std::pair<std::string, std::string>> metadata;  ///< further attributes: name, value
};

/// Writes every Display of the context's scene, each file whole or not at all. What goes wrong is reported as
/// one error at the Display, and the others are still written; then it returns false. Stops early, without an
/// error and with false, when the context is cancelled. `written`, if not null, gets the paths of the files
/// that are there.
bool write_displays(const Image& image, const RenderContext& context, const OutputInfo& info,
                    std::vector<std::string>* written = nullptr);

/// Removes what is half written, for a process about to be ended. Thread-safe.
void remove_partial_outputs();

}  // namespace trapeze
