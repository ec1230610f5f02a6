#include "shade/rsl/front_end_harness.h"

namespace trapeze::testing {
namespace {

using rsl::Expression;
using rsl::Function;
using rsl::Shader;
using rsl::Statement;
using rsl::Variable;

template <class T, class Same>
bool same_list(const std::vector<T>& a, const std::vector<T>& b, Same&& same_item) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [&](const T& x, const T& y) { return (!x && !y) || (x && y && same_item(*x, *y)); });
}

bool same_expression(const Expression& a, const Expression& b) {
    return a.kind == b.kind && a.op == b.op && a.number == b.number && a.text == b.text && a.type == b.type &&
           a.repeats == b.repeats && same_list(a.children, b.children, same_expression);
}

bool same_variable(const Variable& a, const Variable& b) {
    return a.name == b.name && a.type == b.type && a.storage == b.storage && a.kind == b.kind &&
           a.output == b.output && a.external == b.external && !a.initial == !b.initial &&
           (!a.initial || same_expression(*a.initial, *b.initial));
}

bool same_function(const Function& a, const Function& b);

bool same_statement(const Statement& a, const Statement& b) {
    return a.kind == b.kind && a.levels == b.levels &&
           same_list(a.expressions, b.expressions, same_expression) &&
           same_list(a.children, b.children, same_statement) &&
           same_list(a.variables, b.variables, same_variable) && !a.defines == !b.defines &&
           (!a.defines || same_function(*a.defines, *b.defines));
}

bool same_function(const Function& a, const Function& b) {
    return a.name == b.name && a.result == b.result && a.inside == b.inside &&
           same_list(a.parameters, b.parameters, same_variable) && same_statement(*a.body, *b.body);
}

bool same_shader(const Shader& a, const Shader& b) {
    return a.kind == b.kind && a.name == b.name && same_list(a.parameters, b.parameters, same_variable) &&
           same_statement(*a.body, *b.body);
}

}  // namespace

bool same(const rsl::TranslationUnit& a, const rsl::TranslationUnit& b) {
    return same_list(a.functions, b.functions, same_function) && same_list(a.shaders, b.shaders, same_shader);
}

}  // namespace trapeze::testing
