/// A ray on its way through a tree of grids: both as the predicate reads it (axes turned so that the largest
/// component of the direction is called z) and as boxes in space see it.
#pragma once

#include <cmath>

#include "core/rays.h"

namespace trapeze {

/// Rounding of a ray near a bound, relative to the largest coordinate there. Bounds may discard only what the
/// predicate would reject, and both round. Everything that rounds between a
/// vertex and a slab test (the rotation of vertices and of the ray, quantised or interpolated bounds, the
/// predicate's a, b and edge functions, the slab's products) moves a point by at most this part of the
/// largest coordinate that enters it: 64 half-ulps, where a count of the operations gives less than 40.
inline constexpr float kTraceRounding = 0x1p-18f;

/// Depth is what hits are ordered by: along the ray's axis, growing away from the origin. For a camera ray it
/// is camera-space z.
struct TraceRay {
    AxisRay axis;                ///< what the predicate reads, in turned axes
    int planes[3] = {0, 1, 2};   ///< which coordinates of space these are
    float sign = 1;              ///< of the direction along the axis
    V3f origin, direction;       ///< in space; the point at a depth is origin + depth * direction
    float t_min = 0, t_max = 0;  ///< depths that count, inclusive
    float rounding_scale = 0;  ///< rounding of the ray near a bound: rounding_scale * its largest coordinate
    float rounding_base = 0;   ///< ... plus this

    /// The depth of a predicate's answer. Exactly z for camera rays, whose origin is at z = 0.
    float depth_of(float z) const { return (z - axis.oz) * sign; }
    /// How much bounds of things within some coordinates must grow for this ray: a length, of space and,
    /// because the direction's component along the axis is 1, of depth.
    float rounding(float largest_coordinate) const {
        return rounding_scale * largest_coordinate + rounding_base;
    }

    /// A ray through the lens: the axis is camera z, nothing is turned.
    static TraceRay camera(const AxisRay& ray, DepthRange range) {
        return turned({ray, 0, 1, 2, 1.0f}, range);
    }
    /// A ray in any direction, from axis_ray().
    static TraceRay turned(const TurnedRay& turned, DepthRange range);
};

inline TraceRay TraceRay::turned(const TurnedRay& turned, DepthRange range) {
    TraceRay r;
    const AxisRay& a = r.axis = turned.ray;
    r.planes[0] = turned.x_plane, r.planes[1] = turned.y_plane, r.planes[2] = turned.z_plane;
    r.sign = turned.depth_sign;
    r.origin[turned.x_plane] = a.ox, r.origin[turned.y_plane] = a.oy, r.origin[turned.z_plane] = a.oz;
    r.direction[turned.x_plane] = a.ux * r.sign, r.direction[turned.y_plane] = a.uy * r.sign;
    r.direction[turned.z_plane] = r.sign;
    r.t_min = range.min, r.t_max = range.max;
    // A point at depth z lies up to |u| * z beside the origin: slopes count. 2^-80 is for bounds about the
    // very origin, where all that is relative vanishes.
    r.rounding_scale = kTraceRounding * (1 + std::abs(a.ux) + std::abs(a.uy));
    r.rounding_base = r.rounding_scale * 2 * (std::abs(a.ox) + std::abs(a.oy) + std::abs(a.oz)) + 0x1p-80f;
    return r;
}

}  // namespace trapeze
