/// The table of a comparison: a row for each method and sample rate.
#pragma once

#include <string>
#include <vector>

#include "pipeline/compare/comparison.h"

namespace trapeze {

struct TableColumn {
    std::string title;
    std::string meaning;  ///< a sentence or so
    double (*value)(const ComparedMethod& method);
    std::string (*text)(double value);
};

/// The figures; the method and its sample rate come before them.
const std::vector<TableColumn>& table_columns();

/// For a terminal: lines of padded columns, a blank line between sample rates.
std::string table_text(const Comparison& comparison);

}  // namespace trapeze
