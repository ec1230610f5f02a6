/// Improves a program without changing what it computes, bit for bit.
#pragma once

#include "shade/code/program.h"

namespace trapeze::rsl {

/// What is to be done; all of it, but for tests that look at one pass. None of the passes depends on another
/// for being right.
struct OptimiseOptions {
    bool fold = true;   ///< constants, copies and common subexpressions
    bool hoist = true;  ///< what does not change in a loop
    bool prune = true;  ///< what nobody reads

    /// The code as it was generated, to which tests compare what the optimiser makes of it.
    static OptimiseOptions none() { return {false, false, false}; }
};

/// In place, before storage is inferred: what passes add or move has none yet.
void optimise(Program& program, const OptimiseOptions& options = {});

// Its passes.

/// Folds constants with the machine's own kernels, follows copies, reuses common subexpressions, and drops
/// the dead half of an If whose condition is constant.
void fold_code(Program& program, Code& code);
/// Moves what a loop computes again and again in front of it.
void hoist_code(Program& program, Code& code);
/// Removes instructions that set nothing but what is never read, and blocks without contents.
void prune_code(Program& program);

}  // namespace trapeze::rsl
