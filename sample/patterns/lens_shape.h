/// Where on the lens a sample looks through: the unit square to the lens' opening, cells kept compact and
/// areas in proportion.
///
/// A disk is Shirley's [Shirley97]. To a polygon squares around the middle become polygons around it, each
/// side of the square an eighth of the whole on either side of its axis: linear in each triangle between the
/// middle and the rim, and as these have one area, all is stretched alike. Brightness towards the rim moves
/// points outwards, never samples' weights.
#pragma once

#include "sample/patterns/lens_outline.h"
#include "sample/patterns/strata.h"

namespace trapeze {

/// The lens as patterns see it: a unit disk, or the outline of an aperture's blades, scaled by the radius
/// later.
class LensShape {
  public:
    explicit LensShape(const Aperture& aperture) : outline_(aperture) {}

    /// A point of the unit disk for one of the unit square.
    V2f from_square(float u, float v) const;

    /// Bounds the points of region `index` (rows of nx) of the square's nx * ny, bit for bit.
    LensBox region(uint32_t index, int nx, int ny) const;

    /// Empty for a disk.
    const LensOutline& outline() const { return outline_; }

  private:
    LensOutline outline_;
};

}  // namespace trapeze
