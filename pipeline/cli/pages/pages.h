/// What packages install beside the program: manual pages and completions.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace trapeze {

/// Whether words of a command line ask for a page: "help --man ..." or "help --completions ...". These are
/// for those who make packages, so --help does not mention them.
bool asks_for_page(const std::vector<std::string>& words);

/// The page that such words ask for: "help --man [COMMAND]" or "help --completions SHELL". Empty, with
/// *problem set, where there is none.
std::string page_for(const std::vector<std::string>& words, const CLI::App& app, const std::string& version,
                     std::string* problem);

}  // namespace trapeze
