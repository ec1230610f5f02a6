/// What structs are taken apart into.
#pragma once

#include <string>
#include <vector>

#include "shade/rsl/syntax/ast.h"
#include "shade/rsl/syntax/reporter.h"

namespace trapeze::rsl {

/// A member that is no struct, and its name behind that of the variable that it is in: "->x", "->inner->x".
struct Leaf {
    std::string name;
    const Variable* member;
};

/// In the order of the source, those of structs in it among them.
std::vector<Leaf> leaves_of(const Struct& structure);

ExpressionPtr new_expression(Expression::Kind kind, std::string text, SourceLocation at);
StatementPtr new_statement(Statement::Kind kind, SourceLocation at);
/// variable = value;
StatementPtr assignment_of(const std::string& variable, ExpressionPtr value, SourceLocation at);

/// A constructor's values, in the order of members, or as pairs of a member's name and its value; null where
/// it is given none.
std::vector<ExpressionPtr> given_to(Expression& call, const Struct& structure, Reporter& reporter);

/// The struct that has a method, this one or one that it has as base; null for none.
const Struct* method_owner(const Struct* structure, const std::string& method);

/// The value that a variable without one has.
ExpressionPtr nothing_in(const Variable& member, SourceLocation at);

/// Whether an expression names a variable whose name begins so.
bool names_any(const Expression& e, const std::string& beginning);

}  // namespace trapeze::rsl
