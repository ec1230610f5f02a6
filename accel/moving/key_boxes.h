/// Boxes of what moves, at evenly spaced times of the shutter, linear in between: how those of one number of
/// keys count in those of another.
#pragma once

#include <span>

#include "accel/builders/box_sum.h"

namespace trapeze {

/// The box that is `way` of the way from one to another.
Box3f box_between(const Box3f& a, const Box3f& b, float way);

/// Adds boxes to sums at as many keys as there are of these, so that what is in `from` at any time is in them
/// then, but for rounding: they are to be grown by twice kBoundRounding. Both have 1 or 2^m + 1 keys. Where
/// `to` has fewer, its boxes are larger: those between two of its keys must be in what is linear between
/// them.
void add_at_keys(std::span<const Box3f> from, std::span<BoxSum> to);

}  // namespace trapeze
