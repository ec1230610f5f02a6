#include "shade/weld.h"

#include <cmath>

#include "core/scene.h"

namespace trapeze {
namespace {

constexpr size_t kPieceVertices = 4;
/// Surfaces that meet at more than some twenty degrees meet in a crease, over which nothing is shaded alike.
constexpr float kCreaseCosine = 0.94f;

bool is_finite(const V3f& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// The normal at a vertex of a piece of 2x2, or 0 where its sides are parallel.
V3f normal_in_piece(const Triples& P, size_t vertex) {
    const size_t first = vertex / kPieceVertices * kPieceVertices, i = vertex & 1, j = vertex >> 1 & 1;
    const V3d along_u = V3d(P.at(first + 1 + 2 * j)) - V3d(P.at(first + 2 * j));
    const V3d along_v = V3d(P.at(first + i + 2)) - V3d(P.at(first + i));
    const V3d cross = along_u.cross(along_v);
    const double length = cross.length();
    constexpr double kParallel = 1e-5;  // sine of the angle
    if (!(length > kParallel * along_u.length() * along_v.length()) || !std::isfinite(length)) return V3f(0);
    return V3f(cross / length);
}

/// A vertex counted through all of the border's pieces.
struct InBorder {
    const ShadingGrid* pieces = nullptr;
    size_t vertex = 0;
};

InBorder find_in_border(const ShadingGrid& grid, int in_border) {
    auto vertex = static_cast<size_t>(in_border);
    for (const ShadingGrid& pieces : grid.border) {
        if (vertex < pieces.vertex_count()) return {&pieces, vertex};
        vertex -= pieces.vertex_count();
    }
    return {};
}

}  // namespace

void remember_undisplaced(ShadingGrid& pieces) {
    pieces.P.resize(2);
    pieces.P[1] = pieces.P[0];
}

void displace_pieces(const Displaced& displaced, ShadingGrid& pieces) {
    const size_t count = pieces.vertex_count();
    const auto own = [](const ConstPlane3& planes, size_t i) {
        return V3f(planes.x[i], planes.y[i], planes.z[i]);
    };
    if (displaced.P.size() != 0) {
        for (size_t i = 0; i < count; ++i)
            if (const V3f moved = own(displaced.P, i); is_finite(moved - pieces.P[0].at(i)))
                pieces.P[0].set(i, moved);
        for (size_t i = 0; i < count; ++i) {
            const V3f normal = normal_in_piece(pieces.P[0], i);
            if (normal == V3f(0)) continue;
            pieces.Ng.set(i, pieces.reverse_orientation ? -normal : normal);
            pieces.N.set(i, pieces.Ng.at(i));
        }
    }
    if (displaced.N.size() != 0)
        for (size_t i = 0; i < count; ++i) pieces.N.set(i, own(displaced.N, i));
}

BorderWeld::BorderWeld(const ShadingGrid& grid) {
    positions_.reserve(grid.P.size() * grid.shared_vertices.size());
    for (const Triples& P : grid.P)
        for (const ShadingGrid::SharedVertex& shared : grid.shared_vertices)
            positions_.push_back(P.at(static_cast<size_t>(shared.vertex)));
    for (const ShadingGrid::SharedVertex& shared : grid.shared_vertices) {
        const InBorder in = find_in_border(grid, shared.in_border);
        const float cosine = grid.Ng.at(static_cast<size_t>(shared.vertex)).dot(in.pieces->Ng.at(in.vertex));
        is_smooth_.push_back(cosine > kCreaseCosine);
    }
}

void BorderWeld::close(ShadingGrid& grid) const {
    const size_t count = grid.shared_vertices.size();
    for (size_t n = 0; n < count; ++n) {
        const InBorder in = find_in_border(grid, grid.shared_vertices[n].in_border);
        const auto vertex = static_cast<size_t>(grid.shared_vertices[n].vertex);
        const V3d moved(in.pieces->P[0].at(in.vertex) - in.pieces->P[1].at(in.vertex));
        for (size_t key = 0; key < grid.P.size(); ++key) {
            V3d move;
            key_from_first(*grid.primitive, static_cast<int>(key), grid.key_count).multDirMatrix(moved, move);
            grid.P[key].set(vertex, positions_[key * count + n] + V3f(move));
        }
        if (!is_smooth_[n]) continue;
        grid.N.set(vertex, in.pieces->N.at(in.vertex));
        grid.Ng.set(vertex, in.pieces->Ng.at(in.vertex));
    }
}

}  // namespace trapeze
