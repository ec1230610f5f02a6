/// Morton codes of points in three dimensions.
#pragma once

#include <cstdint>

namespace trapeze {

/// The lower 21 bits of a number, each three places from the next.
constexpr uint64_t spread_by_three(uint64_t x) {
    // Bits stay together in runs of 16, then of 8, 4, 2 and 1: each step moves the upper half of a run by
    // twice that half's length.
    x &= 0x1fffff;
    x = (x | x << 32) & 0x001f00000000ffffu;
    x = (x | x << 16) & 0x001f0000ff0000ffu;
    x = (x | x << 8) & 0x100f00f00f00f00fu;
    x = (x | x << 4) & 0x10c30c30c30c30c3u;
    return (x | x << 2) & 0x1249249249249249u;
}

/// Bits of x, y and z in turn, from the most significant one of x on.
constexpr uint64_t interleaved(uint64_t x, uint64_t y, uint64_t z) {
    return spread_by_three(x) << 2 | spread_by_three(y) << 1 | spread_by_three(z);
}

}  // namespace trapeze
