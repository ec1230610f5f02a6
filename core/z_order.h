/// The Z-order curve over rectangles of pixels: what follows each other on it lies near each other.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

#include "core/pixel_rect.h"

namespace trapeze {

/// Bits 0, 2, 4 ... of a code, together.
constexpr int even_bits(uint32_t code) {
    uint32_t value = 0;
    for (int bit = 0; bit < 16; ++bit) value |= (code >> (2 * bit) & 1) << bit;
    return static_cast<int>(value);
}

/// Calls visit(x, y) for each pixel of a rectangle of any size, along the curve over the smallest square of a
/// power of two that holds it.
template <class Visit>
void for_each_in_z_order(const PixelRect& r, const Visit& visit) {
    const uint32_t side = std::bit_ceil(static_cast<uint32_t>(std::max({r.width(), r.height(), 1})));
    for (uint64_t code = 0; code < uint64_t{side} * side; ++code) {
        const int x = r.x0 + even_bits(static_cast<uint32_t>(code));
        const int y = r.y0 + even_bits(static_cast<uint32_t>(code >> 1));
        if (x < r.x1 && y < r.y1) visit(x, y);
    }
}

}  // namespace trapeze
