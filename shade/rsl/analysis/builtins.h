/// The built-in functions of the shading language with all their overloads (RISpec 3.2, section 15, and what
/// later shaders use).
#pragma once

#include <algorithm>
#include <span>
#include <string_view>

#include "shade/operations/op.h"
#include "shade/rsl/syntax/ast.h"
#include "shade/rsl/syntax/type.h"

namespace trapeze::rsl {

/// One overload. Types are letters: f float, c color, p point, v vector, n normal, m matrix, s string, w
/// nothing; capitals are output parameters. In `parameters` also: "[" after a letter: an array of it of any
/// length; "#" an array of any type; "*" at the end: named optional arguments follow, a string and a value
/// each; "+" after a letter, at the end: more of that type may follow; "." at the end: any number of anything
/// (printf, format); "?" any type, as output.
struct Builtin {
    std::string_view name;
    char result;
    std::string_view parameters;
    Op op;
    bool last_resort = false;  ///< beyond the specification: taken only where no other overload fits
};

/// Whether a letter of a parameter list is of one that the function sets.
constexpr bool is_output_letter(char letter) {
    return letter == '?' || (letter >= 'A' && letter <= 'Z');
}

/// By its parameters alone: what optional arguments set is sets_by_name()'s to tell.
constexpr bool sets_arguments(const Builtin& builtin) {
    return std::ranges::any_of(builtin.parameters, is_output_letter);
}

/// Whether a function of rays or point clouds sets the variable behind a name among its optional arguments.
bool sets_by_name(const Builtin& builtin, std::string_view name);

/// Whether child i of a call of a builtin is a variable that is set by the name in front of it.
inline bool is_named_output(const Expression& call, size_t i) {
    if (!call.builtin || i == 0 || call.children[i - 1]->kind != Expression::Kind::Text) return false;
    const Expression::Kind kind = call.children[i]->kind;
    return (kind == Expression::Kind::Variable || kind == Expression::Kind::Element) &&
           sets_by_name(*call.builtin, call.children[i - 1]->text);
}

/// All overloads of all names.
std::span<const Builtin> builtins();

/// The overloads of a name, in the order of preference; empty for an unknown name.
std::span<const Builtin> builtins_named(std::string_view name);

}  // namespace trapeze::rsl
