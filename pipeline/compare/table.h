/// The table of a comparison: a row for each method and sample rate.
#pragma once

#include <string>
#include <vector>

#include "pipeline/compare/comparison.h"

namespace trapeze {

/// A column: what it shows of a method, and how it is written.
struct TableColumn {
    std::string title;
    std::string meaning;  ///< a sentence or so, for the report's legend
    double (*value)(const ComparedMethod& method);
    std::string (*text)(double value);
};

/// The columns of figures; the method and its sample rate come before them.
const std::vector<TableColumn>& table_columns();

/// The table for a terminal: lines of padded columns, a blank line between sample rates.
std::string table_text(const Comparison& comparison);

}  // namespace trapeze
