// Arrays of no length in their type: how many elements they have is in a register beside the array's own.
#include <fmt/format.h>

#include "shade/code/generator.h"

namespace trapeze::rsl {

/// Registers beside that of an array that has no length in its type; others have none. They live where the
/// array does.
void Generator::add_counts(RegisterId array) {
    const Register r = program_->reg(array);
    if (!r.type.is_unsized()) return;
    const RegisterId count = add_register(r.kind, {Base::Float, 0}, r.name + ":count");
    const RegisterId reserved = add_register(r.kind, {Base::Float, 0}, r.name + ":reserved");
    program_->registers[array].count = count;
    program_->registers[array].reserved = reserved;
}

/// The number of an array's elements: where its type has it a constant, as functions are inlined once for
/// each array that they are called with.
RegisterId Generator::count_of(RegisterId array) {
    const Type type = program_->reg(array).type;
    return type.is_unsized() ? program_->reg(array).count : constant(static_cast<float>(type.length));
}

RegisterId Generator::element(RegisterId array, Base base, RegisterId index, std::optional<RegisterId> into) {
    if (!program_->reg(array).type.is_unsized()) return compute(Op::Element, base, {array, index}, into);
    return compute(Op::ArrayElement, base, {array, count_of(array), index}, into);
}

void Generator::set_element(RegisterId array, RegisterId index, RegisterId value) {
    if (program_->reg(array).type.is_unsized())
        emit(Op::SetArrayElement, {array}, {count_of(array), index, value});
    else
        emit(Op::SetElement, {array}, {index, value});
}

/// The count is raised behind the element, and held below what an array may have: so it comes to no end that
/// floats cannot count.
void Generator::push(RegisterId array, RegisterId value) {
    const RegisterId count = count_of(array);
    emit(Op::PushElement, {array}, {count, value});
    const RegisterId more = compute(Op::Add, Base::Float, {count, constant(1)});
    emit(Op::Min, {count}, {more, constant(static_cast<float>(kLongestArray))});
}

/// a = b for whole arrays. Between arrays of a length each, element by element.
void Generator::copy_array(RegisterId from, RegisterId to, Base base) {
    const Type source = program_->reg(from).type, target = program_->reg(to).type;
    if (source.is_unsized() || target.is_unsized()) {
        emit(Op::CopyArray, {to}, {from, count_of(from)});
        if (target.is_unsized()) emit(Op::Move, {count_of(to)}, {count_of(from)});
        return;
    }
    for (int i = 0; i < std::min(source.length, target.length); ++i) {
        const RegisterId index = constant(static_cast<float>(i));
        emit(Op::SetElement, {to}, {index, compute(Op::Element, base, {from, index})});
    }
}

/// {a, b, ...}: one element after the other, from the first. Elements of an array of a length are set as they
/// are computed: a list that reads its own array sees those set before. Of one that is resized all are
/// computed first.
void Generator::assign_list(const Expression& list, RegisterId array) {
    if (!program_->reg(array).type.is_unsized()) {
        const auto length = static_cast<size_t>(program_->reg(array).type.length);
        RegisterId one{};
        for (size_t i = 0; i < (list.repeats ? length : list.children.size()); ++i) {
            if (i < list.children.size()) one = value(*list.children[i]);
            set_element(array, constant(static_cast<float>(i)), one);
        }
        return;
    }
    Ids values;
    for (const ExpressionPtr& child : list.children) values.push_back(value(*child));
    emit(Op::Move, {count_of(array)}, {constant(0)});
    for (const RegisterId one : values) push(array, one);
}

/// push(), pop(), resize(), reserve() and capacity(): the array is the first argument. Reserving takes no
/// memory, which comes as it is needed; capacity() tells what was reserved.
RegisterId Generator::array_value(const Expression& e, std::optional<RegisterId> into) {
    const Op op = e.builtin->op;
    const RegisterId array = value(*e.children[0]);
    const RegisterId count = count_of(array);
    const bool is_unsized = program_->reg(array).type.is_unsized();
    if (!is_unsized && op != Op::ArrayCapacity) {
        diagnostics_.error(e.at, fmt::format("{}() is called for an array of a length of its own, which it "
                                             "keeps: arrays declared with [] can be resized",
                                             e.text));
        throw TooLarge{};
    }
    if (op == Op::ArrayCapacity)
        return is_unsized ? compute(Op::Max, Base::Float, {count, program_->reg(array).reserved}, into)
                          : moved(count, Base::Float, into);
    if (op == Op::ArrayPush) {
        const RegisterId next = value(*e.children[1]);
        at_ = e.at;
        push(array, next);
        return constant(0);
    }
    if (op == Op::ArrayPop) {
        const RegisterId last = compute(Op::Subtract, Base::Float, {count, constant(1)});
        // The count may be what the value goes to.
        const RegisterId taken = element(array, e.type.base, last, {});
        emit(Op::Max, {count}, {last, constant(0)});
        return moved(taken, e.type.base, into);
    }
    const RegisterId wanted = compute(Op::Floor, Base::Float, {value(*e.children[1])});
    const RegisterId most = constant(static_cast<float>(kLongestArray));
    const RegisterId length = compute(Op::Clamp, Base::Float, {wanted, constant(0), most});
    if (op == Op::ArrayReserve) {
        const RegisterId reserved = program_->reg(array).reserved;
        emit(Op::Max, {reserved}, {reserved, length});
        return constant(0);
    }
    at_ = e.at;
    // The machine sees all that is asked for, and says what is too much.
    emit(Op::ResizeArray, {array}, {count, wanted});
    emit(Op::Move, {count}, {length});
    return constant(0);
}

/// spline([basis,] x, array) of an array whose knots are counted in a run; nothing for others.
std::optional<RegisterId> Generator::array_spline(const Expression& e, std::optional<RegisterId> into) {
    const size_t last = e.children.size() - 1;
    if (!e.children[last]->type.is_array()) return {};
    const RegisterId array = value(*e.children[last]);
    if (!program_->reg(array).type.is_unsized()) return {};
    const RegisterId basis = last == 2 ? value(*e.children[0]) : constant_text("catmull-rom");
    return compute(Op::ArraySpline, e.type.base,
                   {basis, value(*e.children[last - 1]), array, count_of(array)}, into);
}

}  // namespace trapeze::rsl
