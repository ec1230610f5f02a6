/// The variables that the renderer gives to shaders (RISpec 3.2, tables 12.1 to 12.5).
#pragma once

#include <span>
#include <string_view>

#include "shade/rsl/syntax/type.h"

namespace trapeze::rsl {

/// A row of the tables. Not writable ones may be assigned to with a warning: the shader works on a copy.
/// Storage is that of the tables; what a variable varies over when the shader runs is infer_storage()'s to
/// find.
struct GlobalVariable {
    std::string_view name;
    Base base;
    Storage storage;
    bool writable;
};

/// The predefined variables of one kind of shader, in the order of RISpec's tables.
std::span<const GlobalVariable> global_variables(ShaderKind kind);

/// Null for a name that the renderer does not give to shaders of that kind.
const GlobalVariable* find_global(ShaderKind kind, std::string_view name);

}  // namespace trapeze::rsl
