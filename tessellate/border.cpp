#include "tessellate/border.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace trapeze {

VertexTable::VertexTable(const PlacedSurface& surface) : key_count_(surface.key_count()) {
    // Vertices are evaluated in the order of faces, since surfaces keep the face evaluated last.
    std::vector<SurfacePoint> points(surface.surface().vertex_count());
    for (uint32_t v = 0; v < points.size(); ++v) points[v] = surface.surface().vertex(v);
    std::vector<uint32_t> order(points.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(),
                     [&](uint32_t a, uint32_t b) { return points[a].face < points[b].face; });
    positions_.resize(points.size() * key_count_);
    tbb::parallel_for(tbb::blocked_range<size_t>(0, order.size(), 1024), [&](const auto& range) {
        EvaluationScratch scratch;
        for (size_t i = range.begin(); i < range.end(); ++i) {
            const uint32_t v = order[i];
            surface.positions(points[v].face, {&points[v].uv, 1}, surface.key_count(), scratch,
                              {positions_.data() + v * key_count_, key_count_});
        }
    });
}

float VertexTable::reach() const {
    float reach = 0;
    for (const V3f& p : positions_)
        for (int k = 0; k < 3; ++k)
            if (!(std::abs(p[k]) <= reach))
                reach = std::isfinite(p[k]) ? std::abs(p[k]) : std::numeric_limits<float>::infinity();
    return reach;
}

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
