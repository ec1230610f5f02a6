/// Names, overloads, types and storage: from the parser's tree to what code generation expects.
#pragma once

#include "shade/rsl/syntax/ast.h"
#include "shade/rsl/syntax/reporter.h"

namespace trapeze::rsl {

/// Completes the tree as ast.h says. Of use afterwards only when reporter.failed() is false.
void analyse(TranslationUnit& unit, Reporter& reporter);

}  // namespace trapeze::rsl
