/// A bundle of camera rays, as intervals of what their rays hold: for finding what no ray of them can meet,
/// once for all of them [decision 0005].
#pragma once

#include <span>

#include "accel/slabs.h"
#include "core/rays.h"

namespace trapeze {

/// The bounds of some camera rays. Conservative: what no ray of the bundle can hit is often found out, what
/// one can hit is never given up.
struct Beam {
    V2f origin_min, origin_max, slope_min, slope_max;  ///< x and y; origins are at z = 0
    float time_min = 0, time_max = 0;
    DepthRange range;

    /// The beam of the rays at some indices, of which there is at least one.
    Beam(std::span<const AxisRay> rays, std::span<const uint32_t> indices, DepthRange depths);

    /// Whether some ray may pass a box (coordinates of `axes`, for the beam's whole time), grown by its
    /// rounding, at a depth in the range grown by `slack` on both ends. `absolute_max`: the largest
    /// coordinate in space of what the box holds.
    bool meets(const AxesColumns& axes, const KeyBox& box, float absolute_max, float slack) const;
};

}  // namespace trapeze
