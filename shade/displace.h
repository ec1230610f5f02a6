/// Moves a grid by a displacement shader, at all its motion keys.
#pragma once

#include "core/scene/shading_grid.h"
#include "shade/planes/planes.h"
#include "shade/vm/registers.h"

namespace trapeze {

/// A shader's displaced positions and normals of some vertices, camera space at the first key.
struct Displaced {
    ConstPlane3 P;  ///< empty: the positions stay
    ConstPlane3 N;  ///< empty: normals are found from the moved P; set without P: a bump, which changes the
                    ///< shading alone
};

/// P and N that a shader which has run leaves for vertices first .. first + count - 1 of its run. The planes
/// stay the registers' own: they are valid until the next run.
Displaced displaced_by(const vm::Registers& registers, size_t first, size_t count);

/// The matrix from camera space at the first key to camera space at another one, for what moves with a
/// primitive's pose. Keys are the grid's, which may be finer than the primitive's.
M44d key_from_first(const Primitive& primitive, int key, int key_count);

/// `displaced` is what the shader makes of the grid at the first key. How far it moved a vertex is carried to
/// the other keys by the primitive's pose there (camera_from_object), turns with the surface where that
/// deforms, and is added to P.
/// Then N and Ng are found from the moved P, unless the shader set N; dPdu and dPdv stay those of the
/// undisplaced surface. Vertices that would move to no finite place stay.
///
/// Returns the farthest that a vertex moved, in camera space at any key.
float displace_grid(const Displaced& displaced, ShadingGrid& grid, PlanePool& pool);

/// The farthest that displace_grid() would move a vertex at the first key, camera space; 0 for what may be
/// rounding.
float longest_move(const Displaced& displaced, const ShadingGrid& grid);

}  // namespace trapeze
