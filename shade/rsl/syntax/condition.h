/// The integer expressions of #if and #elif.
#pragma once

#include <vector>

#include "shade/rsl/syntax/reporter.h"
#include "shade/rsl/syntax/token.h"

namespace trapeze::rsl {

/// Whether the expression is not 0. `tokens`: after expansion, `defined` replaced by numbers; names that are
/// left count as 0. What is wrong is reported, at a token or at `at`, and counts as false.
bool evaluate_condition(const std::vector<Token>& tokens, SourceLocation at, Reporter& reporter);

}  // namespace trapeze::rsl
