#pragma once

#include <cmath>

#include "core/portable_math.h"

namespace trapeze {

/// Encodes a linear value by the sRGB curve (IEC 61966-2-1); 0 for what is negative or no number.
inline float srgb_encoded(float linear) {
    if (!(linear > 0)) return 0;
    if (linear <= 0.0031308f) return 12.92f * linear;
    return static_cast<float>(1.055 * portable::pow(static_cast<double>(linear), 1 / 2.4) - 0.055);
}

}  // namespace trapeze
