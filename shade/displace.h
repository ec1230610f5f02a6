/// Moves a grid by a displacement shader, at all its motion keys.
#pragma once

#include "core/shading_grid.h"
#include "shade/planes.h"

namespace trapeze {

/// A shader's displaced positions, and normals, in lanes: those of the grid first.
struct Displaced {
    ConstPlane3 P;
    ConstPlane3 N;  ///< empty: to be found from the moved P
};

/// `displaced` is what the shader makes of the grid at the first key. How far it moved a vertex is carried to
/// the other keys by the primitive's pose there (camera_from_object; not by its deformation) and added to P,
/// so that vertices which grids share stay shared at every key. Then N and Ng are found from the moved P,
/// unless the shader set N; dPdu and dPdv stay those of the undisplaced surface. Vertices that would move to
/// no finite place stay.
///
/// Returns the farthest that a vertex moved, in camera space at any key.
float displace_grid(const Displaced& displaced, ShadingGrid& grid, PlanePool& pool);

}  // namespace trapeze
