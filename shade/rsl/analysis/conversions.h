/// Which types values may have, and what may become what.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "shade/rsl/syntax/ast.h"

namespace trapeze::rsl {

/// All base types, in the order in which they are preferred where nothing decides.
inline constexpr Base kAllBases[] = {Base::Float,  Base::Color,  Base::Point, Base::Vector, Base::Normal,
                                     Base::Matrix, Base::String, Base::Bool,  Base::Void};

/// Colours, points, vectors and normals: what has three floats.
bool is_triple(Base base);
/// Points, vectors and normals among each other; otherwise equal types.
bool same_family(Base a, Base b);

/// The types that an expression can have before its surroundings decide, each with what choosing it costs:
/// conversions within it that the source does not name. A value of a few words, copied freely: one for each
/// expression is kept from the first walk to the second.
class Choices {
  public:
    /// A cost that no sum of conversions reaches, and of which a few can be added without running over.
    static constexpr int kNever = 1 << 28;

    Choices() { costs_.fill(kNever); }
    explicit Choices(Base base) : Choices() { offer(base, 0); }
    /// Choices of an expression with an error: it goes with everything, so that no second error follows from
    /// it.
    static Choices unknown() {
        Choices choices;
        choices.unknown_ = true;
        return choices;
    }

    /// Adds a way to a type; of several the cheapest stays.
    void offer(Base base, int cost) {
        int& entry = costs_[static_cast<size_t>(base)];
        entry = std::min(entry, cost);
    }
    int cost(Base base) const { return unknown_ ? 0 : costs_[static_cast<size_t>(base)]; }
    bool has(Base base) const { return cost(base) < kNever; }
    bool none() const { return !unknown_ && *std::min_element(costs_.begin(), costs_.end()) >= kNever; }
    bool is_unknown() const { return unknown_; }
    /// Cheapest way to a type, conversions included; kNever when there is none.
    int cost_to(Base to) const;
    /// The choice that gets there cheapest; if `to` is Void, the cheapest of all. Nothing when there is none.
    std::optional<Base> best_for(Base to) const;
    /// Where cost_to() is kNever: the triple of another family whose components may serve, a colour for a
    /// point or a vector for a colour. Nothing when there is none.
    std::optional<Base> foreign_triple_for(Base to) const;
    /// "point or vector".
    std::string text() const;

  private:
    std::array<int, 9> costs_;  ///< by Base; kNever where it cannot have the type
    bool unknown_ = false;
};

/// What it costs to make all three components of a float.
inline constexpr int kFillCost = 4;

/// More than any conversion: what only overloads that are a last resort cost.
inline constexpr int kLastResort = 16;

/// How bad it is to convert without being told to; nothing: not allowed. 0: nothing to do.
std::optional<int> conversion_cost(Base from, Base to);

/// How an operator works on two types.
struct OperatorPlan {
    Base result;
    Base left, right;  ///< what the operands are converted to; floats beside triples stay what they are
    int cost;
};
/// What an operator makes of operands of two types; nothing where it does not go with them. && and || take
/// whatever can be a condition.
std::optional<OperatorPlan> plan(Operator op, Base left, Base right);

std::string_view text_of(Operator op);

}  // namespace trapeze::rsl
