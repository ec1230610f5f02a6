#include "pipeline/compare/text_table.h"

#include <fmt/format.h>

#include <algorithm>

namespace trapeze {

std::string text_table(const std::vector<std::vector<std::string>>& rows, const std::string& indent) {
    std::vector<size_t> widths;
    for (const auto& row : rows) {
        widths.resize(std::max(widths.size(), row.size()));
        for (size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
    }
    std::string text;
    for (const auto& row : rows) {
        for (size_t i = 0; i < row.size(); ++i)
            text += i == 0 ? indent + fmt::format("{:<{}}", row[0], widths[0])
                           : fmt::format("  {:>{}}", row[i], widths[i]);
        text += "\n";
    }
    return text;
}

}  // namespace trapeze
