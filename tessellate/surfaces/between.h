/// Values between two and between four others, as variables are linear over faces. They are exact at the
/// ends, the same from either end, and where ends are equal there is nothing but their value in between:
/// shaders divide by the differences of s and t, which must not be rounding.
#pragma once

namespace trapeze {

inline float between(float from, float to, float t) {
    const float step = to - from;
    return t < 0.5f ? from + t * step : to - (1 - t) * step;
}

/// Of the corners (0, 0), (1, 0), (0, 1), (1, 1).
inline float between_corners(float c00, float c10, float c01, float c11, float u, float v) {
    return between(between(c00, c10, u), between(c01, c11, u), v);
}

}  // namespace trapeze
