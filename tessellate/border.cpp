#include "tessellate/border.h"

#include <algorithm>

namespace trapeze {

/// The surface gives each point the same bits in any batch, so that runs may be cut wherever they end.
void border_positions(const PlacedSurface& surface, const VertexTable& vertices,
                      std::span<const BorderPoint> points, EvaluationScratch& scratch, std::span<V3f> P) {
    const size_t keys = surface.key_count();
    std::array<V2f, kMaxBorderPoints> uv;
    for (size_t i = 0; i < points.size();) {
        if (points[i].is_vertex) {
            std::ranges::copy(vertices.keys_of(points[i].vertex), P.begin() + i * keys);
            ++i;
            continue;
        }
        const int face = points[i].at.face;
        // The run of points on this face that begins here: one call of the surface for all of them.
        size_t n = 0;
        while (i + n < points.size() && !points[i + n].is_vertex && points[i + n].at.face == face) {
            uv[n] = points[i + n].at.uv;
            ++n;
        }
        const std::span<V3f> run = scratch.points(2, n * keys);
        surface.positions(face, {uv.data(), n}, surface.key_count(), scratch, run);
        for (size_t k = 0; k < keys; ++k)
            for (size_t j = 0; j < n; ++j) P[(i + j) * keys + k] = run[k * n + j];
        i += n;
    }
}

/// Both ends snap to vertices of the interval, and the side takes all vertices between: a neighbour whose
/// side ends at the same parameter snaps to the same one.
BorderSide border_side(const Edges& edges, const SurfaceSide& side) {
    BorderSide border;
    border.edge = side.edge;
    border.interval = edges.interval(side.edge, side.begin, side.end);
    const int begin = border.interval->snap(side.begin), end = border.interval->snap(side.end);
    border.first = begin;
    border.step = end < begin ? -1 : 1;
    border.count = (end - begin) * border.step;
    return border;
}

}  // namespace trapeze
