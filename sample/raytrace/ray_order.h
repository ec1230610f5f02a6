/// The order in which a tile's rays are traced, so that neighbours take like ways through the tree.
#pragma once

#include <cstdint>
#include <vector>

#include "core/ray_blur.h"
#include "core/samples.h"

namespace trapeze {

/// The order, and what a thread needs for the sort that makes it.
struct RayOrder {
    std::vector<uint32_t> order;         ///< indices of samples
    std::vector<uint32_t> keys, sorted;  ///< keys by sample; the sort's other array
};

/// Sets result.order [Hou10 sec. 3.4]: pixels along a Z-order curve and a pixel's samples one after another;
/// then, with motion, a stable sort by time in 4 bits; then, with a lens, a stable sort by x and y of the
/// direction in 4 bits each, across the tile's range.
void order_rays(const SampleTile& samples, RayBlur blur, RayOrder& result);

}  // namespace trapeze
