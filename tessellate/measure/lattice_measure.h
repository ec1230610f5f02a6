/// Lengths of the lines of several faces' lattices at once.
#pragma once

#include "tessellate/measure/line_measure.h"
#include "tessellate/topology/face_lattices.h"

namespace trapeze {

/// A line of each face: RateEstimate's numbers, a lane a face.
struct LatticeLine {
    alignas(64) float sum[FaceLattices::kFaces], longest[FaceLattices::kFaces];
    int pieces = 0;

    RateEstimate of(int face) const { return {sum[face], longest[face], pieces, false}; }
};

/// Lines along u (axis 0) and v (1), from the lowest on. Those of two pieces and of four are what a face's
/// interior is measured by, those of four and of eight its sides.
struct LatticeLines {
    LatticeLine two[2][3];   ///< of two pieces
    LatticeLine four[2][5];  ///< of four
    LatticeLine eight[2];    ///< of eight, along v at u = 0 and 1
    uint32_t measured = 0;   ///< faces that are wholly in view, a bit each; others have no lengths
};

/// The lengths that LineMeasure has of a perspective view, bit for bit.
void measure_lattices(const FaceLattices& lattices, const M44f& camera_from_object,
                      const ScreenMetric& metric, float least_foreshortening, LatticeLines& lines);

}  // namespace trapeze
