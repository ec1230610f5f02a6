/// Where pictures differ most from a reference.
#pragma once

#include <span>
#include <vector>

#include "composite/image.h"

namespace trapeze {

/// Up to `count` squares of `side` pixels (less where the picture is smaller) that do not overlap, the worst
/// first: by the sum of squared differences to the reference, of the worst picture at every pixel. All have
/// the reference's window.
std::vector<PixelRect> worst_places(const Image& reference, std::span<const Image* const> pictures, int side,
                                    size_t count);

}  // namespace trapeze
