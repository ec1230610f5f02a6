/// Values between two and between four others, as variables are linear over faces. They are exact at the
/// ends, the same from either end, and where ends are equal there is nothing but their value in between:
/// shaders divide by the differences of s and t, which must not be rounding.
#pragma once

namespace trapeze {

/// The value a share t of the way, 0 <= t <= 1. Steps from the nearer end, so that both ends are exact.
inline float between(float from, float to, float t) {
    const float step = to - from;
    return t < 0.5f ? from + t * step : to - (1 - t) * step;
}

/// The bilinear value at (u, v) between those at the corners (0, 0), (1, 0), (0, 1), (1, 1): along u first.
inline float between_corners(float c00, float c10, float c01, float c11, float u, float v) {
    return between(between(c00, c10, u), between(c01, c11, u), v);
}

}  // namespace trapeze
