/// Lengths of the lines of several faces' lattices at once.
#pragma once

#include <span>

#include "tessellate/measure/line_measure.h"
#include "tessellate/topology/face_lattices.h"

namespace trapeze {

/// A line of each face: RateEstimate's numbers, a lane a face.
struct LatticeLine {
    alignas(64) float sum[FaceLattices::kFaces], longest[FaceLattices::kFaces];
    int pieces = 0;
    uint32_t deep = 0;  ///< a bit a face

    RateEstimate of(int face) const { return {sum[face], longest[face], pieces, (deep >> face & 1) != 0}; }
};

/// What lines of faces count without trust in foreshortening, or with it.
struct LatticeLengths {
    LatticeLine four[2]
                    [FaceLattices::kLines];  ///< along u (axis 0) and v (1) in four pieces, from the lowest
    LatticeLine side_four[4];                ///< edges by SideName, as they run, in four pieces
    LatticeLine side_eight[4];               ///< in eight pieces: of faces where side_four wants more
};

/// Lines that measure a face's interior and its sides.
struct LatticeLines {
    LatticeLine two[2][3];   ///< inner lines in two pieces
    LatticeLengths lengths;  ///< as LineMeasure::of() has them
    LatticeLengths seen;     ///< as foreshortened() has them; of faces where `lengths` may want less
    /// Faces that are there, wholly in view, and have no lengths so small that they are computed otherwise; a
    /// bit each. Others have no lengths.
    uint32_t measured = 0;
};

/// What a LineMeasure knows; see there.
struct LatticeMeasure {
    const ScreenMetric& metric;
    float least_foreshortening;
    bool trusts_foreshortening;
    float pixels_per_segment;
    float flatness;  ///< pixels
    float lens_radius;
};

/// Faces at one key, and camera space from their object space then.
struct PlacedLattices {
    const FaceLattices* lattices = nullptr;
    M44f camera_from_object;
};

/// The lengths that LineMeasure has of a perspective view, bit for bit. `keys`: one, or where foreshortening
/// is trusted those at which LineMeasure looks, with points beside sides.
void measure_lattices(std::span<const PlacedLattices> keys, const LatticeMeasure& measure,
                      LatticeLines& lines);

}  // namespace trapeze
