/// What is done to all points of a grid alike, in vectors of the machine.
#pragma once

#include <span>

#include "core/scene/shading_grid.h"

namespace trapeze {

/// transform_point() of each, the same bits; `out` has room for as many. They may be the same.
void transform_points(const M44f& m, std::span<const V3f> in, V3f* out);
/// transform_vector() of each, in place.
void transform_vectors(const M44f& m, std::span<V3f> vectors);
/// Each times `scale`, to planes that have room.
void to_planes(std::span<const V3f> vectors, float scale, Triples& planes);
/// dPdu x dPdv, unit length, or 0 when they are parallel, 0 or not finite.
V3f unit_normal(const V3f& dPdu, const V3f& dPdv);
/// unit_normal() of each, the same bits, to planes that have room.
void unit_normals(std::span<const V3f> dPdu, std::span<const V3f> dPdv, Triples& normals);

}  // namespace trapeze
