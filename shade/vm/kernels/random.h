/// Op::Random's numbers, which depend on nothing but the words they are made from.
#pragma once

#include <cstddef>
#include <cstdint>

#include "shade/vm/kernels/kernel.h"

namespace trapeze::vm {

/// Fills `width` components (1 or 3) with numbers in [0, 1). `lane_seeds` holds a 32-bit word for each lane
/// (as a float's bits: a hash of the grid and the vertex, say); `call` tells one use from another.
void random_numbers(size_t lanes, int width, const Operand& lane_seeds, uint32_t call, const Operand& out);

}  // namespace trapeze::vm
