/// Structs of RSL 2, each member of which becomes a variable of its own.
#pragma once

#include "shade/rsl/syntax/ast.h"
#include "shade/rsl/syntax/reporter.h"

namespace trapeze::rsl {

/// Variables of structs become variables of their members, "v->x"; so do functions' parameters and the
/// arguments of calls. What a function returns becomes output parameters of it. Afterwards no variable,
/// function or expression is of a struct. Of use only when reporter.failed() is false.
void flatten_structs(TranslationUnit& unit, Reporter& reporter);

}  // namespace trapeze::rsl
