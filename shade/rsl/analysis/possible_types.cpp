/// The types that expressions can have, from the leaves up.
#include <cmath>

#include "shade/rsl/analysis/analyser.h"
#include "shade/rsl/syntax/clone.h"
#include "shade/rsl/syntax/parser.h"
#include "shade/rsl/syntax/printer.h"

namespace trapeze::rsl {
namespace {

constexpr float kPi = 3.14159265358979323846f;  // RISpec 3.2, section 12: PI is predefined

/// Whether an expression can be one text: then a number in brackets behind it is the channel of a map, as in
/// texture("name"[2]), and no index. Arrays, and what has no known type yet, are none.
bool is_string(const Expression& e, const Choices& choices) {
    return !e.type.is_array() && !choices.is_unknown() && choices.has(Base::String);
}

}  // namespace

/// What the first walk found for an expression; unknown, which goes with everything, where it has not been
/// there.
Choices Analyser::choices_of(const Expression& e) const {
    const auto entry = choices_.find(&e);
    return entry == choices_.end() ? Choices::unknown() : entry->second;
}

/// All types that an expression can have. They are kept for the walk down, and each expression counts once.
Choices Analyser::possible_types(Expression& e) {
    ++body().operations;
    ++body().own_operations;
    const Choices choices = possible_types_within(e);
    choices_.insert_or_assign(&e, choices);
    return choices;
}

/// Possible types of an expression that may have been examined already, before it became an argument.
Choices Analyser::possible_types_once(Expression& e) {
    const auto known = choices_.find(&e);
    return known != choices_.end() ? known->second : possible_types(e);
}

/// One kind of expression each. What has no fitting type is reported here, once, and is unknown from then on,
/// so that nothing around it is reported for the same reason.
Choices Analyser::possible_types_within(Expression& e) {
    switch (e.kind) {
        case Expression::Kind::Number:
            return Choices(Base::Float);
        case Expression::Kind::Text:
            return Choices(Base::String);
        case Expression::Kind::Variable:
            return variable_types(e);
        case Expression::Kind::Element:
            return element_types(e);
        case Expression::Kind::Unary: {
            const Choices operand = possible_types(*e.children[0]);
            Choices choices;
            if (operand.is_unknown()) return operand;
            // ! wants truth; - keeps triples and matrices what they are, and makes truth a float.
            if (e.op == Operator::Not) {
                choices.offer(Base::Bool, operand.cost_to(Base::Bool));
            } else {
                for (const Base base : kAllBases)
                    if (is_triple(base) || base == Base::Matrix) choices.offer(base, operand.cost(base));
                choices.offer(Base::Float, operand.cost_to(Base::Float));
            }
            if (!choices.none()) return choices;
            error(e.at, "\"" + std::string(text_of(e.op)) + "\" does not go with a " + operand.text());
            return Choices::unknown();
        }
        case Expression::Kind::Binary:
            return binary_types(e);
        case Expression::Kind::Conditional:
            return conditional_types(e);
        case Expression::Kind::Triple:
        case Expression::Kind::Sixteen:
        case Expression::Kind::List:
            return tuple_types(e);
        case Expression::Kind::Cast:
            return cast_types(e);
        case Expression::Kind::Call:
            return call_types(e);
        case Expression::Kind::Assignment:
            return assignment_types(e);
        case Expression::Kind::Member:
            break;
    }
    return Choices::unknown();
}

/// A variable's own type: the innermost of its name, then the renderer's, then what encloses a nested
/// function. PI becomes a number here, unless the shader has a variable of that name.
Choices Analyser::variable_types(Expression& e) {
    e.variable = find_variable(e.text);
    if (!e.variable && e.text == "PI") {
        e.kind = Expression::Kind::Number;
        e.number = kPi;
        return Choices(Base::Float);
    }
    // Functions ought to name the renderer's variables as extern; that was not always checked.
    if (!e.variable) e.variable = global(e.text);
    if (!e.variable && body().nested) e.variable = find_outside(e.text, bodies_.size() - 1);
    if (!e.variable) {
        unknown_variable(e);
        return Choices::unknown();
    }
    e.type = e.variable->type;
    return e.type.is_array() ? Choices() : Choices(e.type.base);
}

/// True for v[k] of a triple and m[i][j] of a matrix, which are other words for comp. A triple written out,
/// as (a, b, c)[1], is not among them: its type is still open.
bool Analyser::is_component(const Expression& e) const {
    const Expression& of = *e.children[0];
    if (of.type.is_array()) return false;
    const auto single = [&](Base base) { return !choices_of(of).is_unknown() && choices_of(of).has(base); };
    return of.kind != Expression::Kind::Triple &&
           (single(Base::Color) || single(Base::Point) || single(Base::Vector) || single(Base::Normal));
}

/// a[i]: an element of an array; v[k] and m[i][j], other words for comp(), become calls of it; "name"[k]
/// before a texture call is the name with a channel.
Choices Analyser::element_types(Expression& e) {
    Expression& of = *e.children[0];
    // m[i][j]: two Elements around a matrix become one call with two indices.
    if (of.kind == Expression::Kind::Element && of.children[0]->kind == Expression::Kind::Variable) {
        const Choices matrix = possible_types(*of.children[0]);
        if (!of.children[0]->type.is_array() && !matrix.is_unknown() && matrix.has(Base::Matrix)) {
            e.kind = Expression::Kind::Call;
            e.text = "comp";
            ExpressionPtr inner = std::move(e.children[0]);
            ExpressionPtr column = std::move(e.children[1]);
            e.children = std::move(inner->children);
            e.children.push_back(std::move(column));
            return call_types(e);
        }
    }
    const Choices choices = possible_types(of);
    if (choices.is_unknown()) return choices;
    if (is_component(e)) {
        e.kind = Expression::Kind::Call;
        e.text = "comp";
        return call_types(e);
    }
    const Choices index = possible_types(*e.children[1]);
    if (!index.is_unknown() && index.cost_to(Base::Float) >= Choices::kNever)
        error(e.children[1]->at, "an index is a float, not a " + index.text());
    if (is_string(of, choices) && channel_ == &e) {  // texture("name"[2], ...)
        e.type.base = Base::String;
        return Choices(Base::String);
    }
    if (!of.type.is_array()) {
        error(e.at, "a " + choices.text() + " has no elements");
        return Choices::unknown();
    }
    e.type = {of.type.base, 0};
    check_index(e);
    return Choices(of.type.base);
}

/// Only an index that is a constant can be judged; the machine clamps all others. RSL leaves indices outside
/// of an array undefined: here a constant one is an error.
void Analyser::check_index(const Expression& element) {
    const int length = element.children[0]->type.length;
    const Expression* index = element.children[1].get();
    // A number with a minus sign is no number yet, but an operator and a number.
    const bool negative = index->kind == Expression::Kind::Unary && index->op == Operator::Negate;
    if (negative) index = index->children[0].get();
    if (index->kind != Expression::Kind::Number || length <= 0) return;
    // Indices are rounded down, as the machine does.
    const double value = std::floor(negative ? -static_cast<double>(index->number) : index->number);
    if (value >= 0 && value < length) return;
    error(element.children[1]->at,
          "this array has " + std::to_string(length) + " elements, 0 to " + std::to_string(length - 1));
}

/// Reports a whole array where one value is wanted.
static bool is_whole_array(const Expression& e, Reporter& reporter) {
    if (!e.type.is_array()) return false;
    reporter.error(e.at, "this is an array; one of its elements is wanted here");
    return true;
}

/// All results that the operator gives for pairs of types that its operands can have. Two operands of several
/// possible types each make at most some tens of pairs; the cheapest plan for each result is what is offered.
Choices Analyser::binary_types(Expression& e) {
    const Choices left = possible_types(*e.children[0]), right = possible_types(*e.children[1]);
    const bool arrays =
        is_whole_array(*e.children[0], reporter_) || is_whole_array(*e.children[1], reporter_);
    if (arrays || left.is_unknown() || right.is_unknown()) return Choices::unknown();
    Choices choices;
    for (const Base a : kAllBases)
        for (const Base b : kAllBases)
            if (left.has(a) && right.has(b))
                if (const auto planned = plan(e.op, a, b))
                    choices.offer(planned->result, left.cost(a) + right.cost(b) + planned->cost);
    if (!choices.none()) return choices;
    error(e.at, "\"" + std::string(text_of(e.op)) + "\" does not go with a " + left.text() + " and a " +
                    right.text());
    return Choices::unknown();
}

/// The types that both values can become. Where one value is unknown, after an error, the other decides
/// alone.
Choices Analyser::conditional_types(Expression& e) {
    const Choices condition = possible_types(*e.children[0]);
    const Choices yes = possible_types(*e.children[1]), no = possible_types(*e.children[2]);
    for (const ExpressionPtr& child : e.children)
        if (is_whole_array(*child, reporter_)) return Choices::unknown();
    if (condition.cost_to(Base::Bool) >= Choices::kNever)
        error(e.children[0]->at, "a condition is wanted here, not a " + condition.text());
    if (yes.is_unknown()) return no;
    if (no.is_unknown()) return yes;
    Choices choices;
    for (const Base base : kAllBases)
        if (yes.has(base) || no.has(base)) {
            const int cost = yes.cost_to(base) + no.cost_to(base);
            if (cost < Choices::kNever) choices.offer(base, cost);
        }
    if (!choices.none()) return choices;
    error(e.at, "one value of \"?\" is a " + yes.text() + ", the other a " + no.text());
    return Choices::unknown();
}

/// (a, b, c) may be any triple, and what it is is decided by where it stands. Braces make arrays, and stand
/// only where an array is declared or assigned.
Choices Analyser::tuple_types(Expression& e) {
    if (e.kind == Expression::Kind::List) {
        error(e.at, "values in braces stand only where an array is declared");
        return Choices::unknown();
    }
    for (const ExpressionPtr& child : e.children) {
        const Choices part = possible_types(*child);
        if (!is_whole_array(*child, reporter_) && part.cost_to(Base::Float) >= Choices::kNever)
            error(child->at, "a float is wanted here, not a " + part.text());
    }
    // Three numbers cost nothing as any triple: what stands around them decides.
    if (e.kind == Expression::Kind::Sixteen) return Choices(Base::Matrix);
    Choices choices;
    for (const Base base : kAllBases)
        if (is_triple(base)) choices.offer(base, 0);
    return choices;
}

/// The type that is named, if the operand can become it; a space goes with colours, triples and matrices
/// alone.
Choices Analyser::cast_types(Expression& e) {
    const Choices operand = possible_types(*e.children[0]);
    const Base base = e.type.base;
    if (is_whole_array(*e.children[0], reporter_) || operand.is_unknown()) return Choices(base);
    bool possible = operand.cost_to(base) < Choices::kNever;
    // Told to, a colour may become a vector and so on.
    for (const Base from : kAllBases)
        possible = possible || (is_triple(base) && is_triple(from) && operand.has(from));
    if (!possible)
        error(e.at, "a " + operand.text() + " cannot become a " + std::string(name_of(base)) +
                        (base == Base::Float ? " (xcomp, ycomp, zcomp and comp take one component)" : ""));
    return Choices(base);
}

/// A variable or an element of one. Components have been turned into calls by then.
bool Analyser::is_place(const Expression& e) const {
    return e.kind == Expression::Kind::Variable ||
           (e.kind == Expression::Kind::Element && e.children[0]->kind == Expression::Kind::Variable);
}

/// v[k] = x, which has been read as comp(v, k), as setcomp(v, k, x); v[k] += x with comp(v, k) + x. Later
/// stages know one way to set a component. The index is read twice for +=, as a copy of its expression, so
/// one that has an effect has it twice.
Choices Analyser::component_assignment_types(Expression& e) {
    if (!is_place(*e.children[0]->children[0])) {
        error(e.children[0]->at, "this cannot be assigned to");
        return Choices::unknown();
    }
    ExpressionPtr& given = e.children[1];
    if (e.op != Operator::None) {
        auto combined = std::make_unique<Expression>();
        combined->kind = Expression::Kind::Binary;
        combined->op = e.op;
        combined->at = e.at;
        combined->height = e.height;
        combined->children.push_back(clone(e.children[0]));
        combined->children.push_back(std::move(given));
        given = std::move(combined);
        e.op = Operator::None;
    }
    ExpressionPtr component = std::move(e.children[0]);
    ExpressionPtr value = std::move(given);
    e.kind = Expression::Kind::Call;
    e.text = "setcomp";
    e.children = std::move(component->children);
    e.children.push_back(std::move(value));
    return call_types(e);
}

/// Whether an array is a variable that has only the length of its first values.
static bool is_growable(const Expression& array) {
    return array.kind == Expression::Kind::Variable && array.variable && array.variable->growable;
}

/// a = b or a = {1, 2, 3}. Whole arrays have no choices: their type is that of the left side, and no
/// conversion makes another.
Choices Analyser::array_assignment_types(Expression& e) {
    const Expression &left = *e.children[0], &right = *e.children[1];
    if (right.kind == Expression::Kind::List) {
        for (const ExpressionPtr& child : right.children) possible_types(*child);
        if (left.type.length > 0 && right.children.size() > static_cast<size_t>(left.type.length) &&
            !is_growable(left))
            error(right.at, std::to_string(right.children.size()) + " values for the " +
                                std::to_string(left.type.length) + " elements of an array");
        if (right.repeats && (left.type.is_unsized() || is_growable(left)))
            error(right.at, "\"...\" fills arrays of a length of their own alone");
    } else if (possible_types(*e.children[1]).is_unknown()) {
        return Choices::unknown();
    }
    const bool fits = right.kind == Expression::Kind::List ||
                      (right.type.is_array() && right.type.base == left.type.base &&
                       (right.type.length == left.type.length || right.type.length == Type::kUnsized ||
                        left.type.length == Type::kUnsized || is_growable(left)));
    if (!fits || e.op != Operator::None || left.kind != Expression::Kind::Variable) {
        error(e.at, "an array is assigned an array of its type and length, or values in braces");
        return Choices::unknown();
    }
    check_written(left);
    const bool keeps_length =
        right.kind == Expression::Kind::List
            ? right.repeats || right.children.size() == static_cast<size_t>(left.type.length)
            : right.type.length == left.type.length;
    if (!keeps_length) resize(left, false);
    e.type = left.type;
    return {};
}

/// Arrays that have the length of their first values have none of their own from here on. An index behind
/// those values that stood before is an error already.
void Analyser::resize(const Expression& array, bool by_builtin) {
    Variable* const variable = array.variable;
    if (!variable || variable->type.length == Type::kUnsized) return;
    if (variable->growable)
        variable->type.length = Type::kUnsized;
    else if (by_builtin)
        error(array.at, "array \"" + variable->name + "\" has a length of its own, and keeps it: \"" +
                            variable->name + "[]\" would declare one that can be resized");
}

/// The type of the variable, if the value can become it. Where what is assigned to is a component, the
/// assignment becomes a call of setcomp().
Choices Analyser::assignment_types(Expression& e) {
    const Choices place = possible_types(*e.children[0]);
    const Expression& left = *e.children[0];
    if (left.kind == Expression::Kind::Call && left.text == "comp") return component_assignment_types(e);
    if (left.type.is_array()) return array_assignment_types(e);
    const Choices given = possible_types(*e.children[1]);
    if (is_whole_array(*e.children[1], reporter_) || place.is_unknown()) return Choices::unknown();
    if (!is_place(left)) {
        error(left.at, "this cannot be assigned to");
        return Choices::unknown();
    }
    check_written(left);
    e.type = left.type;
    const Base base = left.type.base;
    if (given.is_unknown()) return Choices(base);
    int cost = Choices::kNever;
    if (e.op == Operator::None) cost = given.cost_to(base);
    for (const Base from : kAllBases)
        if (e.op != Operator::None && given.has(from))
            if (const auto planned = plan(e.op, base, from))
                if (planned->left == base && conversion_cost(planned->result, base))
                    cost = std::min(cost, given.cost(from) + planned->cost);
    // A colour that is assigned to a vector, or the reverse, is warned of in choose_type().
    const bool as_it_is = e.op == Operator::None && given.foreign_triple_for(base);
    if (cost < Choices::kNever || as_it_is) return Choices(base);
    error(e.at, "a " + given.text() + " cannot be " +
                    (e.op == Operator::None ? "assigned to"
                                            : "combined by \"" + std::string(text_of(e.op)) + "=\" with") +
                    " a " + std::string(name_of(base)));
    return Choices::unknown();
}

/// Whether a variable may be written to, directly or as an output argument. What RISpec forbids and shaders
/// do all the same is let pass with a warning: the shader works on a copy, which nobody else sees.
void Analyser::check_written(const Expression& place) {
    const Expression& e = place.kind == Expression::Kind::Element ? *place.children[0] : place;
    Variable* variable = e.variable;
    if (!variable) return;
    const std::string name = "\"" + variable->name + "\"";
    switch (variable->kind) {
        case Variable::Kind::Global:
            if (!variable->output && warned_.insert(variable).second)
                reporter_.warning(place.at, name + " is not to be assigned to in " +
                                                std::string(name_of(shader_->kind)) +
                                                " shaders: only this one sees the change");
            // Code generation makes the copy at the body's beginning.
            variable->copied = variable->copied || !variable->output;
            break;
        case Variable::Kind::Parameter:
            if (!variable->output && warned_.insert(variable).second)
                reporter_.warning(place.at, "parameter " + name + " is assigned to, and is not output");
            break;
        // A parameter of this function or of one around it, which makes a local variable of it
        // (copy_written_parameters()).
        case Variable::Kind::FunctionParameter: {
            if (variable->output) break;
            if (variable->type.is_array()) {
                error(place.at, "array " + name + " cannot be assigned to: it is no output parameter");
                break;
            }
            for (Body& open : bodies_)
                if (open.instance)
                    for (const auto& parameter : open.instance->function->parameters)
                        if (parameter.get() == variable) open.written_parameters.insert(variable);
            if (warned_.insert(variable).second)
                reporter_.warning(place.at, "parameter " + name +
                                                " is assigned to, and is not output: the "
                                                "caller sees no change");
            break;
        }
        case Variable::Kind::Local:
            break;
    }
}

}  // namespace trapeze::rsl
