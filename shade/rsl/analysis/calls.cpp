/// Which function a call means.
#include <algorithm>

#include "shade/operations/op_table.h"
#include "shade/rsl/analysis/analyser.h"
#include "shade/rsl/analysis/globals.h"
#include "shade/rsl/analysis/suggestions.h"
#include "shade/rsl/syntax/parser.h"
#include "shade/rsl/syntax/printer.h"

namespace trapeze::rsl {
namespace {

/// Overloads that are listed where none fits.
constexpr size_t kMostCandidatesShown = 8;  // some names have dozens

// Functions of later renderers; known to be missing here.
constexpr std::string_view kNotSupported[] = {"blinn", "cosinelight_rate", "getlights", "hair"};

/// Functions whose first argument names a file, and may choose a channel of it: "name"[2].
bool is_map(const Builtin& builtin) {
    return row_of(builtin.op).context == ContextFamily::Maps;
}

/// What a built-in function may cost at most to be meant, where functions of the source fit: these hide it,
/// unless a float, say, would have to become a colour for them. Functions are polymorphic by their arguments'
/// types (RISpec 14.2).
int most_beside(const std::vector<Signature>& all, const std::vector<int>& costs) {
    int least = Choices::kNever + kFillCost;
    for (size_t i = 0; i < all.size(); ++i)
        if (all[i].function && costs[i] < Choices::kNever) least = std::min(least, costs[i]);
    return least - kFillCost;
}

/// The parameter that argument i stands for; null behind them, where more may follow.
const Signature::Parameter* parameter_at(const Signature& signature, size_t i) {
    if (i < signature.parameters.size()) return &signature.parameters[i];
    return signature.more ? &signature.parameters.back() : nullptr;
}

/// Whether a signature takes so many arguments.
bool count_fits(const Signature& signature, size_t given) {
    const size_t fixed = signature.parameters.size();
    if (given < fixed && given >= fixed - signature.optional) return true;
    if (given == fixed || (given > fixed && (signature.more || signature.anything))) return true;
    return signature.pairs && given > fixed && (given - fixed) % 2 == 0;
}

/// Whether argument i is the name of a pair of name and value.
bool is_pair_name(const Signature& signature, size_t i) {
    return signature.pairs && i >= signature.parameters.size() && (i - signature.parameters.size()) % 2 == 0;
}

}  // namespace

/// All functions that the name may mean, those of the source first. Nested functions see those of the bodies
/// around them, but a function of the file sees none of its caller's: the walk outwards ends at the first
/// body that is not nested. No function calls itself: in its own body the name means the built-in ones.
std::vector<Signature> Analyser::candidates(const Expression& call) {
    std::vector<Signature> all;
    const auto built_in = builtins_named(call.text);
    const auto is_meant = [&](const Instance* instance) {
        return built_in.empty() || !instance || instance->complete;
    };
    for (size_t number = bodies_.size();;) {  // nested ones, from the inside out
        const Body& at = bodies_[--number];
        const size_t last = number + 1 < bodies_.size() ? bodies_[number + 1].first_scope : scopes_.size();
        for (size_t i = last; i-- > at.first_scope;)
            if (const auto entry = scopes_[i].functions.find(call.text); entry != scopes_[i].functions.end())
                for (const Instance* instance : entry->second)
                    if (is_meant(instance)) all.push_back(signature_of(*instance->function));
        if (number == 0 || !at.nested) break;
    }
    const auto entry = file_functions_.find(call.text);
    if (entry != file_functions_.end())
        for (const Function* function : entry->second) {
            const auto known = file_instances_.find(function);
            if (is_meant(known == file_instances_.end() ? nullptr : known->second))
                all.push_back(signature_of(*function));
        }
    for (const Builtin& builtin : built_in) all.push_back(signature_of(builtin));
    return all;
}

/// What converting an argument to its parameter costs. Arrays and output arguments are not converted at all.
/// An argument of unknown type costs nothing: it has been reported, and must not make further messages.
int Analyser::cost_of_argument(const Signature::Parameter& parameter, const Expression& argument) const {
    const Choices choices = choices_of(argument);
    if (choices.is_unknown()) return 0;
    if (parameter.output && !is_place(argument)) return Choices::kNever;
    if (parameter.any) return 0;
    if (parameter.any_array) return argument.type.is_array() ? 0 : Choices::kNever;
    if (parameter.type.is_array() != argument.type.is_array()) return Choices::kNever;
    if (parameter.type.is_array()) {
        const bool fits =
            parameter.type.base == argument.type.base &&
            (parameter.type.length == Type::kUnsized || argument.type.length == Type::kUnsized ||
             parameter.type.length == argument.type.length);
        return fits ? 0 : Choices::kNever;
    }
    if (parameter.output && !same_family(parameter.type.base, argument.type.base)) return Choices::kNever;
    return choices.cost_to(parameter.type.base);
}

/// Whether an argument is a triple of another family than its parameter, a colour for a vector or the
/// reverse.
bool Analyser::becomes_as_it_is(const Signature::Parameter& parameter, const Expression& argument) const {
    return !parameter.output && !parameter.type.is_array() && !argument.type.is_array() &&
           choices_of(argument).foreign_triple_for(parameter.type.base).has_value();
}

/// Costs of a call's candidates. Where none fits, functions of the source take a colour for a vector, or the
/// reverse, as assignments do; choose_type() warns of that.
std::vector<int> Analyser::costs_of(const std::vector<Signature>& all, const Expression& call) const {
    std::vector<int> costs;
    for (const Signature& signature : all) costs.push_back(cost_of(signature, call, false));
    if (std::any_of(costs.begin(), costs.end(), [](int cost) { return cost < Choices::kNever; }))
        return costs;
    for (size_t i = 0; i < all.size(); ++i)
        if (all[i].function) costs[i] = cost_of(all[i], call, true);
    return costs;
}

/// Cost of converting all arguments of a call; kNever when the call does not fit. `as_they_are`: numbers of a
/// triple of another family may be taken.
int Analyser::cost_of(const Signature& signature, const Expression& call, bool as_they_are) const {
    if (!count_fits(signature, call.children.size())) return Choices::kNever;
    int cost = signature.builtin && signature.builtin->last_resort ? kLastResort : 0;
    // What takes so many arguments and no more is meant before what has default values for others.
    if (call.children.size() < signature.parameters.size()) ++cost;
    for (size_t i = 0; i < call.children.size(); ++i) {
        const Expression& argument = *call.children[i];
        int one = 0;
        if (const Signature::Parameter* parameter = parameter_at(signature, i))
            one = as_they_are && becomes_as_it_is(*parameter, argument)
                      ? kLastResort
                      : cost_of_argument(*parameter, argument);
        else if (is_pair_name(signature, i))
            one = argument.type.is_array() ? Choices::kNever : choices_of(argument).cost_to(Base::String);
        if (one >= Choices::kNever) return Choices::kNever;
        cost += one;
    }
    return std::min(cost, Choices::kNever - 1);
}

/// Every overload that fits offers its result type, at what its arguments cost. What a call's result may be
/// depends on where it stands as much as on its arguments: noise() may be a float, a colour or a point. So
/// all that fit are offered upwards, and one is chosen on the way back.
Choices Analyser::call_types(Expression& e) {
    write_as_known(e);
    if (e.kind != Expression::Kind::Call) return possible_types_within(e);
    const std::vector<Signature> all = candidates(e);
    put_in_order(e, all);
    // A texture's name may have a channel.
    const bool map = !all.empty() && all.back().builtin && is_map(*all.back().builtin);
    bool unknown = false;
    for (size_t i = 0; i < e.children.size(); ++i) {
        if (map && i == 0) channel_ = e.children[0].get();
        unknown = possible_types_once(*e.children[i]).is_unknown() || unknown;
    }
    if (all.empty()) {
        unknown_function(e);
        return Choices::unknown();
    }
    Choices choices;
    const std::vector<int> costs = costs_of(all, e);
    const int most = most_beside(all, costs);
    for (size_t i = 0; i < all.size(); ++i)
        if (costs[i] < Choices::kNever && (all[i].function || costs[i] <= most))
            choices.offer(all[i].result.base, costs[i]);
    if (!choices.none()) return choices;
    if (!unknown) explain(all, e);
    return Choices::unknown();
}

/// Whether a spline has too few knots, which is said.
bool Analyser::lacks_knots(const Expression& call) {
    constexpr size_t kFewest = 4;  // one cubic segment
    if (call.children.empty()) return false;
    const Expression& last = *call.children.back();
    const bool named = choices_of(*call.children.front()).has(Base::String);
    const size_t before = named ? 2 : 1, given = call.children.size();
    size_t knots = given > before ? given - before : 0;
    if (last.type.is_array()) knots = last.type.length > 0 ? static_cast<size_t>(last.type.length) : kFewest;
    if (knots >= kFewest) return false;
    error(call.at, "a spline has at least four knots, not " + std::to_string(knots));
    return true;
}

/// Says what is wrong with the one function that a call can mean, or lists all of the specification:
/// overloads beyond that are not shown, as nobody should learn them from a message.
void Analyser::explain(std::vector<Signature> all, const Expression& call) {
    std::erase_if(all, [](const Signature& s) { return s.builtin && s.builtin->last_resort; });
    if (all.back().builtin && all.back().builtin->op == Op::Spline && lacks_knots(call)) return;
    const auto fits = [&](const Signature& s) { return count_fits(s, call.children.size()); };
    const auto fitting = std::count_if(all.begin(), all.end(), fits);
    if (fitting == 1) {
        const Signature& signature = *std::find_if(all.begin(), all.end(), fits);
        for (size_t i = 0; i < call.children.size(); ++i) {
            const Expression& argument = *call.children[i];
            const Signature::Parameter* parameter = parameter_at(signature, i);
            if (!parameter || cost_of_argument(*parameter, argument) < Choices::kNever) continue;
            const std::string which = "argument " + std::to_string(i + 1 - std::min(i, signature.hidden)) +
                                      " of " + call.text + " ";
            const std::string is =
                argument.type.is_array() ? print(argument.type) : choices_of(argument).text();
            if (parameter->output && !is_place(argument))
                error(argument.at, which + "is written to, and must be a variable");
            else
                error(argument.at,
                      which + "is a " + is + ", " +
                          (parameter->type.base == Base::Void ? "an array" : "a " + print(parameter->type)) +
                          " is wanted");
            reporter_.note(argument.at, print(signature));
            return;
        }
    }
    std::string given;
    // Several fit by their number, or none: the arguments' types and the overloads are shown side by side.
    for (size_t i = all.front().hidden; i < call.children.size(); ++i) {
        const Expression& argument = *call.children[i];
        given += (given.empty() ? "" : ", ") +
                 (argument.type.is_array() ? print(argument.type) : choices_of(argument).text());
    }
    error(call.at, "no " + call.text + " takes (" + given + ")");
    for (size_t i = 0; i < std::min(all.size(), kMostCandidatesShown); ++i)
        reporter_.note(call.at, "there is " + print(all[i]));
    if (all.size() > kMostCandidatesShown)
        reporter_.note(call.at, "and " + std::to_string(all.size() - kMostCandidatesShown) + " more");
}

/// Says that there is no such function, and which name was meant, if one is near. Names of the source and of
/// the language are both considered; the nearest is shown.
void Analyser::unknown_function(const Expression& call) {
    const std::string name = "\"" + call.text.substr(0, 80) + "\"";
    if (std::find(std::begin(kNotSupported), std::end(kNotSupported), call.text) != std::end(kNotSupported)) {
        error(call.at, "function " + name + " of later renderers is not supported");
        return;
    }
    Suggestion suggestion(call.text);
    for (const auto& [candidate, functions] : file_functions_) suggestion.consider(candidate);
    for (const Builtin& builtin : builtins()) suggestion.consider(builtin.name);
    error(call.at, "there is no function " + name + suggestion.text());
}

/// The overload with the wanted result whose arguments cost least. Among equals the first one stands, so that
/// the order of candidates() and of builtins.cpp decides.
void Analyser::choose_call(Expression& e, Base base) {
    const std::vector<Signature> all = candidates(e);
    const Signature* best = nullptr;
    int least = Choices::kNever;
    const std::vector<int> costs = costs_of(all, e);
    const int most = most_beside(all, costs);
    for (size_t i = 0; i < all.size(); ++i) {
        if (all[i].result.base != base || (all[i].builtin && costs[i] > most))
            continue;  // as in call_types()
        if (costs[i] < least) best = &all[i], least = costs[i];
    }
    if (!best) return;  // reported
    e.builtin = best->builtin;
    if (e.builtin && e.builtin->op == Op::Spline) lacks_knots(e);
    add_defaults(e, *best);
    for (size_t i = 0; i < e.children.size(); ++i) choose_argument(e, i, *best);
    // The copy of the function is made only now, when nothing else may still be meant.
    if (best->function)
        enter_function(e, *best->function);
    else
        use_globals(e);
    check_ray_arguments(e, *best);
    if (e.builtin && e.builtin->op == Op::Unavailable && unavailable_.insert(e.builtin->name).second)
        reporter_.warning(e.at,
                          "function \"" + e.text + "\" of later renderers is not there, and does nothing");
}

/// Named optional arguments may be of any type; output arguments must be places, and stay what they are. An
/// output argument is not converted, since the value that comes back could not be.
void Analyser::choose_argument(Expression& call, size_t i, const Signature& signature) {
    ExpressionPtr& argument = call.children[i];
    const Signature::Parameter* parameter = parameter_at(signature, i);
    if (!parameter) {
        if (is_named_output(call, i) && is_place(*argument)) check_written(*argument);
        return choose_type(argument, is_pair_name(signature, i) ? Base::String : Base::Void);
    }
    if (parameter->output) {
        check_written(*argument);
        if (parameter->type.is_array()) resize(*argument, signature.builtin != nullptr);
        if (argument->kind == Expression::Kind::Element) choose_type(argument, argument->type.base);
    } else if (!parameter->type.is_array() && !parameter->any_array) {
        choose_type(argument, parameter->type.base);
    }
}

/// Finds or makes this shader's copy of a written function. A copy that is not complete is being analysed
/// further out: it calls itself, which RSL does not allow, as calls are inlined.
void Analyser::enter_function(Expression& call, const Function& function) {
    // A nested function was copied where it was declared, one of the file is copied at its first call.
    const auto nested = instance_of_copy_.find(&function);
    const auto known = file_instances_.find(&function);
    Instance* instance = nested != instance_of_copy_.end() ? nested->second
                         : known != file_instances_.end()  ? known->second
                                                           : instance_of(function, false, call.at);
    if (!instance) return;
    if (!instance->complete) {
        error(call.at, "function \"" + call.text + "\" calls itself, directly or through others");
        return;
    }
    call.function = instance->function.get();
    // All of the function is inlined in place of this call.
    body().operations += instance->operations;
    body().array_floats += instance->array_floats;
    body().deepest = std::max(body().deepest, body().depth + call.height + instance->depth);
    if (body().deepest > kDeepestInlined)
        error(call.at, "functions that call functions nest too deeply here");
}

/// Variables of the renderer that the source does not name, and that the function reads. They are made as if
/// the shader had named them, so that the machine fills them before the run.
void Analyser::use_globals(const Expression& call) {
    const Op op = call.builtin->op;
    const size_t given = call.children.size();
    if (op_traits::has(op, op_traits::kNeedsNg) && given == 2) global("Ng");
    if (op_traits::has(op, op_traits::kNeedsP)) global("P");
    if (op_traits::has(op, op_traits::kNeedsUV)) global("u"), global("v");
    if (op == Op::Texture && (given == 1 || (given > 1 && call.children[1]->type.base == Base::String)))
        global("s"), global("t");
}

}  // namespace trapeze::rsl
