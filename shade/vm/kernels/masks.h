/// Lane masks, as the machine's control flow uses them: planes where all bits of a lane are set, or none.
/// An operand with lane_mask 0 serves as input only; outputs have all lanes.
#pragma once

#include <cstddef>

#include "shade/vm/kernels/kernel.h"

namespace trapeze::vm {

void fill_mask(size_t lanes, bool value, const Operand& out);
void mask_and(size_t lanes, const Operand& a, const Operand& b, const Operand& out);
void mask_or(size_t lanes, const Operand& a, const Operand& b, const Operand& out);
/// out = a and not b.
void mask_and_not(size_t lanes, const Operand& a, const Operand& b, const Operand& out);
void mask_not(size_t lanes, const Operand& a, const Operand& out);

bool any_lane(size_t lanes, const Operand& mask);
bool all_lanes(size_t lanes, const Operand& mask);
/// Of the first `lanes`, which need not be a multiple of kLanes.
size_t count_lanes(size_t lanes, const Operand& mask);

/// to = mask ? from : to, for each of `width` components (1, 3 or 16).
void masked_move(size_t lanes, int width, const Operand& mask, const Operand& from, const Operand& to);

}  // namespace trapeze::vm
