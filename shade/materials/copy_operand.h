/// Values between registers of shaders and planes of floats.
#pragma once

#include <algorithm>
#include <cstring>

#include "shade/vm/machine.h"

namespace trapeze {

/// An operand whose components differ from lane to lane and lie one plane after the other.
inline vm::Operand planes_of(float* first, size_t lanes) {
    vm::Operand operand;
    operand.data = first;
    operand.lane_mask = ~size_t{0};
    operand.stride = lanes;
    return operand;
}

/// Copies `width` components; a uniform target takes the first lane of a varying source.
inline void copy_operand(const vm::Operand& from, int width, size_t lanes, const vm::Operand& to) {
    const size_t plane = to.lane_mask ? lanes : kLanes;
    for (int k = 0; k < width; ++k) {
        const float* source = from.data + static_cast<size_t>(k) * from.stride;
        float* target = to.data + static_cast<size_t>(k) * to.stride;
        if (from.lane_mask && to.lane_mask)
            std::memcpy(target, source, plane * sizeof(float));
        else
            std::fill_n(target, plane, source[0]);
    }
}

}  // namespace trapeze
