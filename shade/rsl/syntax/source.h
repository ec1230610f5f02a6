/// What a compilation begins with: a text, and where the files that it includes come from.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace trapeze::rsl {

/// A shader's source as it comes from a file, from a scene or from a test.
struct Source {
    std::string name;  ///< as messages show it, and where #include "..." starts to look
    std::string text;
};

/// What the command line or the scene says about reading; it changes no meaning beyond macros and headers.
/// Whoever confines rendering gives read_file, which refuses paths that are not open to the scene.
struct CompileOptions {
    std::vector<std::string> include_folders;                      ///< in the order they are searched
    std::vector<std::pair<std::string, std::string>> defines;      ///< macros: name, replacement
    std::function<std::optional<std::string>(const std::string&)>  ///< a file's text, or nothing
        read_file;                                                 ///< empty: from disk
    /// The text of a file that is found nowhere, by its name without folders; empty text: none. May be empty.
    std::function<std::string_view(std::string_view)> carried_file;
};

}  // namespace trapeze::rsl
