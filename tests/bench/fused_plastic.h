/// What a compiler to machine code could make of plastic under one distant light: all of it in one loop, with
/// values in registers. The bound that the grid machine is measured against.
#pragma once

#include "shade/vm/kernels/kernel.h"

namespace trapeze::vm {

/// Ka is 0 and the light white, along z. Operands are of three components; outputs are varying.
void fused_plastic(size_t lanes, const Operand& P, const Operand& N, const Operand& Cs, const Operand& Os,
                   const Operand& Ci, const Operand& Oi);

}  // namespace trapeze::vm
