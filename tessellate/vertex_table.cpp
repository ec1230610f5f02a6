#include "tessellate/vertex_table.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tessellate/topology/order_by_face.h"

namespace trapeze {
namespace {

/// The lattice's point at a corner of the face; -1: a place that is none.
int corner_point(const V2f& uv) {
    constexpr int kLast = FaceLattices::kLines - 1;
    if ((uv.x != 0 && uv.x != 1) || (uv.y != 0 && uv.y != 1)) return -1;
    return FaceLattices::inner(uv.y == 0 ? 0 : kLast, uv.x == 0 ? 0 : kLast);
}

}  // namespace

VertexTable::VertexTable(const PlacedSurface& surface) {
    *this = VertexTableMaker(surface).finish();
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

/// Vertices are evaluated in the order of faces, since surfaces keep the face evaluated last.
VertexTableMaker::VertexTableMaker(const PlacedSurface& placed)
    : surface_(placed), points_(placed.surface().vertex_count()) {
    const Surface& surface = placed.surface();
    const int face_count = surface.face_count();
    std::vector<int> faces(points_.size());
    first_.assign(static_cast<size_t>(face_count) + 1, 0);
    for (uint32_t v = 0; v < points_.size(); ++v) {
        points_[v] = surface.vertex(v), faces[v] = points_[v].face;
        ++first_[faces[v] + 1];
    }
    for (int face = 0; face < face_count; ++face) first_[face + 1] += first_[face];
    order_ = order_by_face(faces, face_count);
    known_.assign(order_.size(), 0);
    table_.key_count_ = static_cast<size_t>(placed.key_count());
    table_.positions_.resize(points_.size() * table_.key_count_);
}

/// The same bits as by evaluation: the lattice's points are, and transform_points() does as
/// transform_point().
void VertexTableMaker::take(int first_face, const FaceLattices& lattices) {
    const int end = std::min(first_face + FaceLattices::kFaces, surface_.surface().face_count());
    for (int face = first_face; face < end; ++face) {
        const int lane = face - first_face;
        if (!(lattices.there >> lane & 1)) continue;
        for (uint32_t place = first_[face]; place < first_[face + 1]; ++place) {
            const uint32_t vertex = order_[place];
            const int number = corner_point(points_[vertex].uv);
            if (number < 0) continue;
            const FaceLattices::Point& at = lattices.points[number];
            const V3f object(at[0][lane], at[1][lane], at[2][lane]);
            for (size_t key = 0; key < table_.key_count_; ++key)
                table_.positions_[vertex * table_.key_count_ + key] =
                    transform_point(surface_.camera_from_object(static_cast<int>(key)), object);
            known_[place] = 1;
        }
    }
}

/// Threads write to places of their own, by the vertex' number: the table is the same for any number of them.
VertexTable VertexTableMaker::finish() {
    const size_t keys = table_.key_count_;
    tbb::parallel_for(tbb::blocked_range<size_t>(0, order_.size(), 1024), [&](const auto& range) {
        EvaluationScratch scratch;
        std::vector<V2f> uv;
        for (size_t first = range.begin(), end = first; first < range.end(); first = end) {
            if (known_[first]) {
                end = first + 1;
                continue;
            }
            // The run of vertices on one face: one call of the surface for all of them.
            const int face = points_[order_[first]].face;
            uv.clear();
            for (; end < range.end() && points_[order_[end]].face == face && !known_[end]; ++end)
                uv.push_back(points_[order_[end]].uv);
            const std::span<V3f> P = scratch.points(2, uv.size() * keys);
            surface_.positions(face, uv, static_cast<int>(keys), scratch, P);
            for (size_t key = 0; key < keys; ++key)
                for (size_t i = 0; i < uv.size(); ++i)
                    table_.positions_[order_[first + i] * keys + key] = P[key * uv.size() + i];
        }
    });
    return std::move(table_);
}

}  // namespace trapeze
