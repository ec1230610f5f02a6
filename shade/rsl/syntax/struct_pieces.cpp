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
