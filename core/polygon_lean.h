/// Whether a polygon's points have derivatives by their x and y in object space.
#pragma once

#include <cmath>

#include "core/math.h"

namespace trapeze {

/// Polygons count as parallel to the z axis when their normal (object space, of any length) leans less than
/// this towards it, as a sine.
inline constexpr double kLeastPolygonLean = 1.0 / 64;

inline bool has_place_derivatives(const V3d& normal) {
    return normal.z != 0 && std::abs(normal.z) >= kLeastPolygonLean * normal.length();
}

}  // namespace trapeze
