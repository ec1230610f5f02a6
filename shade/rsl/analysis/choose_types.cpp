/// The types that expressions get, from the root down, and the conversions between them.
#include "shade/rsl/analysis/analyser.h"
#include "shade/rsl/syntax/parser.h"

namespace trapeze::rsl {

/// Gives the expression the type that serves `wanted` best, and converts it if it has to be. Void wants
/// nothing.
void Analyser::settle(ExpressionPtr& e, Base wanted) {
    const Choices choices = choices_of(*e);
    if (choices.is_unknown()) return;
    if (e->type.is_array() && choices.none()) {
        if (e->kind == Expression::Kind::Assignment) settle_array_assignment(*e);
        if (wanted != Base::Void) error(e->at, "this is an array; one of its elements is wanted here");
        return;
    }
    auto base = choices.best_for(wanted);
    if (!base && (base = choices.foreign_triple_for(wanted)))
        messages_.warning(e->at, "a " + std::string(name_of(*base)) + " becomes a " +
                                     std::string(name_of(wanted)) +
                                     " here: its three numbers are taken as they are");
    if (!base) {
        const bool nothing = choices.has(Base::Void);
        error(e->at, nothing ? "this has no value, a " + std::string(name_of(wanted)) + " is wanted"
                             : "a " + (wanted == Base::Bool ? "condition" : std::string(name_of(wanted))) +
                                   " is wanted here, not a " + choices.text());
        return;
    }
    settle_as(*e, *base);
    if (wanted != Base::Void) convert(e, wanted);
}

void Analyser::settle_array_assignment(Expression& e) {
    if (e.children[1]->kind != Expression::Kind::List) return settle(e.children[1], Base::Void);
    for (ExpressionPtr& child : e.children[1]->children) settle(child, e.type.base);
    e.children[1]->type = e.type;
}

/// Puts an implicit cast around an expression of another type.
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

void Analyser::settle_as(Expression& e, Base base) {
    e.type.base = base;
    switch (e.kind) {
        case Expression::Kind::Number:
        case Expression::Kind::Text:
        case Expression::Kind::Variable:
        case Expression::Kind::List:
            break;
        case Expression::Kind::Element:
            settle(e.children[1], Base::Float);
            if (e.children[0]->kind != Expression::Kind::Variable) settle(e.children[0], Base::Void);
            break;
        case Expression::Kind::Unary:
            settle(e.children[0], base);
            break;
        case Expression::Kind::Binary:
            settle_binary(e, base);
            break;
        case Expression::Kind::Conditional:
            settle(e.children[0], Base::Bool);
            settle(e.children[1], base);
            settle(e.children[2], base);
            break;
        case Expression::Kind::Triple:
        case Expression::Kind::Sixteen:
            for (ExpressionPtr& child : e.children) settle(child, Base::Float);
            break;
        case Expression::Kind::Cast:
            settle_cast(e);
            break;
        case Expression::Kind::Call:
            settle_call(e, base);
            break;
        case Expression::Kind::Assignment:
            settle_assignment(e);
            break;
    }
}

void Analyser::settle_binary(Expression& e, Base base) {
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
    settle(e.children[0], best->left);
    settle(e.children[1], best->right);
}

/// A cast takes what needs no conversion before it; what is filled before it is taken from a space is said.
void Analyser::settle_cast(Expression& e) {
    const Base to = e.type.base;
    const Choices operand = choices_of(*e.children[0]);
    if (operand.is_unknown()) return;
    const bool fill = !e.text.empty() && operand.best_for(to) == Base::Float && is_triple(to);
    settle(e.children[0], fill                                    ? to
                          : operand.cost_to(to) < Choices::kNever ? *operand.best_for(to)
                                                                  : Base::Void);
}

void Analyser::settle_assignment(Expression& e) {
    const Base to = e.type.base;
    if (e.children[0]->kind == Expression::Kind::Element) settle(e.children[0], to);
    if (e.op == Operator::None) return settle(e.children[1], to);
    const Choices given = choices_of(*e.children[1]);
    std::optional<OperatorPlan> best;
    int least = Choices::kNever;
    for (const Base from : kAllBases) {
        const auto planned = given.has(from) ? plan(e.op, to, from) : std::nullopt;
        if (!planned || planned->left != to || !conversion_cost(planned->result, to)) continue;
        const int cost = given.cost(from) + planned->cost + *conversion_cost(planned->result, to);
        if (cost < least) best = planned, least = cost;
    }
    if (best) settle(e.children[1], best->right);
}

}  // namespace trapeze::rsl
