/// Rows across ribbons that follow a cubic and face the camera, several at once.
#pragma once

#include <span>

#include "tessellate/surfaces/camera_facing.h"
#include "tessellate/surfaces/curve_values.h"
#include "tessellate/topology/face_lattices.h"

namespace trapeze {

/// A ribbon across its centre line: points of the row are centre + (u - 1/2) * span. Derivatives are by the
/// segment's parameter t; the direction's own change along the curve is left out.
struct RibbonRow {
    V3f centre{0, 0, 0}, by_t{0, 0, 0}, span{0, 0, 0}, span_by_t{0, 0, 0};
};

/// Where the square of a curve's speed is not above so many times that of its chord, it has none.
inline constexpr float kLeastSpeed2 = 1e-10f;

/// Rows a call, as many as lanes of the widest vectors.
inline constexpr size_t kRowsAtOnce = 16;

/// The rows at up to kRowsAtOnce parameters of a segment: centre lines along `P`, as wide as `width`. Returns
/// those that have to be made with care instead, a bit each, the first the lowest: where the curve has no
/// speed, or runs along the ray that sees it.
uint32_t facing_rows(const BezierCurve& P, const CurvePiece& width, const CameraFacing& facing,
                     std::span<const float> t, std::span<RibbonRow* const> rows);

/// Segments of the same number of several faces: Bezier points of centre lines and widths. Where widths are
/// not cubic the first two are the ends.
struct RibbonLanes {
    alignas(64) float P[4][3][FaceLattices::kFaces], width[4][FaceLattices::kFaces];
};

/// The lattices of faces of segments[0 .. n) each; faces of which a row has to be made with care are left
/// out. Sets all but the points beside sides and bounds; lattices.there is among `faces`.
void facing_lattices(std::span<const RibbonLanes> segments, bool cubic_width, const CameraFacing& facing,
                     uint32_t faces, FaceLattices& lattices);

}  // namespace trapeze
