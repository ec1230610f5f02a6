/// Floats in two bytes: the upper half of a float's bits (sign, the whole exponent, 7 bits of fraction). For
/// distances that bounds move by, which may be too large but never too small.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

namespace trapeze {

/// Exact: every bfloat16 is a float, whose lower bits are 0.
inline float from_bfloat16(uint16_t bits) {
    return std::bit_cast<float>(uint32_t{bits} << 16);
}

/// The least bfloat16 that is not below a finite value, and the greatest that is not above it. Infinities and
/// NaN must not come here.
inline uint16_t bfloat16_above(float value) {
    const auto bits = std::bit_cast<uint32_t>(value);
    // Cutting bits off goes towards zero: upwards for negative values, and for others a carry brings it up.
    return static_cast<uint16_t>((std::signbit(value) ? bits : bits + 0xffff) >> 16);
}
inline uint16_t bfloat16_below(float value) {
    return static_cast<uint16_t>(bfloat16_above(-value) ^ 0x8000);
}

}  // namespace trapeze
