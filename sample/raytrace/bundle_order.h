/// The order in which rays go into bundles [decision 0009].
#pragma once

#include <cstdint>
#include <vector>

#include "core/ray_blur.h"
#include "core/samples.h"
#include "sample/raytrace/blur_map.h"

namespace trapeze {

/// How finely rays are sorted. Too fine costs as much as too coarse: bundles, and packets in them, should be
/// compact in all of pixel, lens and time.
struct BundleOrder {
    int block_side = 8;  ///< pixels; blocks one after another
    int lens_bits = 2;   ///< an axis, within a block
    int time_bits = 3;   ///< within a cell of the lens

    bool operator==(const BundleOrder&) const = default;
};

/// The order in which the fewest grids and blocks are met in vain, by a model of what groups of rays cover.
BundleOrder best_order(const BlurMoments& blur, int samples_per_pixel, RayBlur blurs);

/// What a thread needs for the sort of a tile's samples.
struct BundleOrderScratch {
    std::vector<uint32_t> keys;         ///< by sample
    std::vector<uint32_t> starts;       ///< by key: the place of its next sample
    std::vector<uint32_t> pixel_first;  ///< the first sample of each pixel, along a Z-order curve
};

/// Sets `result`, indices of samples: block by block of pixels; within by cell of the lens, then by time,
/// then by pixel along a Z-order curve. Without motion or a lens what tells them apart is left out.
void order_bundles(const SampleTile& samples, RayBlur blur, const BundleOrder& order,
                   BundleOrderScratch& scratch, std::vector<uint32_t>& result);

}  // namespace trapeze
