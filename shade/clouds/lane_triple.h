/// A triple of a lane, of the operands of a call.
#pragma once

#include "shade/vm/machine.h"

namespace trapeze {

inline V3f lane_triple(const vm::Operand& operand, size_t lane) {
    return {vm::Run::at(operand, 0, lane), vm::Run::at(operand, 1, lane), vm::Run::at(operand, 2, lane)};
}

}  // namespace trapeze
