/// The types that expressions get, from the root down, and the conversions between them.
#include "shade/rsl/analysis/analyser.h"
#include "shade/rsl/syntax/parser.h"

namespace trapeze::rsl {

/// Gives the expression the type that serves `wanted` best, and converts it if it has to be. Void wants
/// nothing.
void Analyser::choose_type(ExpressionPtr& e, Base wanted) {
    const Choices choices = choices_of(*e);
    if (choices.is_unknown()) return;
    // An array as a whole has no choice of types: it goes where arrays are taken, and nowhere else.
    if (e->type.is_array() && choices.none()) {
        if (e->kind == Expression::Kind::Assignment) choose_array_assignment(*e);
        if (wanted != Base::Void) error(e->at, "this is an array; one of its elements is wanted here");
        return;
    }
    // A colour where a vector is wanted, or the reverse, is no conversion of the language; shaders do it.
    auto base = choices.best_for(wanted);
    if (!base && (base = choices.foreign_triple_for(wanted)))
        reporter_.warning(e->at, "a " + std::string(name_of(*base)) + " becomes a " +
                                     std::string(name_of(wanted)) +
                                     " here: its three numbers are taken as they are");
    if (!base) {
        const bool nothing = choices.has(Base::Void);
        error(e->at, nothing ? "this has no value, a " + std::string(name_of(wanted)) + " is wanted"
                             : "a " + (wanted == Base::Bool ? "condition" : std::string(name_of(wanted))) +
                                   " is wanted here, not a " + choices.text());
        return;
    }
    give_type(*e, *base);
    if (wanted != Base::Void) convert(e, wanted);
}

/// A list's values become elements; another array is taken as it is.
void Analyser::choose_array_assignment(Expression& e) {
    if (e.children[1]->kind != Expression::Kind::List) return choose_type(e.children[1], Base::Void);
    for (ExpressionPtr& child : e.children[1]->children) choose_type(child, e.type.base);
    e.children[1]->type = e.type;
}

/// Puts an implicit cast around an expression of another type. Heights are kept right, since they bound how
/// deep later passes recurse.
void Analyser::convert(ExpressionPtr& e, Base to) {
    if (e->type.base == to) return;
    auto cast = std::make_unique<Expression>();
    cast->kind = Expression::Kind::Cast;
    cast->implicit = true;
    cast->at = e->at;
    cast->height = static_cast<uint16_t>(e->height + 1);
    cast->type.base = to;
    cast->children.push_back(std::move(e));
    e = std::move(cast);
}

/// Gives an expression the type, which is one of its choices, and its operands those that lead there. The
/// second of two walks: possible types went from the leaves up, the chosen one goes from the root down. A
/// node whose choice was offered by a conversion gets that as a node of its own (choose_type()).
void Analyser::give_type(Expression& e, Base base) {
    e.type.base = base;
    switch (e.kind) {
        case Expression::Kind::Number:
        case Expression::Kind::Text:
        case Expression::Kind::Variable:
        case Expression::Kind::List:
        case Expression::Kind::Member:
            break;
        // The array has its type from its declaration; a texture's name with a channel is a text.
        case Expression::Kind::Element:
            choose_type(e.children[1], Base::Float);
            if (e.children[0]->kind != Expression::Kind::Variable) choose_type(e.children[0], Base::Void);
            break;
        case Expression::Kind::Unary:
            choose_type(e.children[0], base);
            break;
        case Expression::Kind::Binary:
            choose_binary(e, base);
            break;
        case Expression::Kind::Conditional:
            choose_type(e.children[0], Base::Bool);
            choose_type(e.children[1], base);
            choose_type(e.children[2], base);
            break;
        case Expression::Kind::Triple:
        case Expression::Kind::Sixteen:
            for (ExpressionPtr& child : e.children) choose_type(child, Base::Float);
            break;
        case Expression::Kind::Cast:
            choose_cast(e);
            break;
        case Expression::Kind::Call:
            choose_call(e, base);
            break;
        case Expression::Kind::Assignment:
            choose_assignment(e);
            break;
    }
}

/// Tries all pairs of types that the operands can have, as binary_types() did, and takes the cheapest that
/// gives `base`.
void Analyser::choose_binary(Expression& e, Base base) {
    const Choices left = choices_of(*e.children[0]), right = choices_of(*e.children[1]);
    std::optional<OperatorPlan> best;
    int least = Choices::kNever;
    for (const Base a : kAllBases)
        for (const Base b : kAllBases) {
            if (!left.has(a) || !right.has(b)) continue;
            const auto planned = plan(e.op, a, b);
            if (!planned || planned->result != base) continue;
            const int cost = left.cost(a) + right.cost(b) + planned->cost;
            if (cost < least) best = planned, least = cost;
        }
    if (!best) return;  // reported
    choose_type(e.children[0], best->left);
    choose_type(e.children[1], best->right);
}

/// The operand gets the type from which the cast is cheapest, and is not converted before. But a float that
/// is cast to a triple of a named space is: it is filled first, and then taken from that space.
void Analyser::choose_cast(Expression& e) {
    const Base to = e.type.base;
    const Choices operand = choices_of(*e.children[0]);
    if (operand.is_unknown()) return;
    const bool fill = !e.text.empty() && operand.best_for(to) == Base::Float && is_triple(to);
    choose_type(e.children[0], fill                                    ? to
                               : operand.cost_to(to) < Choices::kNever ? *operand.best_for(to)
                                                                       : Base::Void);
}

/// The assigned value gets the variable's type; with an operator (+= and such), the type that the operator
/// takes beside the variable.
void Analyser::choose_assignment(Expression& e) {
    const Base to = e.type.base;
    if (e.children[0]->kind == Expression::Kind::Element) choose_type(e.children[0], to);
    if (e.op == Operator::None) return choose_type(e.children[1], to);
    const Choices given = choices_of(*e.children[1]);
    std::optional<OperatorPlan> best;
    int least = Choices::kNever;
    for (const Base from : kAllBases) {
        const auto planned = given.has(from) ? plan(e.op, to, from) : std::nullopt;
        // The variable itself is not converted, and what the operator gives must fit into it again.
        if (!planned || planned->left != to || !conversion_cost(planned->result, to)) continue;
        const int cost = given.cost(from) + planned->cost + *conversion_cost(planned->result, to);
        if (cost < least) best = planned, least = cost;
    }
    if (best) choose_type(e.children[1], best->right);
}

}  // namespace trapeze::rsl
