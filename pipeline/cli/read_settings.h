/// What of the command line and of the user's settings says how scenes are read.
#pragma once

#include "pipeline/cli/arguments.h"
#include "pipeline/rib/read_rib.h"

namespace trapeze {

/// The first argument with which this program is a procedural's host: `trapeze serve-procedural LIBRARY`.
inline constexpr const char* kServeProcedural = "serve-procedural";

/// The defaults file, --option, --allow-programs.
ReadOptions read_options(const Arguments& arguments);

}  // namespace trapeze
