/// A Blobby's repelling plane, opcode 1003 (RISpec 5.6): a field that pushes the surface away from the ground
/// that a depth map saw, and lets it bulge just above, as a drop does that lies on a table.
#pragma once

#include <functional>

#include "core/math.h"

namespace trapeze {

/// A field's value at a point and its gradient by the point's object-space coordinates.
struct FieldValue {
    float value = 0;
    V3f gradient{0, 0, 0};
};

/// The field as a function of the height z above the ground [Pixar, PRMan Application Note 31, "Blobby
/// Implicit Surfaces"]:
///
///     (bulge * bump(z / peak) - barrier / z) (1 - ease(z / reach)),   and 0 from `reach` on
///
/// bump(r) = (r (2 - r))^3 between 0 and 2 and 0 elsewhere, ease(r) = r^2 (3 - 2 r) between 0 and 1. At and
/// below the ground z counts as 1e-6: nothing is inside there.
struct Repulsion {
    float reach = 0;    ///< the first of the request's four floats, A
    float barrier = 0;  ///< B: how hard the ground pushes
    float peak = 0;     ///< C: the height where the bulge is greatest
    float bulge = 0;    ///< D: that greatest value

    /// The profile at a height z above the ground; slope() is its derivative.
    float at(float z) const;
    float slope(float z) const;  ///< by z
};

/// The height of an object-space point above the ground; kInfinity where there is none.
using GroundHeight = std::function<float(const V3f& p)>;

/// A repulsion and the ground that it is from. Its gradient comes of differences of the height, one along
/// each axis.
struct RepellingGround {
    Repulsion repulsion;
    GroundHeight height;
    float step = 1e-3f;  ///< for the height's gradient

    /// The field at a point of object space; gradient 0 where the ground is not known all around.
    FieldValue at(const V3f& p) const;
};

}  // namespace trapeze
