#include "shade/code/blocks.h"

#include "shade/operations/op_table.h"

namespace trapeze::rsl {

/// One walk with a stack of the blocks that are open. The code's blocks nest properly: generation makes no
/// others, and passes take out openings and ends together.
Blocks::Blocks(const Code& code)
    : end(code.size(), kNone),
      middle(code.size(), kNone),
      opening(code.size(), kNone),
      around(code.size(), kNone) {
    std::vector<size_t> open;
    for (size_t i = 0; i < code.size(); ++i) {
        const Op op = code[i].op;
        if (closes_block(op)) {
            opening[i] = open.back();
            end[open.back()] = i;
            if (middle[open.back()] != kNone) end[middle[open.back()]] = i;
            open.pop_back();
        }
        if (divides_block(op)) {
            opening[i] = open.back();
            middle[open.back()] = i;
        }
        // A middle lies in the block that it divides; openings and ends lie in the block around theirs.
        if (!open.empty()) around[i] = open.back();
        if (opens_block(op)) open.push_back(i);
    }
}

/// An id is added as often as it is written.
void collect_written(const Code& code, size_t first, size_t last, std::vector<RegisterId>& ids) {
    for (size_t i = first; i < last; ++i)
        for (size_t k = 0; k < code[i].outputs; ++k) ids.push_back(code[i].operands[k]);
}

}  // namespace trapeze::rsl
