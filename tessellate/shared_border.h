/// What a displacement shader makes of a grid's border must be the same for all grids that share it, whatever
/// the shader reads: normals, texture coordinates, derivatives, filtered textures, variables with seams. So
/// each shared point is shaded once more in surroundings of its own, which are a function of the point alone:
/// a piece of 2x2 vertices on the face that the edge (or vertex) is evaluated on, as large as the wished
/// micropolygon. Displaced edges are welded by taking what the pieces make of the point.
#pragma once

#include "tessellate/dice.h"

namespace trapeze {

/// Moves the face's own parameters of border vertices to where their shared points are on this face, so that
/// variables agree with positions, and between faces that have them alike. Grid corners may take the same
/// point, where a piece of a face is smaller than a micropolygon: then another piece reaches beyond itself,
/// which parameters can on linear faces alone (Surface::last_parameter), and unless `corners` those of
/// corners stay, to cover the face.
void snap_border_parameters(const Edges& edges, const Subpatch& subpatch,
                            std::span<const BorderSide, 4> sides, std::span<const BorderPoint> points,
                            std::span<const BorderVertex> border, bool corners, std::span<V2f> uv);

/// Sets grid.border and grid.shared_vertices, for all of the grid's border vertices: a piece for each
/// different point of `points`, sorted by face, evaluated at shutter open alone. Only displaced surfaces pay
/// for it: without displacement positions alone have to agree, and those do.
void make_shared_border(const DiceContext& context, std::span<const BorderPoint> points,
                        std::span<const BorderVertex> border, ShadingGrid& grid, DiceScratch::State& scratch);

}  // namespace trapeze
