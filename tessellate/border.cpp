#include "tessellate/border.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tessellate/topology/order_by_face.h"

namespace trapeze {

/// Threads write to places of their own, by the vertex' number: the table is the same for any number of them.
VertexTable::VertexTable(const PlacedSurface& surface) : key_count_(surface.key_count()) {
    // Vertices are evaluated in the order of faces, since surfaces keep the face evaluated last.
    std::vector<SurfacePoint> points(surface.surface().vertex_count());
    std::vector<int> faces(points.size());
    for (uint32_t v = 0; v < points.size(); ++v)
        points[v] = surface.surface().vertex(v), faces[v] = points[v].face;
    const std::vector<uint32_t> order = order_by_face(faces, surface.surface().face_count());
    positions_.resize(points.size() * key_count_);
    tbb::parallel_for(tbb::blocked_range<size_t>(0, order.size(), 1024), [&](const auto& range) {
        EvaluationScratch scratch;
        std::vector<V2f> uv;
        for (size_t first = range.begin(), end = first; first < range.end(); first = end) {
            // The run of vertices on one face: one call of the surface for all of them.
            const int face = points[order[first]].face;
            uv.clear();
            for (; end < range.end() && points[order[end]].face == face; ++end)
                uv.push_back(points[order[end]].uv);
            const std::span<V3f> P = scratch.points(2, uv.size() * key_count_);
            surface.positions(face, uv, surface.key_count(), scratch, P);
            for (size_t key = 0; key < key_count_; ++key)
                for (size_t i = 0; i < uv.size(); ++i)
                    positions_[order[first + i] * key_count_ + key] = P[key * uv.size() + i];
        }
    });
}

/// NaN fails every comparison, and so comes to the branch where it counts as infinite.
float VertexTable::reach() const {
    float reach = 0;
    for (const V3f& p : positions_)
        for (int k = 0; k < 3; ++k)
            if (!(std::abs(p[k]) <= reach))
                reach = std::isfinite(p[k]) ? std::abs(p[k]) : std::numeric_limits<float>::infinity();
    return reach;
}

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
