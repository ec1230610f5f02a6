/// Manual pages in roff, from the table behind --help.
#pragma once

#include <string>
#include <string_view>

#include "pipeline/cli/pages/command_table.h"

namespace trapeze {

/// A text as roff shows it, letter for letter: backslashes, hyphens and points at a line's beginning have a
/// meaning of their own there.
std::string roff_text(std::string_view text);

/// trapeze(1), of the program's table. Pages have no date, so that they are the same bytes for each build.
std::string man_page(const CommandText& program, const std::string& version);

/// trapeze-COMMAND(1), of one of the program's commands.
std::string man_page(const CommandText& program, const CommandText& command, const std::string& version);

}  // namespace trapeze
