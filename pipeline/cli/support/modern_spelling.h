/// Other ways to write a command line, turned into the one that is parsed.
#pragma once

#include <string>
#include <vector>

namespace trapeze {

/// RenderMan programs' spellings turned into ours: -progress -Progress -t:N -res W H -crop a b c d -frames
/// ... -recover N, and "render" put first when the command is left out; "help COMMAND" is "COMMAND --help".
/// `args` without the program's name.
std::vector<std::string> modern_spelling(std::vector<std::string> args);

}  // namespace trapeze
