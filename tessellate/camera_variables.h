/// Primitive variables that are geometry, from object space to camera space.
#pragma once

#include "core/math.h"
#include "core/scene/shading_grid.h"

namespace trapeze {

/// Points, vectors, normals and homogeneous points; others stay as they are.
void to_camera_space(const M44f& camera_from_object, GridVariable& variable);

/// Unit normals; those of no length become the fallback's.
void normals_to_camera_space(const M44f& camera_from_object, const Triples& fallback, Triples& normals);

}  // namespace trapeze
