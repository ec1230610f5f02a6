#include "shade/rsl/syntax/clone.h"

namespace trapeze::rsl {

/// Types stay (a cast's is the source's), but not what names mean: variables, overloads and functions are
/// found anew for each copy.
ExpressionPtr clone(const ExpressionPtr& e) {
    if (!e) return nullptr;
    auto copy = std::make_unique<Expression>();
    copy->kind = e->kind;
    copy->op = e->op;
    copy->implicit = e->implicit;
    copy->repeats = e->repeats;
    copy->number = e->number;
    copy->text = e->text;
    copy->at = e->at;
    copy->height = e->height;
    copy->type = e->type;
    copy->children.reserve(e->children.size());
    for (const ExpressionPtr& child : e->children) copy->children.push_back(clone(child));
    return copy;
}

/// `outlives`, `growable` and `copied` are the analysis' to set, and start anew.
std::unique_ptr<Variable> clone(const Variable& v) {
    auto copy = std::make_unique<Variable>();
    copy->name = v.name;
    copy->type = v.type;
    copy->structure = v.structure;
    copy->storage = v.storage;
    copy->kind = v.kind;
    copy->output = v.output;
    copy->external = v.external;
    copy->initial = clone(v.initial);
    copy->at = v.at;
    return copy;
}

namespace {

/// `defines` still names the nested function of the original, which is copied itself when its statement is
/// analysed.
StatementPtr clone(const Statement& s) {
    auto copy = std::make_unique<Statement>();
    copy->kind = s.kind;
    copy->levels = s.levels;
    copy->open = s.open;
    copy->named = s.named;
    copy->defines = s.defines;
    copy->at = s.at;
    for (const ExpressionPtr& e : s.expressions) copy->expressions.push_back(clone(e));
    for (const StatementPtr& child : s.children) copy->children.push_back(clone(*child));
    for (const auto& variable : s.variables) copy->variables.push_back(clone(*variable));
    return copy;
}

}  // namespace

/// Functions are copied before they are analysed: each shader has its own, since the analysis writes types
/// and conversions into the tree.
std::unique_ptr<Function> clone(const Function& function) {
    auto copy = std::make_unique<Function>();
    copy->name = function.name;
    copy->result = function.result;
    copy->inside = function.inside;
    copy->typed = function.typed;
    copy->hidden = function.hidden;
    copy->at = function.at;
    for (const auto& parameter : function.parameters) copy->parameters.push_back(clone(*parameter));
    copy->body = clone(*function.body);
    return copy;
}

}  // namespace trapeze::rsl
