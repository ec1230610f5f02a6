/// What a call may look like, for built-in and for written functions alike.
#pragma once

#include <string>
#include <vector>

#include "shade/rsl/analysis/builtins.h"
#include "shade/rsl/syntax/ast.h"

namespace trapeze::rsl {

/// A function's result and parameters, in the form that the choice of overloads works with.
struct Signature {
    /// One parameter. `output`: the argument must be a place, and is set. With `any` or `any_array` the type
    /// says nothing.
    struct Parameter {
        Type type;
        bool output = false;
        bool any = false;        ///< of any type
        bool any_array = false;  ///< an array of any type
    };
    std::string_view name;
    Type result;
    std::vector<Parameter> parameters;
    size_t hidden = 0;    ///< parameters in front that nobody writes
    size_t optional = 0;  ///< parameters at the end that have default values
    /// At most one of these three is set; all are about arguments behind the parameters.
    bool more = false;      ///< further arguments are like the last
    bool pairs = false;     ///< pairs of a string and any value follow
    bool anything = false;  ///< any values follow
    const Builtin* builtin = nullptr;
    const Function* function = nullptr;
};

/// Views of the table's or the function's names: the function must live as long. One of `builtin` and
/// `function` is set, and tells afterwards what the call means.
Signature signature_of(const Builtin& builtin);
Signature signature_of(const Function& function);
/// "float pow(float, float)".
std::string print(const Signature& signature);

}  // namespace trapeze::rsl
