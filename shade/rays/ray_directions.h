/// Where rays of a call go: directions spread over cones and hemispheres, well apart from each other,
/// different from point to point, and the same for any order of work [decision 0019].
#pragma once

#include "core/axes_around.h"
#include "core/math.h"
#include "core/ray_sequence.h"

namespace trapeze {

/// Directions about an axis, which is of unit length.
class Cone {
  public:
    /// `angle`: from the axis to the rim, in [0, pi], radians.
    Cone(const V3f& axis, float angle);

    /// All solid angles alike.
    V3f uniform(const V2f& square) const;
    /// As many as the cosine of the angle to the axis says; rims beyond a right angle count as a right angle.
    V3f by_cosine(const V2f& square) const;

    /// Two directions across the axis, at right angles.
    const V3f& across() const { return axes_.across; }
    const V3f& along() const { return axes_.along; }

  private:
    AxesAround<float> axes_;
    float least_cosine_;
};

/// How much wider each of so many rays that fill a cone grows on each unit of its way (RaySegment::spread):
/// by its share of the solid angle.
float spread_of(float angle, int samples);

}  // namespace trapeze
