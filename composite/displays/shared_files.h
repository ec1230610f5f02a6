/// Which displays of a scene go into which files.
#pragma once

#include <vector>

#include "composite/displays/display_plan.h"
#include "core/files/access.h"
#include "core/files/output_file.h"

namespace trapeze {

/// One file and what it shows. The first plan says how the file is made.
struct SharedFile {
    std::vector<DisplayPlan> plans;
    OutputPlace place;
    SourceLocation location;  ///< of the first display
};

/// The files of a scene's displays, in the order of their first displays. Displays that name one OpenEXR file
/// share it, each with channels that those before it do not have. Any other display whose file is taken gets
/// a file beside it, which is said. All plans of a shared file have its compression, tiles and attributes:
/// those that the first display asks for which asks for any. A compression that loses what ids need is
/// refused in a file with ids. A place may have a problem; the file is then not to be written.
std::vector<SharedFile> files_of_displays(const Options& options, const Access& access,
                                          Diagnostics& diagnostics);

}  // namespace trapeze
