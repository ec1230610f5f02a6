/// Scripts by which shells complete the program's commands and options, from the table behind --help. A
/// command line without a command is one of `render`.
#pragma once

#include <string>

#include "pipeline/cli/pages/command_table.h"

namespace trapeze {

std::string bash_completion(const CommandText& program);
std::string zsh_completion(const CommandText& program);
std::string fish_completion(const CommandText& program);

}  // namespace trapeze
