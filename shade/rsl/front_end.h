/// The shading language's front end: text in, checked tree out (RISpec 3.2, sections 11 to 15).
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/diagnostics.h"
#include "shade/rsl/syntax/ast.h"

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

/// The tree as written, not analysed. Null when there were errors; all are reported.
std::unique_ptr<TranslationUnit> parse(const Source& source, const CompileOptions& options,
                                       Diagnostics& diagnostics);

/// The checked tree: see ast.h for what the analysis completes. Null when there were errors; all are reported
/// (of very many, the first fifty).
std::unique_ptr<TranslationUnit> compile_front(const Source& source, const CompileOptions& options,
                                               Diagnostics& diagnostics);

/// Source text that parses to the same tree. Conversions that the source did not name are left out.
std::string print(const TranslationUnit& unit);
std::string print(const Expression& expression);
/// "uniform float[3]" and such; without storage where that is unspecified.
std::string print(const Type& type, Storage storage = Storage::Unspecified);

}  // namespace trapeze::rsl
