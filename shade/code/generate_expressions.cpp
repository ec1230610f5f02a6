#include <fmt/format.h>

#include "shade/code/generator.h"

namespace trapeze::rsl {
namespace {

/// Operators of the language are operations of the machine, but for products of matrices, which are not by
/// component.
Op arithmetic_op(Operator op, Base base) {
    const bool matrix = base == Base::Matrix;
    switch (op) {
        case Operator::Add:
            return Op::Add;
        case Operator::Subtract:
            return Op::Subtract;
        case Operator::Multiply:
            return matrix ? Op::MatrixMultiply : Op::Multiply;
        case Operator::Divide:
            return matrix ? Op::MatrixDivide : Op::Divide;
        case Operator::Dot:
            return Op::Dot;
        case Operator::Cross:
            return Op::Cross;
        case Operator::Less:
            return Op::Less;
        case Operator::LessEqual:
            return Op::LessEqual;
        case Operator::Greater:
            return Op::Greater;
        case Operator::GreaterEqual:
            return Op::GreaterEqual;
        case Operator::Equal:
            return Op::Equal;
        case Operator::NotEqual:
            return Op::NotEqual;
        case Operator::And:
            return Op::And;
        default:
            return Op::Or;
    }
}

/// Points are moved, vectors turned, normals turned so that they stay at right angles (RISpec 3.2, section
/// 15.2).
Op transform_op(Base base) {
    if (base == Base::Vector) return Op::TransformVector;
    return base == Base::Normal ? Op::TransformNormal : Op::TransformPoint;
}

/// Something in it must happen only where the expression is wanted.
bool has_effects(const Expression& e) {
    if (e.kind == Expression::Kind::Assignment || e.kind == Expression::Kind::Call) return true;
    for (const ExpressionPtr& child : e.children)
        if (has_effects(*child)) return true;
    return false;
}

}  // namespace

/// An expression's value: see generator.h for where it is. Messages and the listing get the expression's
/// place.
RegisterId Generator::value(const Expression& e, std::optional<RegisterId> into) {
    if (e.at.line) at_ = e.at;
    switch (e.kind) {
        case Expression::Kind::Number:
            return number_value(e, into);
        case Expression::Kind::Text:
            return moved(constant_text(e.text), Base::String, into);
        case Expression::Kind::Variable:
            return moved(register_of(*e.variable), e.type.base, into);
        case Expression::Kind::Element: {
            const RegisterId array = value(*e.children[0]);
            if (!program_->reg(array).type.is_array()) return moved(array, e.type.base, into);
            return element(array, e.type.base, value(*e.children[1]), into);
        }
        case Expression::Kind::Unary: {
            const RegisterId a = value(*e.children[0]);
            return compute(e.op == Operator::Not ? Op::Not : Op::Negate, e.type.base, {a}, into);
        }
        case Expression::Kind::Binary:
            return binary_value(e, into);
        case Expression::Kind::Conditional:
            return conditional_value(e, into);
        case Expression::Kind::Triple:
        case Expression::Kind::Sixteen: {
            Ids parts;
            for (const ExpressionPtr& child : e.children) parts.push_back(value(*child));
            return compute(e.kind == Expression::Kind::Triple ? Op::Triple : Op::Sixteen, e.type.base, parts,
                           into);
        }
        case Expression::Kind::Cast:
            return cast_value(e, into);
        case Expression::Kind::Call:
            return call_value(e, into);
        case Expression::Kind::Assignment:
            return moved(assignment_value(e), e.type.base, into);
        case Expression::Kind::List:
        case Expression::Kind::Member:
            break;
    }
    return constant(0);
}

/// The value in `into`, if there is such a place and it is another one; an array goes element by element. A
/// width that differs is converted by Op::Move.
RegisterId Generator::moved(RegisterId from, Base base, std::optional<RegisterId> into) {
    if (!into || *into == from) return from;
    const Register &source = program_->reg(from), &target = program_->reg(*into);
    if (source.type.is_array() && target.type.is_array()) {
        copy_array(from, *into, base);
        return *into;
    }
    return compute(Op::Move, base, {from}, into);
}

/// A number's register is shared; Op::Move spreads it over a triple or matrix when `into` is one.
RegisterId Generator::number_value(const Expression& e, std::optional<RegisterId> into) {
    return moved(constant(e.number), e.type.base, into);
}

/// a op b, where the analysis has made operands of the types that op wants. The result goes into `into` where
/// there is one, which saves a move to a variable. Operands have been computed before, the left one first.
RegisterId Generator::combined(Operator op, Base base, RegisterId a, RegisterId b,
                               std::optional<RegisterId> into) {
    if (op == Operator::Add && base == Base::String) return compute(Op::Concat, base, {a, b}, into);
    // Relies on the order of enum Operator: Less, LessEqual, Greater, GreaterEqual stand together.
    const bool ordered = op >= Operator::Less && op <= Operator::GreaterEqual;
    if (!ordered || width_of(base_of(a)) != 3) return compute(arithmetic_op(op, base), base, {a, b}, into);
    // Triples are ordered when all their components are.
    RegisterId all = 0;
    for (int k = 0; k < 3; ++k) {
        const RegisterId axis = constant(static_cast<float>(k));
        const RegisterId one = compute(
            arithmetic_op(op, base), base,
            {compute(Op::Component, Base::Float, {a, axis}), compute(Op::Component, Base::Float, {b, axis})});
        all = k == 0 ? one : compute(Op::And, base, {all, one}, k == 2 ? into : std::nullopt);
    }
    return all;
}

/// The left operand first. && and || compute both sides, too: in a grid, leaving one out would part lanes.
RegisterId Generator::binary_value(const Expression& e, std::optional<RegisterId> into) {
    const RegisterId a = value(*e.children[0]), b = value(*e.children[1]);
    return combined(e.op, e.type.base, a, b, into);
}

/// c ? a : b. Where neither side does more than compute, both are computed and lanes choose, which costs less
/// than parting them. Texts are always parted: Select knows no strings.
RegisterId Generator::conditional_value(const Expression& e, std::optional<RegisterId> into) {
    const RegisterId decision = condition(*e.children[0]);
    const bool is_text = e.type.base == Base::String;
    if (!is_text && !has_effects(*e.children[1]) && !has_effects(*e.children[2])) {
        const RegisterId a = value(*e.children[1]), b = value(*e.children[2]);
        return compute(Op::Select, e.type.base, {decision, a, b}, into);
    }
    // A Local, since both halves write it: temporaries are written once.
    const RegisterId result = add_register(Register::Kind::Local, e.type);
    open(Op::If, {}, {decision});
    moved(value(*e.children[1]), e.type.base, result);
    turn_to_else(decision);
    moved(value(*e.children[2]), e.type.base, result);
    close(Op::EndIf);
    return moved(result, e.type.base, into);
}

/// Conversions by width (Move), between Bools and floats, and from a named space: of colours to rgb, of
/// points, vectors, normals and matrices to current space (RISpec 3.2, section 11).
RegisterId Generator::cast_value(const Expression& e, std::optional<RegisterId> into) {
    const Expression& child = *e.children[0];
    const Base to = e.type.base, from = child.type.base;
    RegisterId a = value(child);
    if (!e.text.empty()) {
        if (to != from && width_of(from) != width_of(to)) a = compute(Op::Move, to, {a});
        const RegisterId space = constant_text(e.text);
        if (to == Base::Color) return compute(Op::ConvertColor, to, {space, constant_text("rgb"), a}, into);
        const RegisterId matrix = compute(Op::SpaceMatrix, Base::Matrix, {space, constant_text("current")});
        if (to == Base::Matrix) return compute(Op::MatrixMultiply, to, {a, matrix}, into);
        return compute(transform_op(to), to, {matrix, a}, into);
    }
    if (from == Base::Bool && to != Base::Bool) {
        // A Bool is a lane mask, whose bits are no number: ToFloat makes 1 or 0 of it.
        const RegisterId number =
            compute(Op::ToFloat, Base::Float, {a}, to == Base::Float ? into : std::nullopt);
        return to == Base::Float ? number : compute(Op::Move, to, {number}, into);
    }
    if (to == Base::Bool && from != Base::Bool) return compute(Op::ToBool, to, {a}, into);
    if (width_of(from) != width_of(to)) return compute(Op::Move, to, {a}, into);
    return moved(a, to, into);
}

/// The value of an assignment is what the variable holds after it. An element is set by SetElement, all else
/// is computed right into the variable's register.
RegisterId Generator::assignment_value(const Expression& e) {
    const Expression& target = *e.children[0];
    const Expression& source = *e.children[1];
    const bool is_element = target.kind == Expression::Kind::Element;
    const Variable* const variable = is_element ? target.children[0]->variable : target.variable;
    const ForUniform for_uniform(*this, variable ? variable->storage : Storage::Unspecified);
    if (is_element) {
        const RegisterId array = value(*target.children[0]), index = value(*target.children[1]);
        RegisterId result = value(source);
        if (e.op != Operator::None)
            result =
                combined(e.op, target.type.base, element(array, target.type.base, index, {}), result, {});
        set_element(array, index, result);
        return result;
    }
    const RegisterId to = register_of(*target.variable);
    if (source.kind == Expression::Kind::List) {
        assign_list(source, to);
        return to;
    }
    if (e.op == Operator::None) {
        value(source, to);
        return to;
    }
    combined(e.op, target.type.base, to, value(source), to);
    return to;
}

}  // namespace trapeze::rsl
