/// Manual pages in roff, from the table behind --help.
#pragma once

#include <string>
#include <string_view>

#include "pipeline/cli/pages/command_table.h"

namespace trapeze {

/// A text that roff shows letter for letter: backslashes, hyphens and points at the beginning of a line have
/// a meaning there, and are escaped.
std::string roff_text(std::string_view text);

/// The page trapeze(1), of the program's table. Pages have no date, so that each build makes the same bytes.
std::string man_page(const CommandText& program, const std::string& version);

/// The page trapeze-COMMAND(1), of one of the program's commands.
std::string man_page(const CommandText& program, const CommandText& command, const std::string& version);

}  // namespace trapeze
