/// Whether a polygon's points have derivatives by their x and y in object space.
#pragma once

#include <cmath>

#include "core/math.h"

namespace trapeze {

/// Those whose normal (object space, of any length) leans less than this towards the z axis, as a sine, count
/// as parallel to it.
inline constexpr double kLeastPolygonLean = 1.0 / 64;

inline bool has_place_derivatives(const V3d& normal) {
    return normal.z != 0 && std::abs(normal.z) >= kLeastPolygonLean * normal.length();
}

}  // namespace trapeze
