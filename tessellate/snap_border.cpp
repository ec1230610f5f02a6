#include "tessellate/shared_border.h"

#include <algorithm>
#include <cmath>

namespace trapeze {
namespace {

/// Whether a side's edge is one point, such as a sphere's pole: its parameters mean something though
/// positions do not differ, and must not be moved together.
bool is_point(const Edges& edges, const BorderSide& side) {
    const EdgeLine line = edges.line(side.edge);
    return !line.start.on_edge && !line.finish.on_edge && line.start.id == line.finish.id &&
           side.interval->depth == 0 && side.interval->segments == 1;
}

}  // namespace

/// Three passes: vertices move along their own sides to where their shared points lie; corners that share a
/// point with other vertices pull these to them; and last, who lies within rounding of the shared point's own
/// parameters takes their bits.
void snap_border_parameters(const Edges& edges, const Subpatch& subpatch,
                            std::span<const BorderSide, 4> sides, std::span<const BorderPoint> points,
                            std::span<const BorderVertex> border, bool corners, std::span<V2f> uv) {
    const auto is_own_corner = [&](int vertex) {
        const GridShape& shape = subpatch.shape;
        return vertex == 0 || vertex == shape.nu || vertex == shape.row_index(0, shape.nv) ||
               vertex == shape.row_index(shape.nu, shape.nv);
    };
    const bool is_linear = edges.surface->is_linear(subpatch.face);
    const float last = edges.surface->last_parameter(subpatch.face);
    std::array<bool, 4> pole;
    for (int s = 0; s < 4; ++s) pole[s] = is_point(edges, sides[s]);
    int first_of_side = 0, side = -1;
    for (const BorderVertex& at : border) {
        if (at.side != side) side = at.side, first_of_side = at.point;
        const SurfaceSide& on = subpatch.sides[side];
        // A corner that lies within one of its edges and at the end of the other is moved along the former. A
        // vertex may be the end of its own edge: there parameters go as far on linear faces alone, and others
        // stay, to cover the face.
        const BorderPoint& point = points[at.point];
        const bool is_own_end = is_linear && point.is_vertex && point.hops == 1;
        const bool is_of_another = point.hops > 0 && !is_own_end;
        if (pole[side] || sides[side].in_place || on.begin == on.end || is_of_another) continue;
        const float parameter =
            sides[side].interval->parameter_of(sides[side].vertex(at.point - first_of_side));
        // The side's share that lies at the shared point, taken over to the subpatch's own rectangle.
        const float share = (parameter - on.begin) / (on.end - on.begin);
        const int axis = side == kBottom || side == kTop ? 0 : 1;
        const float own = subpatch.lo[axis] + (subpatch.hi[axis] - subpatch.lo[axis]) * share;
        uv[at.vertex][axis] = std::clamp(own, 0.0f, last);
    }
    for (const BorderVertex& at : border)
        if (at.corner >= 0 && !pole[at.side] && (corners || !is_own_corner(at.vertex)))
            uv[at.vertex] = uv[at.corner];
    // The same bits as the shared point, where that is on this very side.
    for (const BorderVertex& at : border) {
        const BorderPoint& point = points[at.point];
        const V2f size = subpatch.hi - subpatch.lo, off = point.at.uv - uv[at.vertex];
        if (!point.is_vertex && point.at.face == subpatch.face && std::abs(off.x) < size.x / 1024 &&
            std::abs(off.y) < size.y / 1024)
            uv[at.vertex] = point.at.uv;
    }
}

}  // namespace trapeze
