// Texture, environment and shadow maps (RISpec 3.2, section 15.7). What they hold is looked up by shade/maps,
// on which the machine does not depend; without maps, as in most tests, every lookup is black.
#include "shade/operations/op_table.h"
#include "shade/vm/context_ops.h"

namespace trapeze::vm {
namespace {

using rsl::Op;

/// Results of three planes or of one: a float's component stride is 0, so that all three turns of the loop
/// write its one plane.
void fill_with_black(Run& run, std::span<const Operand> operands) {
    for (size_t k = 0; k < 3; ++k)
        std::fill_n(operands[0].data + k * operands[0].stride, plane_size(run, operands[0]), 0.0f);
}

/// Op::Texture, Bump and TextureInfo are told apart behind the interface, by step.op.
void look_up(Run& run, const Step& step, std::span<const Operand> operands) {
    if (run.context().maps)
        run.context().maps->look_up(run, step, operands);
    else
        fill_with_black(run, operands);
}

/// Rays instead of a map, by its name. Shadows are those of a light: its shader knows where it is, and so do
/// the turns of an illuminance block.
Task<> trace_or_look_up(Run& run, const Step& step, std::span<const Operand> operands) {
    if (!run.context().rays || run.registers().text_input(step, 0) != rsl::kTracedMap)
        co_return look_up(run, step, operands);
    const LightOutput* const light = run.context().light_output;
    const bool has_way = light ? light->is_known : run.light_of_turn() != nullptr;
    if (step.op == Op::Environment || has_way)
        co_return co_await run.context().rays->trace(run, step, operands);
    run.warn(
        step,
        "shadow(\"raytrace\") is traced in illuminate, solar and illuminance blocks, where it is known which "
        "way the light comes; here it is 0",
        "rsl-shadow-without-light");
    fill_with_black(run, operands);
}

constexpr ContextRow kMapRows[] = {{Op::Texture, look_up}, {Op::Bump, look_up}, {Op::TextureInfo, look_up}};
constexpr WaitingRow kWaitingMapRows[] = {{Op::Environment, trace_or_look_up},
                                          {Op::Shadow, trace_or_look_up}};

}  // namespace

ContextOp find_map_op(Op op) {
    return context_op_in(kMapRows, op);
}

WaitingOp find_waiting_map_op(Op op) {
    return waiting_op_in(kWaitingMapRows, op);
}

}  // namespace trapeze::vm
