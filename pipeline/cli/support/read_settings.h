/// What of the command line and of the user's settings says how scenes are read.
#pragma once

#include "pipeline/cli/support/arguments.h"
#include "pipeline/rib/read_rib.h"

namespace trapeze {

/// The first argument with which this program is a procedural's host: `trapeze serve-procedural LIBRARY`.
inline constexpr const char* kServeProcedural = "serve-procedural";

/// What the scenes of a command line may reach.
Access scene_access(const Arguments& arguments);

/// The defaults file, --option, --allow-programs, bounds on memory; `access` is scene_access().
ReadOptions read_options(const Arguments& arguments, Access& access);

}  // namespace trapeze
