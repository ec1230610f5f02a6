#include <algorithm>

#include "shade/code/blocks.h"
#include "shade/code/optimise.h"
#include "shade/operations/op_table.h"

namespace trapeze::rsl {
namespace {

/// The instructions of the loop [first, last] that may stand in front of it: directly in it, into a
/// temporary, from what the loop does not set. What looks at neighbours stays, since the lanes around may not
/// run. Outputs of what is found count as unset from then on, so that instructions which read only those move
/// too.
std::vector<size_t> invariant(const Program& program, const Code& code, const Blocks& blocks, size_t first,
                              size_t last) {
    std::vector<RegisterId> written_list;
    collect_written(code, first, last, written_list);
    std::vector<bool> written(program.registers.size(), false);
    for (const RegisterId id : written_list) written[id] = true;
    std::vector<size_t> found;
    for (size_t i = first + 1; i < last; ++i) {
        const Instruction& instruction = code[i];
        if (blocks.around[i] != first || !is_repeatable(instruction.op) || reads_neighbours(instruction.op))
            continue;
        if (instruction.outputs != 1 || program.reg(instruction.output()).kind != Register::Kind::Temporary)
            continue;
        bool fixed = true;
        for (size_t k = 0; k < instruction.input_count(); ++k)
            fixed = fixed && !written[instruction.input(k)];
        if (!fixed) continue;
        written[instruction.output()] = false;
        found.push_back(i);
    }
    return found;
}

}  // namespace

/// Instructions that move take their output's region with them. It may be that the loop does not run at all,
/// and they run now: they have no effect but on a temporary (and perhaps a warning of an unknown space), and
/// kernels do not trap.
void hoist_code(Program& program, Code& code) {
    // Loops from the last one back: inner ones come before those around them.
    for (size_t i = code.size(); i-- > 0;) {
        if (!opens_loop(code[i].op)) continue;
        const Blocks blocks(code);
        const std::vector<size_t> found = invariant(program, code, blocks, i, blocks.end[i]);
        if (found.empty()) continue;
        Code moved, rest;
        size_t next = 0;
        for (size_t k = i; k <= blocks.end[i]; ++k) {
            if (next < found.size() && found[next] == k) {
                ++next;
                moved.push_back(std::move(code[k]));
                moved.back().region = code[i].region;
                program.registers[moved.back().output()].region = code[i].region;
            } else {
                rest.push_back(std::move(code[k]));
            }
        }
        const auto at = std::move(moved.begin(), moved.end(), code.begin() + static_cast<std::ptrdiff_t>(i));
        std::move(rest.begin(), rest.end(), at);
    }
}

}  // namespace trapeze::rsl
