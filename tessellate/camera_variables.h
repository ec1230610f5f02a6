/// Primitive variables that are geometry, from object space to camera space.
#pragma once

#include "core/math.h"
#include "core/scene/shading_grid.h"

namespace trapeze {

/// Transforms a variable's planes in place, by its declared type: points, vectors, normals (not normalised)
/// and homogeneous points; others stay as they are.
void to_camera_space(const M44f& camera_from_object, GridVariable& variable);

/// Transforms normals to unit ones of camera space; those of no length become the fallback's at the same
/// vertex.
void normals_to_camera_space(const M44f& camera_from_object, const Triples& fallback, Triples& normals);

}  // namespace trapeze
