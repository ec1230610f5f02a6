/// Boxes of what moves, at evenly spaced times of the shutter, linear in between: how those of one number of
/// keys are made from those of another. All are conservative within rounding, which they are grown by.
#pragma once

#include <span>

#include "core/math.h"

namespace trapeze {

/// Sets `to`, boxes at as many keys as it has, to boxes that hold those of `from` at all times. Both have 1
/// or 2^m + 1 keys. Where `to` has fewer, its boxes are larger: those between two of its keys must be in what
/// is linear between them.
void keyed_boxes(std::span<const Box3f> from, std::span<Box3f> to);

}  // namespace trapeze
