// Texture, environment and shadow maps (RISpec 3.2, section 15.7). What they hold is looked up by shade/maps,
// on which the machine does not depend; without maps, as in most tests, every lookup is black.
#include "shade/operations/op_table.h"
#include "shade/vm/context_ops.h"

namespace trapeze::vm {
namespace {

using rsl::Op;

/// Whether shadow() asks for rays instead of a map, by a light that knows where it is; or environment().
bool asks_for_rays(Run& run, const Step& step) {
    const bool may = step.op == Op::Environment || (step.op == Op::Shadow && run.context().light_output);
    return may && run.context().rays && run.registers().text_input(step, 0) == rsl::kTracedMap;
}

void look_up(Run& run, const Step& step, std::span<const Operand> operands) {
    if (asks_for_rays(run, step)) return run.context().rays->trace(run, step, operands);
    if (run.context().maps)
        run.context().maps->look_up(run, step, operands);
    else
        for (size_t k = 0; k < 3; ++k)
            std::fill_n(operands[0].data + k * operands[0].stride, plane_size(run, operands[0]), 0.0f);
}

constexpr ContextRow kMapRows[] = {
    {Op::Texture, look_up}, {Op::Environment, look_up}, {Op::Shadow, look_up},
    {Op::Bump, look_up},    {Op::TextureInfo, look_up},
};

}  // namespace

ContextOp find_map_op(Op op) {
    return context_op_in(kMapRows, op);
}

}  // namespace trapeze::vm
