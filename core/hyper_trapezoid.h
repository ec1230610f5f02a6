/// A bound that moves: the OBB hyper-trapezoid of [Hou10 sec. 3.2], boxes of one orientation at evenly spaced
/// motion keys, linear in time between them. By the paper's Property 1 it bounds what moves linearly between
/// keys when it bounds the poses at the keys.
///
/// All operations are conservative in floats: boxes are grown by more than what their arithmetic can round
/// away (kBoundRounding of the largest coordinate).
#pragma once

#include <vector>

#include "core/math.h"
#include "core/motion_keys.h"

namespace trapeze {

/// Relative growth that covers the rounding of a rotation and of a lerp in time: 16 half-ulps.
inline constexpr float kBoundRounding = 0x1p-20f;

/// The largest |coordinate| of a box, which must not be empty: what rounding errors are relative to.
float largest_coordinate(const Box3f& box);

/// An orientation: three axes, orthonormal up to rounding. Coordinates in the axes are dot products.
struct Axes {
    V3f axis[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

    V3f from_space(const V3f& p) const { return {axis[0].dot(p), axis[1].dot(p), axis[2].dot(p)}; }
    V3f to_space(const V3f& p) const { return axis[0] * p.x + axis[1] * p.y + axis[2] * p.z; }
    bool operator==(const Axes& o) const {
        return axis[0] == o.axis[0] && axis[1] == o.axis[1] && axis[2] == o.axis[2];
    }
};

/// The axes of two main directions [Hou10 sec. 3.3]: the longer one kept, the other made orthogonal to it,
/// and their normal. Directions that vanish or are parallel leave the choice free.
Axes axes_of(const V3d& first, const V3d& second);

/// A bound of something that moves, in its own axes. time01 is 0 at shutter open, 1 at shutter close.
struct HyperTrapezoid {
    Axes axes;
    std::vector<Box3f> keys;  ///< in the axes; 1 or 2^m + 1 of them

    int key_count() const { return static_cast<int>(keys.size()); }
    /// The box at a time, in the axes: linear between the two keys around it.
    Box3f at(float time01) const;

    /// Whether a point of space is inside at a time.
    bool contains(const V3f& point, float time01) const;

    /// This bound seen from other axes and at least as many keys: a box around each box.
    HyperTrapezoid in(const Axes& other, int at_least_keys) const;

    /// Grows to hold the other too, in these axes.
    void merge(const HyperTrapezoid& other);

    /// Half the surface area, averaged over the keys: what the chance of a ray to meet it goes by.
    double expected_half_area() const;
};

/// A box grown on all sides by kBoundRounding of its largest coordinate.
Box3f grown_for_rounding(const Box3f& box);

}  // namespace trapeze
