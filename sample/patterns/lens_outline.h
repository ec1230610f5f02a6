/// The rim of a lens of blades, as a polygon of the triangles between it and the middle: all of one area, so
/// that equal parts of the rim stand for equal parts of the lens.
#pragma once

#include <cstddef>
#include <vector>

#include "core/scene/aperture.h"

namespace trapeze {

/// Below this divisors are it: where a lens is dark in the middle, at the middle.
inline constexpr float kLeastDivisor = 1e-30f;

/// Counterclockwise, in the unit disk. Sides that bow are chains of chords, 256 or more in all, less than
/// .0005 of the lens' radius from the arcs.
struct LensOutline {
    std::vector<float> x, y;    ///< corners
    std::vector<float> dx, dy;  ///< from each corner to the next, the last to the first
    float density = 0;          ///< Aperture's

    /// Empty for a disk.
    explicit LensOutline(const Aperture& aperture);
    /// Corners; 0 for a disk.
    size_t size() const { return x.size(); }
};

}  // namespace trapeze
