#include "shade/rsl/analysis/conversions.h"

#include "shade/rsl/syntax/parser.h"

namespace trapeze::rsl {
namespace {

// What choices cost. Only their order matters: taking a normal for a vector is almost nothing, filling a
// triple with a float is worse than choosing an overload that gives the triple. kSameFamily: among vectors
// and normals; kUnusual: where a point is involved; kTruth: between a condition and a float; kFill: a float
// becomes all three components; kFillMatrix: a float becomes the diagonal; kOdd: operators on triples that
// are seldom meant (products of vectors).
constexpr int kSameFamily = 1, kUnusual = 2, kTruth = 3, kFill = kFillCost, kFillMatrix = 5, kOdd = 6;

/// What coordinate systems move: points, vectors and normals.
bool is_geometric(Base base) {
    return base == Base::Point || base == Base::Vector || base == Base::Normal;
}

/// a + b and a - b. A point minus a point is a vector, a point plus a vector a point; two points added are a
/// point, which real shaders do when they average.
std::optional<OperatorPlan> plan_sum(Operator op, Base a, Base b) {
    if (a == Base::Float && b == Base::Float) return OperatorPlan{a, a, b, 0};
    if (a == Base::String && b == Base::String && op == Operator::Add) return OperatorPlan{a, a, b, 0};
    if (a == Base::Float && is_triple(b)) return OperatorPlan{b, a, b, kFill};
    if (is_triple(a) && b == Base::Float) return OperatorPlan{a, a, b, kFill};
    if (!is_triple(a) || !same_family(a, b)) return {};
    if (a == Base::Color) return OperatorPlan{a, a, b, 0};
    // The affine rules: differences of points are vectors; a vector minus a point is one, too, but unusual.
    const bool point_a = a == Base::Point, point_b = b == Base::Point;
    if (op == Operator::Subtract && point_a == point_b && a != Base::Normal)
        return OperatorPlan{Base::Vector, a, b, 0};
    if (op == Operator::Subtract && point_b) return OperatorPlan{Base::Vector, a, b, kUnusual};
    if (point_a || point_b) return OperatorPlan{Base::Point, a, b, point_a && point_b ? kUnusual : 0};
    return OperatorPlan{a == b ? a : Base::Vector, a, b, 0};
}

/// a * b and a / b: by component for triples, of matrices for matrices; a float beside a matrix becomes one.
/// Products of points and vectors by component are not RISpec's, but shaders have them: they cost more than
/// all that is.
std::optional<OperatorPlan> plan_product(Base a, Base b) {
    if (a == Base::Float && b == Base::Float) return OperatorPlan{a, a, b, 0};
    if (a == Base::Float && is_triple(b)) return OperatorPlan{b, a, b, b == Base::Color ? kSameFamily : 0};
    if (is_triple(a) && b == Base::Float) return OperatorPlan{a, a, b, a == Base::Color ? kSameFamily : 0};
    if (a == Base::Matrix && b == Base::Matrix) return OperatorPlan{a, a, b, 0};
    const bool with_matrix =
        (a == Base::Matrix && b == Base::Float) || (a == Base::Float && b == Base::Matrix);
    if (with_matrix) return OperatorPlan{Base::Matrix, Base::Matrix, Base::Matrix, kFillMatrix};
    if (!is_triple(a) || !same_family(a, b)) return {};
    if (a == Base::Color) return OperatorPlan{a, a, b, 0};
    return OperatorPlan{a == b                                 ? a
                        : b == Base::Point || a == Base::Point ? Base::Point
                                                               : Base::Vector,
                        a, b, kOdd};
}

/// A small cost of triples that are no vectors, so that triples in products of vectors become vectors.
int unlike_vector(Base base) {
    return base == Base::Vector || !is_triple(base) ? 0 : kSameFamily;
}

/// An operator whose operands are converted to one type: dot products and comparisons.
std::optional<OperatorPlan> plan_alike(Base result, Base a, Base b) {
    if (same_family(a, b)) return OperatorPlan{result, a, b, unlike_vector(a) + unlike_vector(b)};
    if (a == Base::Float && (is_triple(b) || b == Base::Matrix)) return OperatorPlan{result, b, b, kFill};
    if (b == Base::Float && (is_triple(a) || a == Base::Matrix)) return OperatorPlan{result, a, a, kFill};
    return {};
}

/// Comparisons of triples by size, which RISpec does not have: a value that may be a float is one, even where
/// an overload that gives floats is the last resort, as trace()'s distance is.
std::optional<OperatorPlan> plan_order(Base a, Base b) {
    auto planned = plan_alike(Base::Bool, a, b);
    if (planned) planned->cost += kLastResort + kOdd;
    return planned;
}

/// && and ||, of anything that can be true.
std::optional<OperatorPlan> plan_logic(Base a, Base b) {
    const auto left = conversion_cost(a, Base::Bool), right = conversion_cost(b, Base::Bool);
    if (!left || !right) return {};
    return OperatorPlan{Base::Bool, Base::Bool, Base::Bool, *left + *right};
}

/// Every operator but && and ||, on types other than Bool. A plan says what both operands are converted to,
/// what comes out, and what of that RISpec does not have, as a cost; nothing where the operator has no
/// meaning.
std::optional<OperatorPlan> plan_values(Operator op, Base a, Base b) {
    switch (op) {
        case Operator::Add:
        case Operator::Subtract:
            return plan_sum(op, a, b);
        case Operator::Multiply:
        case Operator::Divide:
            return plan_product(a, b);
        case Operator::Dot:
            if (!is_triple(a) && !is_triple(b)) return {};
            return plan_alike(Base::Float, a, b);
        case Operator::Cross:
            if (!is_geometric(a) || !is_geometric(b)) return {};
            return OperatorPlan{Base::Vector, a, b, unlike_vector(a) + unlike_vector(b)};
        case Operator::Less:
        case Operator::LessEqual:
        case Operator::Greater:
        case Operator::GreaterEqual:
            // For triples: whether the comparison holds for all components.
            if (a == Base::Float && b == Base::Float) return OperatorPlan{Base::Bool, a, b, 0};
            if (!is_triple(a) && !is_triple(b)) return {};
            return plan_order(a, b);
        case Operator::Equal:
        case Operator::NotEqual:
            if (a == Base::Void || b == Base::Void) return {};
            return plan_alike(Base::Bool, a, b);
        default:
            return {};
    }
}

}  // namespace

bool is_triple(Base base) {
    return base == Base::Color || is_geometric(base);
}

bool same_family(Base a, Base b) {
    return a == b || (is_geometric(a) && is_geometric(b));
}

/// Points, vectors and normals stand for each other, floats fill triples and matrices, truth is 1 or 0.
/// Nothing becomes a string, and a triple no float.
std::optional<int> conversion_cost(Base from, Base to) {
    if (from == to) return 0;
    if (is_geometric(from) && is_geometric(to))
        return from == Base::Point || to == Base::Point ? kUnusual : kSameFamily;
    if (from == Base::Float && is_triple(to)) return kFill;
    if (from == Base::Float && to == Base::Matrix) return kFillMatrix;
    if (from == Base::Float && to == Base::Bool) return kTruth;
    if (from == Base::Bool && to == Base::Float) return kTruth;
    if (from == Base::Bool && is_triple(to)) return kTruth + kFill;
    return {};
}

/// The sum of a choice's own cost and of converting it, over all choices; kept from exceeding kNever, which
/// would overflow when added up.
int Choices::cost_to(Base to) const {
    if (unknown_) return 0;
    int least = kNever;
    for (const Base base : kAllBases)
        if (const auto converting = conversion_cost(base, to))
            least = std::min(least, cost(base) + *converting);
    return std::min(least, kNever);
}

/// The cheapest choice that can become `to`; among equals the first of kAllBases. Strictly cheaper ones alone
/// replace a choice, which makes the order of kAllBases part of the language here. Void asks for whatever is
/// cheapest.
std::optional<Base> Choices::best_for(Base to) const {
    if (unknown_) return to;
    std::optional<Base> best;
    int least = kNever;
    for (const Base base : kAllBases) {
        const auto converting = to == Base::Void ? std::optional<int>(0) : conversion_cost(base, to);
        if (!converting || cost(base) + *converting >= least) continue;
        best = base;
        least = cost(base) + *converting;
    }
    return best;
}

/// Only asked where no conversion leads to `to`: real shaders assign colours to vectors and compute on, and
/// are warned instead of refused.
std::optional<Base> Choices::foreign_triple_for(Base to) const {
    if (unknown_ || !is_triple(to) || cost_to(to) < kNever) return {};
    std::optional<Base> best;
    for (const Base base : kAllBases)
        if (is_triple(base) && cost(base) < (best ? cost(*best) : kNever)) best = base;
    return best;
}

/// Names of the cheapest choices, "point or vector": the types that the source itself gives, before
/// conversions.
std::string Choices::text() const {
    int least = kNever;
    for (const Base base : kAllBases) least = std::min(least, cost(base));
    std::string text;
    for (const Base base : kAllBases)
        if (cost(base) == least) text += (text.empty() ? "" : " or ") + std::string(name_of(base));
    return text;
}

/// && and || go first: they take operands as conditions, before truth would be counted as a number. The cost
/// makes a plan without truth values win wherever there is one.
std::optional<OperatorPlan> plan(Operator op, Base left, Base right) {
    if (op == Operator::And || op == Operator::Or) return plan_logic(left, right);
    // Truth counts as 1 or 0 in sums and comparisons.
    const int truths = (left == Base::Bool ? 1 : 0) + (right == Base::Bool ? 1 : 0);
    auto planned =
        plan_values(op, left == Base::Bool ? Base::Float : left, right == Base::Bool ? Base::Float : right);
    if (planned) planned->cost += kTruth * truths;
    return planned;
}

/// In the order of enum Operator.
std::string_view text_of(Operator op) {
    static constexpr std::string_view kMarks[] = {
        "", "+", "-", "*", "/", ".", "^", "<", "<=", ">", ">=", "==", "!=", "&&", "||", "-", "!"};
    return kMarks[static_cast<size_t>(op)];
}

}  // namespace trapeze::rsl
