/// The working memory of bundle tracing: about 120 KB a thread.
#pragma once

#include <cstdint>
#include <vector>

#include "accel/bundle.h"

namespace trapeze {

/// Rays that may meet a grid, one after another: what the tests of its blocks read.
struct ActiveRays {
    static constexpr size_t kRoom = RayBundle::kRoom + 16;

    size_t count = 0;
    alignas(64) float ox[kRoom], oy[kRoom], ux[kRoom], uy[kRoom], local[kRoom];
    /// In the grid's frame: 1 / direction, and origin / direction.
    alignas(64) float inverse[3][kRoom], offset[3][kRoom];
    alignas(64) float limit[kRoom];  ///< no box entered beyond this depth matters; negative past the end
    alignas(64) uint32_t ray[kRoom];
};

/// Those of them that may meet a box of blocks.
struct BlockRays {
    alignas(64) float ox[ActiveRays::kRoom], oy[ActiveRays::kRoom], ux[ActiveRays::kRoom],
        uy[ActiveRays::kRoom], local[ActiveRays::kRoom];
    alignas(64) uint32_t active[ActiveRays::kRoom];  ///< index in ActiveRays
};

/// Intervals of what rays hold, one column a packet (or one for all): x and y at depth z are within
/// d * z + o * (1 - z / focal distance).
struct RayIntervals {
    static constexpr size_t kRoom = RayBundle::kRoom;  ///< packets of a single lane, at worst
    enum Row { kDxMin, kDxMax, kDyMin, kDyMax, kOxMin, kOxMax, kOyMin, kOyMax, kTimeMin, kTimeMax, kRows };

    alignas(64) float row[kRows][kRoom];
};

struct BundleScratch {
    RayIntervals intervals;
    alignas(64) float farthest[RayIntervals::kRoom];  ///< per packet, the depth to which some ray still looks
    std::vector<uint64_t> candidates;                 ///< least depth (order-preserving bits), then grid
    std::vector<uint32_t> stack;
    std::vector<uint32_t> touched;  ///< packets that have active rays
    ActiveRays active;
    static constexpr size_t kMetStride = ActiveRays::kRoom;  ///< a byte a ray at worst
    alignas(64) uint8_t met[16 * kMetStride + 64];  ///< per box, a bit for each active ray that meets it
    BlockRays block;
};

}  // namespace trapeze
