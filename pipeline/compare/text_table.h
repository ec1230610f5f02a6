/// Tables for the terminal.
#pragma once

#include <string>
#include <vector>

namespace trapeze {

/// Rows as lines of text, every column as wide as its widest cell: the first column to the left, the others
/// to the right. A row without cells is an empty line. `indent` goes before each line.
std::string text_table(const std::vector<std::vector<std::string>>& rows, const std::string& indent = {});

}  // namespace trapeze
