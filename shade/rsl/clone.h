/// Copies of functions as the parser made them.
#pragma once

#include <memory>

#include "shade/rsl/ast.h"

namespace trapeze::rsl {

/// A copy without what the analysis sets; nested functions stay those of the original.
std::unique_ptr<Function> clone(const Function& function);

}  // namespace trapeze::rsl
