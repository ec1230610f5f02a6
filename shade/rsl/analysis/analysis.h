/// Names, overloads, types and storage: from the parser's tree to what code generation expects.
#pragma once

#include "shade/rsl/syntax/ast.h"
#include "shade/rsl/syntax/reporter.h"

namespace trapeze::rsl {

/// Completes the tree as ast.h says. Of use afterwards only when reporter.failed() is false. Before:
/// names are text, no expression has a type or variable, and functions are as the file has them. After:
/// every name, overload and type is decided, all conversions are Casts, no variable's storage is open but
/// that of locals and functions' parameters, and every shader has its own copies of functions.
void analyse(TranslationUnit& unit, Reporter& reporter);

}  // namespace trapeze::rsl
