/// For tests of surfaces next to their formulas.
#pragma once

#include <gtest/gtest.h>

#include <numbers>

#include "core/math.h"

namespace trapeze::testing {

inline constexpr float kPi = std::numbers::pi_v<float>;

/// RISpec's bases.
inline const M44f kBezier(-1, 3, -3, 1, 3, -6, 3, 0, -3, 3, 0, 0, 1, 0, 0, 0);
inline const M44f kBSpline = M44f(-1, 3, -3, 1, 3, -6, 3, 0, -3, 0, 3, 0, 1, 4, 1, 0) * (1 / 6.0f);
inline const M44f kCatmullRom = M44f(-1, 3, -3, 1, 2, -5, 4, -1, -1, 0, 1, 0, 0, 2, 0, 0) * 0.5f;

inline void expect_near(const V3f& a, const V3f& b, float tolerance) {
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(a[k], b[k], tolerance);
}

}  // namespace trapeze::testing
