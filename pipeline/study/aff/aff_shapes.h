/// Round shapes of AFF files as triangles: few ones, always as many.
#pragma once

#include <array>
#include <vector>

#include "core/math.h"

namespace trapeze {

using AffTriangle = std::array<V3f, 3>;

constexpr int kAffSphereTriangles =
    48;  ///< 8 around an axis along y, 4 from pole to pole, less what poles lack
constexpr int kAffConeTriangles = 24;  ///< 12 strips of two

/// Corners are on the sphere.
std::vector<AffTriangle> sphere_triangles(const V3d& center, double radius);
/// Without its ends. Corners are on the circles about base and apex, which are two places. Where a radius is
/// 0, half of the triangles have no area.
std::vector<AffTriangle> cone_triangles(const V3d& base, double base_radius, const V3d& apex,
                                        double apex_radius);

}  // namespace trapeze
