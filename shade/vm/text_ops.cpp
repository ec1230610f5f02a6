// Operations on texts, which are the same for all vertices.
#include <fmt/format.h>

#include <cmath>

#include "shade/vm/context_ops.h"
#include "shade/vm/text_format.h"

namespace trapeze::vm {
namespace {

using rsl::Op;

/// An index into an array of texts. Texts are uniform, so the first lane speaks for all; what is out of range
/// is clamped, as it is for arrays of numbers.
size_t element_of(Run& run, const Step& step, size_t index_operand, int length) {
    const size_t i = index_operand;
    const float index = run.registers().operand(run.registers().register_of(step, i)).data[0];
    const float last = static_cast<float>(std::max(length, 1) - 1);
    return static_cast<size_t>(index > 0 ? std::min(std::floor(index), last) : 0);
}

/// Texts are strings of Registers and not planes: these functions find them by register and use none of the
/// operands' data.
void move_text(Run& run, const Step& step, std::span<const Operand>) {
    run.registers().text(run.registers().register_of(step, 0)) = run.registers().text_input(step, 0);
}

/// Copies one string out of an array of them; a step's operands name the array, and its elements stand one
/// after the other from the array's place on.
void text_element(Run& run, const Step& step, std::span<const Operand>) {
    Registers& registers = run.registers();
    const rsl::RegisterId array = registers.register_of(step, 1);
    registers.text(registers.register_of(step, 0)) =
        registers.text(array, element_of(run, step, 2, registers.reg(array).type.length));
}

/// The index is held within the array, as for numbers: an element outside is none, and a shader must not end
/// the render.
void set_text_element(Run& run, const Step& step, std::span<const Operand>) {
    Registers& registers = run.registers();
    const rsl::RegisterId array = registers.register_of(step, 0);
    registers.text(array, element_of(run, step, 1, registers.reg(array).type.length)) =
        registers.text(registers.register_of(step, 2));
}

void clear_texts(Run& run, const Step& step, std::span<const Operand>) {
    Registers& registers = run.registers();
    const rsl::RegisterId array = registers.register_of(step, 0);
    for (int i = 0; i < registers.reg(array).type.length; ++i)
        registers.text(array, static_cast<size_t>(i)).clear();
}

/// == and != of texts, which are uniform.
void equal_texts(Run& run, const Step& step, std::span<const Operand> operands) {
    const bool equal = run.registers().text_input(step, 0) == run.registers().text_input(step, 1);
    fill_bool(run, operands[0], equal == (step.op == Op::Equal));
}

/// Texts are uniform in the language, so one result serves all lanes.
void concat(Run& run, const Step& step, std::span<const Operand>) {
    constexpr size_t kMaxText = 1 << 16;  // a loop must not grow it without end
    std::string joined;
    for (size_t i = 0; i + step.outputs < step.count; ++i) joined += run.registers().text_input(step, i);
    if (joined.size() > kMaxText) joined.resize(kMaxText);
    run.registers().text(run.registers().register_of(step, 0)) = std::move(joined);
}

/// The arguments behind a format, as they are in one lane. The views of strings point into the registers:
/// they are good until a text of the step is set.
std::vector<TextValue> values_at(Run& run, const Step& step, std::span<const Operand> operands, size_t lane) {
    Registers& registers = run.registers();
    std::vector<TextValue> values;
    for (size_t i = step.outputs + 1u; i < step.count; ++i) {
        const rsl::RegisterId id = registers.register_of(step, i);
        TextValue& value = values.emplace_back();
        const rsl::Type type = registers.reg(id).type;
        if (type.base == rsl::Base::String) {
            value.is_text = true;
            value.text = registers.text(id);
        } else if (type.base == rsl::Base::Bool) {
            value.floats.push_back(Run::at(operands[i], 0, lane) != 0 ? 1.0f : 0.0f);
        } else {
            for (int k = 0; k < rsl::width_of(type.base); ++k)
                value.floats.push_back(Run::at(operands[i], k, lane));
        }
    }
    return values;
}

/// format(): values that vary are those of the first vertex, for a text is uniform.
void format_op(Run& run, const Step& step, std::span<const Operand> operands) {
    run.registers().text(run.registers().register_of(step, 0)) =
        format_text(run.registers().text_input(step, 0), values_at(run, step, operands, 0));
}

/// printf() speaks for each vertex when its values differ from one to the other.
void print(Run& run, const Step& step, std::span<const Operand> operands) {
    Diagnostics* diagnostics = run.context().diagnostics;
    if (!diagnostics || run.masks().none()) return;
    bool varying = false;
    for (size_t i = step.outputs + 1u; i < step.count; ++i)
        varying = varying || run.registers().reg(run.registers().register_of(step, i)).varying;
    const size_t vertices = run.context().batch ? run.context().batch->vertices : 1;
    const uint32_t* running = run.masks().current();
    for (size_t lane = 0; lane < vertices; ++lane) {
        if (!running[lane]) continue;
        if (!run.may_print())
            return run.warn(step, "printf() has said enough: the rest of this grid's is left out",
                            "rsl-printed-too-much");
        std::string text =
            format_text(run.registers().text_input(step, 0), values_at(run, step, operands, lane));
        // A message is a line of its own, as shaders end theirs by themselves.
        while (!text.empty() && text.back() == '\n') text.pop_back();
        diagnostics->note(step.at, std::move(text));
        if (!varying) return;
    }
}

/// match(pattern, subject).
void match(Run& run, const Step& step, std::span<const Operand> operands) {
    const bool found = matches(run.registers().text_input(step, 0), run.registers().text_input(step, 1));
    fill_operand(run, operands[0], std::array{found ? 1.0f : 0.0f});
}

constexpr ContextRow kTextRows[] = {
    {Op::Move, move_text},    {Op::Element, text_element}, {Op::SetElement, set_text_element},
    {Op::Clear, clear_texts}, {Op::Equal, equal_texts},    {Op::NotEqual, equal_texts},
    {Op::Concat, concat},     {Op::Format, format_op},     {Op::Print, print},
    {Op::Match, match},
};

}  // namespace

ContextOp find_text_op(Op op) {
    return context_op_in(kTextRows, op);
}

}  // namespace trapeze::vm
