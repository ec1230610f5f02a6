/// Tables for the terminal.
#pragma once

#include <string>
#include <vector>

namespace trapeze {

/// Lines of cells, every column as wide as its widest: the first to the left, the others to the right. A row
/// without cells is an empty line.
std::string text_table(const std::vector<std::vector<std::string>>& rows, const std::string& indent = {});

}  // namespace trapeze
