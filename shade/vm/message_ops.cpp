// What shaders ask of each other, of attributes, options and the renderer (RISpec 3.2, section 15.8).
#include "shade/vm/context_ops.h"

namespace trapeze::vm {
namespace {

using rsl::Op;

/// Outputs: found (1 or 0), the value, which is kept when there is none; input: the name. Texts are uniform
/// and registers of their own; the planes of operand 1 are then not used.
void ask(Run& run, const Step& step, std::span<const Operand> operands) {
    Registers& registers = run.registers();
    const rsl::RegisterId value = registers.register_of(step, 1);
    const rsl::Type type = registers.reg(value).type;
    bool found = false;
    // Arrays of no length in their type are not asked for.
    if (run.context().messages && !type.is_unsized()) {
        std::span<std::string> texts;
        if (type.base == rsl::Base::String)
            texts = {&registers.text(value), static_cast<size_t>(std::max(type.length, 1))};
        found = run.context().messages->find(step.op, registers.text_input(step, 0), type, operands[1], texts,
                                             run.asked_light());
    }
    fill_operand(run, operands[0], std::array{found ? 1.0f : 0.0f});
}

/// Of the light whose turn it is in illuminance; 0 outside.
void is_light_category(Run& run, const Step& step, std::span<const Operand> operands) {
    Lights* const lights = run.context().lights;
    const bool is_so = lights && run.light_of_turn() &&
                       lights->in_category(*run.light_of_turn(), run.registers().text_input(step, 0));
    fill_operand(run, operands[0], std::array{is_so ? 1.0f : 0.0f});
}

/// shadername() of the shader that runs, or of the one of a kind that is on the same grid.
void shader_name(Run& run, const Step& step, std::span<const Operand>) {
    Registers& registers = run.registers();
    const std::string kind = step.count > step.outputs ? registers.text_input(step, 0) : std::string();
    registers.text(registers.register_of(step, 0)) = kind.empty() ? run.registers().program().name
                                                     : run.context().messages
                                                         ? run.context().messages->shader_name(kind)
                                                         : std::string();
}

constexpr ContextRow kMessageRows[] = {
    {Op::LightMessage, ask},      {Op::SurfaceMessage, ask},     {Op::DisplacementMessage, ask},
    {Op::AtmosphereMessage, ask}, {Op::IncidentMessage, ask},    {Op::OppositeMessage, ask},
    {Op::VariableMessage, ask},   {Op::AttributeMessage, ask},   {Op::OptionMessage, ask},
    {Op::RendererInfo, ask},      {Op::ShaderName, shader_name}, {Op::IsLightCategory, is_light_category},
};

}  // namespace

ContextOp find_message_op(Op op) {
    return context_op_in(kMessageRows, op);
}

}  // namespace trapeze::vm
