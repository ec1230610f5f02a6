/// What a compilation begins with: a text, and where the files that it includes come from.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace trapeze::rsl {

struct Source {
    std::string name;  ///< as messages show it, and where #include "..." starts to look
    std::string text;
};

struct CompileOptions {
    std::vector<std::string> include_folders;                      ///< in the order they are searched
    std::vector<std::pair<std::string, std::string>> defines;      ///< macros: name, replacement
    std::function<std::optional<std::string>(const std::string&)>  ///< a file's text, or nothing
        read_file;                                                 ///< empty: from disk
    /// The text of a file that is found nowhere, by its name without folders; empty text: none. May be empty.
    std::function<std::string_view(std::string_view)> carried_file;
};

}  // namespace trapeze::rsl
