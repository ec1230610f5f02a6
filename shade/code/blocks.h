/// Where the blocks of a program's code begin, divide and end. All passes over code ask this in place of
/// matching openings and ends themselves; it holds until instructions are moved or taken out.
#pragma once

#include <cstddef>
#include <vector>

#include "shade/code/program.h"

namespace trapeze::rsl {

/// Indices into the code, one for each instruction; kNone where there is nothing to name. An If without Else
/// has no middle; a Loop's middle is its LoopStep, a Gather's its GatherElse.
struct Blocks {
    static constexpr size_t kNone = ~size_t{0};
    /// The code is well nested, as the generator makes it; one pass with a stack.
    explicit Blocks(const Code& code);

    std::vector<size_t> end;      ///< of an opening instruction, and of its middle: the closing one
    std::vector<size_t> middle;   ///< of an opening instruction: its Else, GatherElse or LoopStep; kNone
    std::vector<size_t> opening;  ///< of a middle or closing instruction
    std::vector<size_t> around;   ///< of any instruction: the opening of the innermost block around it; kNone
};

/// Adds `id` to `ids` for each register that code[first, last) writes.
void collect_written(const Code& code, size_t first, size_t last, std::vector<RegisterId>& ids);

}  // namespace trapeze::rsl
