/// Names, overloads, types and storage: from the parser's tree to what code generation expects.
#pragma once

#include "shade/rsl/syntax/ast.h"
#include "shade/rsl/syntax/messages.h"

namespace trapeze::rsl {

/// Completes the tree as ast.h says. Of use afterwards only when messages.failed() is false.
void analyse(TranslationUnit& unit, Messages& messages);

}  // namespace trapeze::rsl
