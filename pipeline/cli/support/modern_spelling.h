/// Other ways to write a command line, turned into the one that is parsed.
#pragma once

#include <string>
#include <vector>

namespace trapeze {

/// Turns the spellings of RenderMan programs into ours: -progress -Progress -t:N -res W H -crop a b c d
/// -frames ... -recover N. Puts "render" first when the command is left out; "help COMMAND" becomes "COMMAND
/// --help". `args` is without the program's name.
std::vector<std::string> modern_spelling(std::vector<std::string> args);

}  // namespace trapeze
