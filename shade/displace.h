/// Moves a grid by a displacement shader, at all its motion keys.
#pragma once

#include "core/scene/shading_grid.h"
#include "shade/planes/planes.h"
#include "shade/vm/registers.h"

namespace trapeze {

/// A shader's displaced positions and normals of some vertices.
struct Displaced {
    ConstPlane3 P;  ///< empty: the surface stays, and shades as if it did not (bumps)
    ConstPlane3 N;  ///< empty: to be found from the moved P
};

/// What a displacement shader that has run leaves of vertices first .. first + count - 1 of its run.
Displaced displaced_by(const vm::Registers& registers, size_t first, size_t count);

/// From camera space at the first key to camera space at another, of a grid's possibly finer keys, for what
/// moves with a primitive's pose.
M44d key_from_first(const Primitive& primitive, int key, int key_count);

/// `displaced` is what the shader makes of the grid at the first key. How far it moved a vertex is carried to
/// the other keys by the primitive's pose there (camera_from_object; not by its deformation) and added to P.
/// Then N and Ng are found from the moved P, unless the shader set N; dPdu and dPdv stay those of the
/// undisplaced surface. Vertices that would move to no finite place stay.
///
/// Returns the farthest that a vertex moved, in camera space at any key.
float displace_grid(const Displaced& displaced, ShadingGrid& grid, PlanePool& pool);

/// The farthest that it would move a vertex at the first key, camera space; 0 for what is rounding.
float longest_move(const Displaced& displaced, const ShadingGrid& grid);

}  // namespace trapeze
