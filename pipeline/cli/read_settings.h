/// What of the command line and of the user's settings says how scenes are read.
#pragma once

#include "pipeline/cli/arguments.h"
#include "pipeline/rib/read_rib.h"

namespace trapeze {

/// The user's file of RIB that is read before every scene: $XDG_CONFIG_HOME/trapeze/trapeze.rib, where that
/// is not set ~/.config/trapeze/trapeze.rib. Empty when there is none.
std::string user_defaults_file();

/// The defaults file, --option, --allow-programs.
ReadOptions read_options(const Arguments& arguments);

}  // namespace trapeze
