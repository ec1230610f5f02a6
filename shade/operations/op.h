/// The operations of the grid machine, which the built-in functions and operators of the shading language
/// become. In an Instruction the outputs stand first, then the inputs. What each does, and all that is known
/// of it, is its row in op_table.def.
#pragma once

#include <cstdint>

namespace trapeze::rsl {

enum class Op : uint8_t {
#define TRAPEZE_OP(name, operands, kernels, context, traits) name,
#include "shade/operations/op_table.def"
#undef TRAPEZE_OP
};

}  // namespace trapeze::rsl
