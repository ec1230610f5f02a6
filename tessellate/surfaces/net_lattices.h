/// Lattices of faces that are polynomials of sixteen control points or four: all of them in lanes.
#pragma once

#include "tessellate/topology/face_lattices.h"

namespace trapeze {

/// Polynomials of a face, each in the order of operations in which single points are evaluated.
enum class NetForm {
    Corners,      ///< bilinear between the first four points, which go round: evaluate_bilinear()
    Bspline,      ///< uniform bicubic: evaluate_bspline()
    Bezier,       ///< bicubic: BezierPatch of degree 3
    BezierLines,  ///< bilinear, of points 0, 1, 4 and 5: BezierPatch of degree 1
};
inline constexpr int kNetForms = 4;

/// Control points of faces, a lane each; point (i, j), i along u, has number j * 4 + i.
struct NetLanes {
    alignas(64) FaceLattices::Point points[16];

    /// Sets a control point of a face.
    void set(int point, int face, const float* xyz) {
        for (int k = 0; k < 3; ++k) points[point][k][face] = xyz[k];
    }
};

/// Sets all points of `lattices` by nets of one form, for all lanes, those beside sides where `beside`, and
/// bounds as those of face_evaluation.h and of BezierPatch's control points. Reads lattices.runs.
void net_lattices(const NetLanes& nets, NetForm form, bool beside, FaceLattices& lattices);

}  // namespace trapeze
