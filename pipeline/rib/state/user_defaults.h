/// RIB that a user wants before every scene.
#pragma once

#include <string>

namespace trapeze {

/// The user's file of RIB that is read before every scene: $XDG_CONFIG_HOME/trapeze/trapeze.rib, where that
/// is not set ~/.config/trapeze/trapeze.rib. Empty when there is none.
std::string user_defaults_file();

}  // namespace trapeze
