/// Copies of functions as the parser made them.
#pragma once

#include <memory>

#include "shade/rsl/syntax/ast.h"

namespace trapeze::rsl {

/// Copies without what the analysis sets; nested functions stay those of the original. A null expression
/// gives null.
/// Why: each shader that calls a function gets its own copy, since what the function names as extern differs
/// from shader to shader.
ExpressionPtr clone(const ExpressionPtr& e);
std::unique_ptr<Variable> clone(const Variable& variable);
std::unique_ptr<Function> clone(const Function& function);

}  // namespace trapeze::rsl
