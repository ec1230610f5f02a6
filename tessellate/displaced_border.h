/// What displacement reads at a grid's border is shared by both neighbours, so that displaced edges stay
/// closed: normals and texture coordinates are those of the edge's own line.
#pragma once

#include "tessellate/dice.h"

namespace trapeze {

/// A border vertex of the grid and the shared point that it takes.
struct BorderVertex {
    int vertex = 0;  ///< of the grid
    int point = 0;   ///< of the subpatch's border points
    int side = 0;
    int corner = -1;  ///< the grid's corner that takes the same point; -1: none
};

/// Moves the face's own parameters of border vertices to where their shared points are on this face, so that
/// variables that both faces have alike agree.
void snap_border_parameters(const Edges& edges, const Subpatch& subpatch,
                            std::span<const BorderSide, 4> sides, std::span<const BorderPoint> points,
                            std::span<const BorderVertex> border, std::span<V2f> uv);

/// Sets N, s and t of border vertices to the shared ones; s and t only where the texture goes on over the
/// edge, not at its seams.
void share_border_shading(const DiceContext& context, std::span<const BorderSide, 4> sides,
                          std::span<const BorderPoint> points, std::span<const BorderVertex> border,
                          ShadingGrid& grid, DiceScratch::State& scratch);

}  // namespace trapeze
