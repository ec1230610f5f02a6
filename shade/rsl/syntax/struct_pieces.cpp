#include "shade/rsl/syntax/struct_pieces.h"

#include <algorithm>
#include <utility>

namespace trapeze::rsl {
namespace {

/// Recurses as deep as structs nest: kDeepestStruct.
void add_leaves(const Struct& structure, const std::string& before, std::vector<Leaf>& to) {
    for (const auto& member : structure.members) {
        const std::string name = before + "->" + member->name;
        if (member->structure)
            add_leaves(*member->structure, name, to);
        else
            to.push_back({name, member.get()});
    }
}

}  // namespace

std::vector<Leaf> leaves_of(const Struct& structure) {
    std::vector<Leaf> all;
    add_leaves(structure, "", all);
    return all;
}

ExpressionPtr new_expression(Expression::Kind kind, std::string text, SourceLocation at) {
    auto e = std::make_unique<Expression>();
    e->kind = kind;
    e->text = std::move(text);
    e->at = at;
    return e;
}

StatementPtr new_statement(Statement::Kind kind, SourceLocation at) {
    auto s = std::make_unique<Statement>();
    s->kind = kind;
    s->at = at;
    return s;
}

StatementPtr assignment_of(const std::string& variable, ExpressionPtr value, SourceLocation at) {
    ExpressionPtr e = new_expression(Expression::Kind::Assignment, "", at);
    e->height = static_cast<uint16_t>(value->height + 1);
    e->children.push_back(new_expression(Expression::Kind::Variable, variable, at));
    e->children.push_back(std::move(value));
    StatementPtr s = new_statement(Statement::Kind::Evaluate, at);
    s->expressions.push_back(std::move(e));
    return s;
}

std::vector<ExpressionPtr> given_to(Expression& call, const Struct& structure, Reporter& reporter) {
    std::vector<ExpressionPtr> given(structure.members.size());
    std::vector<ExpressionPtr>& arguments = call.children;
    bool by_name = !arguments.empty() && arguments.size() % 2 == 0;
    for (size_t i = 0; i < arguments.size() && by_name; i += 2)
        by_name = arguments[i]->kind == Expression::Kind::Text && structure.find(arguments[i]->text);
    if (!by_name && arguments.size() > given.size()) {
        reporter.error(call.at, "struct \"" + structure.name + "\" has " + std::to_string(given.size()) +
                                    " members, not " + std::to_string(arguments.size()));
        return given;
    }
    for (size_t i = 0; i < arguments.size(); i += by_name ? 2 : 1) {
        size_t number = i;
        if (by_name)
            for (number = 0; structure.members[number]->name != arguments[i]->text;) ++number;
        given[number] = std::move(arguments[i + (by_name ? 1 : 0)]);
    }
    return given;
}

const Struct* method_owner(const Struct* structure, const std::string& method) {
    while (structure && std::ranges::find(structure->methods, method) == structure->methods.end())
        structure = structure->base;
    return structure;
}

ExpressionPtr nothing_in(const Variable& member, SourceLocation at) {
    const bool is_text = member.type.base == Base::String;
    const auto one = [&] {
        return new_expression(is_text ? Expression::Kind::Text : Expression::Kind::Number, "", at);
    };
    if (!member.type.is_array()) return one();
    ExpressionPtr list = new_expression(Expression::Kind::List, "", at);
    list->height = 2;
    for (int i = 0; i < member.type.length; ++i) list->children.push_back(one());
    return list;
}

bool names_any(const Expression& e, const std::string& beginning) {
    if (e.kind == Expression::Kind::Variable && e.text.starts_with(beginning)) return true;
    return std::ranges::any_of(e.children,
                               [&](const ExpressionPtr& child) { return names_any(*child, beginning); });
}

}  // namespace trapeze::rsl
