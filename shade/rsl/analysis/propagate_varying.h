/// Which variables have one value and which one at each vertex.
#pragma once

#include <vector>

#include "shade/rsl/syntax/ast.h"
#include "shade/rsl/syntax/reporter.h"

namespace trapeze::rsl {

/// Uniform variables that get varying values become varying; where the source assigns such a value, there is
/// a warning. `functions` are all that the shader calls.
void propagate_varying(Shader& shader, const std::vector<Function*>& functions, Reporter& reporter);

}  // namespace trapeze::rsl
