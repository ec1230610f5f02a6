/// The shared points of subpatches' borders: what both neighbours take, wherever they stand, and where these
/// are.
#pragma once

#include "tessellate/edges.h"
#include "tessellate/vertex_table.h"

namespace trapeze {

/// The most border points that a subpatch has, corners counted twice.
inline constexpr int kMaxBorderPoints = 4 * (kMaxGridSide + 1);

/// Positions of shared points at all keys, to P[point * key_count + key], at most kMaxBorderPoints points.
/// Runs of points on one face are evaluated together, which gives the same bits as one by one.
void border_positions(const PlacedSurface& surface, const VertexTable& vertices,
                      std::span<const BorderPoint> points, EvaluationScratch& scratch, std::span<V3f> P);

/// A subpatch's side on its edge: `count` + 1 vertices of the interval, from `first`, each `step` (1 or -1)
/// further.
struct BorderSide {
    uint32_t edge = 0;
    const EdgeInterval* interval = nullptr;
    int first = 0, step = 1, count = 0;
    /// Where the grid's vertices lie is where the edge's are, bit for bit; only its ends, which are vertices
    /// of the surface, are listed as shared points.
    bool in_place = false;

    /// The interval's vertex that is the side's vertex i.
    int vertex(int i) const { return first + step * i; }
    /// Which of the side's vertices belongs to vertex i of n + 1 of the grid's border, n >= count: all occur.
    int vertex_of_border(int i, int n) const { return (2 * i * count + n) / (2 * n); }
};

/// The vertices that a side takes of its edge. The side must lie in one interval of it.
BorderSide border_side(const Edges& edges, const SurfaceSide& side);

}  // namespace trapeze
