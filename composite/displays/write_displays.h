/// From the finished picture to files: the door to every Display.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "composite/image.h"
#include "core/files/access.h"
#include "core/scene/render_context.h"

namespace trapeze {

/// What files say of themselves besides their pixels, and where they may be.
struct OutputInfo {
    std::string software;                                       ///< "Trapeze 1.2.3"
    std::vector<std::pair<std::string, std::string>> metadata;  ///< further attributes: name, value
    std::optional<int> frame = {};                              ///< its number
    std::string scene = {};                                     ///< the file it was made from
    std::string date = {};                                      ///< "2026:01:31 23:59:59", UTC
    const Access* access = &kEverything;                        ///< where displays may be written
    /// Called before a file is written, unless that is a depth map; may be empty.
    std::function<void(const std::string& path, SourceLocation location)> before_picture = {};
    std::string stats = {};  ///< of the render, as JSON; OpenEXR alone
};

/// A file that has been written.
struct WrittenFile {
    std::string path;
    double seconds = 0;  ///< that it took to write, from the picture in memory
    bool is_depth_map = false;
};

/// Writes every Display of the context's scene, each file whole or not at all. What goes wrong is reported as
/// one error at the Display, and the others are still written; then it returns false. Stops early, without an
/// error and with false, when the context is cancelled. `written`, if not null, gets the files that are
/// there. Which displays share a file: shared_files.h.
bool write_displays(const Image& image, const RenderContext& context, const OutputInfo& info,
                    std::vector<WrittenFile>* written = nullptr);

/// Removes the files that are half written, for a process about to be ended. Thread-safe.
void remove_partial_outputs();

}  // namespace trapeze
