/// The vector and matrix types of the whole program: Imath's. Row vectors, as RISpec writes them: p' = p * M,
/// and a matrix named camera_from_object takes object-space points to camera space.
#pragma once

#include <Imath/ImathBox.h>
#include <Imath/ImathMatrix.h>
#include <Imath/ImathVec.h>

#include <cmath>

namespace trapeze {

using V2i = Imath::V2i;
using V2f = Imath::V2f;
using V3f = Imath::V3f;
using V3d = Imath::V3d;
using M33f = Imath::M33f;
using M44f = Imath::M44f;
using M44d = Imath::M44d;
using Box2i = Imath::Box2i;  ///< inclusive on both ends, as OpenEXR's windows
using Box2f = Imath::Box2f;
using Box3f = Imath::Box3f;

/// `v` with length 1, or 0 0 0 where it has no direction: its length is 0, infinite or no number.
inline V3f unit_or_zero(const V3f& v) {
    const float length = v.length();
    return length > 0 && std::isfinite(length) ? v / length : V3f(0, 0, 0);
}

/// The mean of three opacities or transmissions. Three equal ones are kept exactly: (1 + 1 + 1) * (1 / 3)
/// need not be 1.
inline float mean_of_channels(const V3f& value) {
    const bool gray = value.x == value.y && value.y == value.z;
    return gray ? value.x : (value.x + value.y + value.z) / 3;
}

}  // namespace trapeze
