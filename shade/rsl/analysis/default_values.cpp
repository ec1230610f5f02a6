/// Default values of functions' parameters, and arguments by name (RSL 2).
#include <algorithm>

#include "shade/rsl/analysis/analyser.h"
#include "shade/rsl/syntax/clone.h"

namespace trapeze::rsl {
namespace {

/// Of a default value: it stands in each call that leaves it out.
constexpr int kHighestDefault = 32;

/// Which of the arguments is the first that is a name in front of its value: from there on all are pairs, of
/// parameters that have default values. Their number where none is.
size_t first_named(const Expression& call, const Signature& signature) {
    const auto& parameters = signature.function->parameters;
    const size_t required = parameters.size() - signature.optional, given = call.children.size();
    const auto is_name = [&](const Expression& e) {
        return e.kind == Expression::Kind::Text &&
               std::any_of(parameters.begin() + static_cast<std::ptrdiff_t>(required), parameters.end(),
                           [&](const auto& parameter) { return parameter->name == e.text; });
    };
    size_t first = given;
    while (first >= required + 2 && is_name(*call.children[first - 2])) first -= 2;
    return first;
}

}  // namespace

/// Whether an expression means the same wherever it stands: it names no variables, and no functions of the
/// source.
bool Analyser::is_plain(const Expression& e) const {
    if (e.kind == Expression::Kind::Variable && e.text != "PI") return false;
    if (e.kind == Expression::Kind::Assignment || e.kind == Expression::Kind::List ||
        e.kind == Expression::Kind::Member)
        return false;
    if (e.kind == Expression::Kind::Call &&
        (builtins_named(e.text).empty() || file_functions_.contains(e.text)))
        return false;
    return std::ranges::all_of(e.children, [&](const ExpressionPtr& child) { return is_plain(*child); });
}

/// Leaves the default values that calls may take: of the last parameters, and the same in all calls.
void Analyser::check_defaults(Function& function) {
    bool last = true;
    for (size_t i = function.parameters.size(); i-- > 0;) {
        Variable& parameter = *function.parameters[i];
        const ExpressionPtr& value = parameter.initial;
        const bool is_taken = last && value && !parameter.output && !parameter.type.is_array() &&
                              value->height <= kHighestDefault && is_plain(*value);
        if (value && !is_taken) {
            reporter_.warning(
                parameter.at,
                "the default value of \"" + parameter.name.substr(0, 80) +
                    "\" is ignored: those of functions' parameters stand behind all others, name "
                    "no variables, and are of none that are output or arrays");
            parameter.initial.reset();
        }
        last = is_taken;
    }
}

/// Arguments by name, f(x, "name", value), go to where their parameters stand, in the first function of the
/// source that has such ones.
void Analyser::put_in_order(Expression& call, const std::vector<Signature>& all) {
    if (call.implicit) return;
    for (const Signature& signature : all) {
        if (!signature.function || signature.optional == 0) continue;
        const size_t first = first_named(call, signature);
        if (first == call.children.size() || first > signature.parameters.size()) continue;
        std::vector<ExpressionPtr> given = std::exchange(call.children, {});
        const auto& parameters = signature.function->parameters;
        for (size_t i = 0; i < parameters.size(); ++i) {
            ExpressionPtr value = i < first ? std::move(given[i]) : nullptr;
            for (size_t n = first; n < given.size(); n += 2) {
                if (given[n]->text != parameters[i]->name) continue;
                if (!given[n + 1] || value) error(given[n]->at, "this parameter is given twice");
                value = std::move(given[n + 1]);
            }
            call.children.push_back(value ? std::move(value) : clone(parameters[i]->initial));
        }
        call.implicit = true;
        return;
    }
}

/// Adds the arguments that a call leaves out.
void Analyser::add_defaults(Expression& call, const Signature& signature) {
    if (!signature.function) return;
    for (size_t i = call.children.size(); i < signature.parameters.size(); ++i) {
        call.children.push_back(clone(signature.function->parameters[i]->initial));
        possible_types(*call.children.back());
    }
}

}  // namespace trapeze::rsl
