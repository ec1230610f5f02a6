#include "shade/weld.h"

#include "core/scene/scene.h"

namespace trapeze {
namespace {

/// Two normals whose cosine is below this (an angle of about twenty degrees) meet in a crease, over which
/// nothing is shaded alike.
constexpr float kCreaseCosine = 0.94f;

/// A vertex of a grid's border: the pieces that have it, and its number in them. Border vertices are counted
/// through all pieces.
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
        const V3d moved(in.pieces->P[0].at(in.vertex) - positions_[n]);
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
