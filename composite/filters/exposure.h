/// Exposure's gamma (RISpec 4.1.2): what comes after all that adds up light.
#pragma once

#include <cmath>

#include "core/portable_math.h"

namespace trapeze {

/// Raises three colours to 1 / gamma. What filters with negative lobes make negative stays so.
inline void apply_gamma(float inverse_gamma, float* rgb) {
    if (inverse_gamma == 1) return;
    for (int c = 0; c < 3; ++c) {
        const double power =
            portable::pow(std::abs(static_cast<double>(rgb[c])), static_cast<double>(inverse_gamma));
        rgb[c] = static_cast<float>(std::copysign(power, static_cast<double>(rgb[c])));
    }
}

/// 1 / gamma, and 1 for a gamma that has no inverse.
inline float inverse_of_gamma(float gamma) {
    return gamma > 0 ? 1 / gamma : 1.0f;
}

}  // namespace trapeze
