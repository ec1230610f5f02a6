/// Where methods differ most from the reference.
#pragma once

#include <vector>

#include "pipeline/compare/comparison.h"

namespace trapeze {

/// Up to `count` squares of `side` pixels (less where the picture is smaller) that do not overlap, the worst
/// first: by the sum of squared differences to the reference, of the worst method at every pixel, at the last
/// sample rate.
std::vector<PixelRect> worst_places(const Comparison& comparison, int side, size_t count);

}  // namespace trapeze
