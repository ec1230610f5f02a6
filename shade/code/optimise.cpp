#include "shade/code/optimise.h"

namespace trapeze::rsl {

/// Folding comes before hoisting, which then has less to look at, and after it, for what is now outside is
/// common. Defaults of parameters have no loops worth hoisting from.
void optimise(Program& program, const OptimiseOptions& options) {
    if (options.fold) {
        for (ProgramParameter& parameter : program.parameters) fold_code(program, parameter.initial);
        fold_code(program, program.code);
    }
    if (options.hoist) {
        hoist_code(program, program.code);
        // What several loops computed has become common.
        if (options.fold) fold_code(program, program.code);
    }
    if (options.prune) prune_code(program);
}

}  // namespace trapeze::rsl
