/// Rays of samples. Camera space: x right, y up, z into the picture.
#pragma once

#include <cmath>
#include <limits>

#include "core/math.h"

namespace trapeze {

/// A ray that advances along one axis of space, parametrised by that axis: origin (ox, oy, oz), direction
/// (ux, uy, 1). For a camera ray the axis is camera z and oz is 0, so that a depth along the ray is
/// camera-space z. Other rays take the axis along which their direction is largest (see axis_ray) and read
/// the coordinate planes in turn.
struct AxisRay {
    float ox = 0, oy = 0, oz = 0;
    float ux = 0, uy = 0;
    float time = 0;  ///< 0 at shutter open, 1 at shutter close
};

/// The part of a ray that counts: depths in [min, max] along its axis.
struct DepthRange {
    float min = 0;
    float max = std::numeric_limits<float>::infinity();
};
inline constexpr DepthRange kAllDepths{-std::numeric_limits<float>::infinity()};

/// A ray of any direction, for what is not seen through the lens.
struct SpaceRay {
    V3f origin, direction;
    float time = 0;
};

/// A SpaceRay turned so that its main axis is called z: coordinate planes are read in the order x_plane,
/// y_plane, z_plane. Depth grows along the direction where it is positive along the axis, else it falls
/// (depth_sign is -1).
struct TurnedRay {
    AxisRay ray;
    int x_plane = 0, y_plane = 1, z_plane = 2;
    float depth_sign = 1;
};

/// Turns a ray so that the largest component of its direction is called z; of equal ones z before y before x.
/// The direction need not be of unit length; one without length gives slopes that are no numbers, and no
/// hits.
inline TurnedRay axis_ray(const SpaceRay& ray) {
    const V3f& d = ray.direction;
    const float ax = std::abs(d.x), ay = std::abs(d.y), az = std::abs(d.z);
    const int z = az >= ax && az >= ay ? 2 : (ay >= ax ? 1 : 0);
    const int x = (z + 1) % 3, y = (z + 2) % 3;
    TurnedRay turned;
    turned.x_plane = x, turned.y_plane = y, turned.z_plane = z;
    turned.depth_sign = d[z] < 0 ? -1.0f : 1.0f;
    turned.ray = {ray.origin[x], ray.origin[y], ray.origin[z], d[x] / d[z], d[y] / d[z], ray.time};
    return turned;
}

}  // namespace trapeze
