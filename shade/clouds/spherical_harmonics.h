/// Functions of direction as nine real spherical harmonics: how large a cluster of discs looks from each
/// side.
#pragma once

#include <array>
#include <cmath>

#include "core/math.h"

namespace trapeze {

/// Coefficients of the bands 0, 1 (1 .. 3: y, z, x) and 2 (4 .. 8) [Ramamoorthi01].
using Harmonics = std::array<float, 9>;

/// The harmonics' values in a direction of unit length.
inline Harmonics harmonics_at(const V3f& d) {
    constexpr float k0 = 0.28209479f, k1 = 0.48860251f, k2 = 1.09254843f, k20 = 0.31539157f,
                    k22 = 0.54627422f;
    return {k0,
            k1 * d.y,
            k1 * d.z,
            k1 * d.x,
            k2 * d.x * d.y,
            k2 * d.y * d.z,
            k20 * (3 * d.z * d.z - 1),
            k2 * d.x * d.z,
            k22 * (d.x * d.x - d.y * d.y)};
}

/// Adds `scale` times the cosine to an axis, 0 where it is below; a zero axis: `scale` itself in all
/// directions. The cosine's bands 0 to 2 have these factors [Ramamoorthi01 eq. 8].
inline void add_cosine(Harmonics& sum, const V3f& axis, float scale) {
    constexpr float kBand0 = 3.14159265f, kBand1 = 2.09439510f, kBand2 = 0.78539816f;
    const Harmonics at = harmonics_at(axis);
    if (axis == V3f(0)) {
        sum[0] += scale / at[0];
        return;
    }
    sum[0] += scale * kBand0 * at[0];
    for (size_t i = 1; i < 4; ++i) sum[i] += scale * kBand1 * at[i];
    for (size_t i = 4; i < 9; ++i) sum[i] += scale * kBand2 * at[i];
}

/// A function's value in a direction and in the opposite one, where its odd band changes its sign.
struct BothWays {
    float there = 0, back = 0;
};
inline BothWays both_ways(const Harmonics& function, const Harmonics& at) {
    const float odd = function[1] * at[1] + function[2] * at[2] + function[3] * at[3];
    float even = function[0] * at[0];
    for (size_t i = 4; i < 9; ++i) even += function[i] * at[i];
    return {even + odd, even - odd};
}

}  // namespace trapeze
