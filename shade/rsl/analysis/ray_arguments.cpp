/// Optional arguments of calls that send rays, where their names are constants. shade/rays/ray_arguments.cpp
/// looks at the others.
#include "shade/operations/op_table.h"
#include "shade/operations/ray_parameters.h"
#include "shade/rsl/analysis/analyser.h"

namespace trapeze::rsl {
namespace {

/// What can be said of an argument before the shader runs: its type, and the text itself where it is a
/// literal.
RayArgumentValue value_of(const Expression& e) {
    using Is = RayArgumentValue::Is;
    if (e.type.is_array()) return {Is::Other};
    if (e.type.base == Base::Float) {
        if (e.kind == Expression::Kind::Number) return {Is::Number, nullptr, e.number};
        return {Is::Number};
    }
    if (e.type.is_triple()) return {Is::Triple};
    if (e.type.base != Base::String) return {Is::Other};
    return {Is::Text, e.kind == Expression::Kind::Text ? &e.text : nullptr};
}

/// Whether rays are sent for sure: what names a map may be told more.
bool sends_rays_now(const Expression& call) {
    const Op op = call.builtin->op;
    if (op != Op::Environment && op != Op::Shadow) return sends_rays(op);
    const Expression& map = *call.children.front();
    return map.kind == Expression::Kind::Text && map.text == kTracedMap;
}

}  // namespace

/// Pairs of name and value stand behind the parameters; a last name without a value has been refused by then
/// (count_fits()).
void Analyser::check_ray_arguments(const Expression& call, const Signature& signature) {
    if (!signature.builtin || !signature.pairs || call.children.empty() || !sends_rays_now(call)) return;
    for (size_t i = signature.parameters.size(); i + 1 < call.children.size(); i += 2)
        check_ray_argument(call.text, call.at, *call.children[i], *call.children[i + 1]);
}

/// `at`: of the call, by which a run knows the warning again. Names that are computed are known in the run
/// alone, which gives the same warning then, unless it was given here.
void Analyser::check_ray_argument(std::string_view call, SourceLocation at, const Expression& name,
                                  const Expression& value) {
    if (name.kind != Expression::Kind::Text) return;
    const bool of_map = call == "environment" || call == "shadow";
    const std::string problem = ray_argument_problem(call, name.text, value_of(value), of_map);
    if (!problem.empty())
        reporter_.diagnostics().warning(name.at, problem,
                                        ray_argument_warning(at.source, at.line, at.column, name.text));
}

}  // namespace trapeze::rsl
