/// How scenes are read, from the command line and the user's settings.
#pragma once

#include "pipeline/cli/support/arguments.h"
#include "pipeline/rib/read_rib.h"

namespace trapeze {

/// The first argument of the process that the program starts for Procedural "DynamicLoad": `trapeze
/// serve-procedural LIBRARY`.
inline constexpr const char* kServeProcedural = "serve-procedural";

/// True when all inputs ("-": standard input) can be opened; reports those that cannot.
bool inputs_exist(const std::vector<std::string>& inputs, Diagnostics& diagnostics);

/// The files that the scenes of a command line may reach: all, or with --safe some folders.
Access scene_access(const Arguments& arguments);

/// ReadOptions from the defaults file, --option, --frames, --allow-programs and the bounds on memory.
/// `access` is scene_access() and must outlive them.
ReadOptions read_options(const Arguments& arguments, Access& access);

}  // namespace trapeze
