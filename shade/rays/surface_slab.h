/// How near to where a ray begins the surface that it leaves may be in its way [decision 0034].
///
/// Micropolygons that rays meet have their vertices on the limit surface, as the camera's have, but others:
/// between them they pass beside it. All of them, near a vertex of a grid, lie within a slab along its
/// tangent plane, whose half thickness follows from how the surface bends and from how positions round. A ray
/// has left the surface where it has left the slab; behind that it is something else that it meets.
#pragma once

#include "core/math.h"
#include "core/scene/ray_scene.h"
#include "core/scene/shading_grid.h"

namespace trapeze {

/// How far what rays meet of a grid's surface lies from the tangent planes of the grid's vertices, as far as
/// bending makes it, in camera space.
struct SurfaceBend {
    float most = kInfinity;  ///< infinite where it is not known
    /// Where it bends towards its outside, and towards its inside: there rays along it come back to it.
    float outwards = 0, inwards = 0;

    /// Towards the side of the surface on which a direction is.
    float towards(const V3f& direction, const V3f& outside) const {
        return direction.dot(outside) < 0 ? inwards : outwards;
    }
};

/// `pixels`: sides of the micropolygons that rays meet, in pixels (RayScene::spacing).
SurfaceBend bend_of(const ShadingGrid& grid, const RayScene& scene, float pixels);

/// How far positions near a vertex of a grid may be rounded.
float rounding_at(const ShadingGrid& grid, size_t vertex);

/// From a vertex on some of the sides of a grid (ShadingGrid::kFirstU ...) into the grid along its tangent
/// plane, by some thicknesses of its slab (LeftSurface::half), but a part of a side at most; else 0. On the
/// edge between two faces a point lies in both of their planes: what it asks is asked for its own face, from
/// where the other one is seen.
V3f inwards_at(const ShadingGrid& grid, size_t vertex, float half, uint8_t sides);

/// Whether a vertex on some of the sides of a grid has not as much room as inwards_at() wants: what is near
/// of another face would be hidden by the slab.
bool is_cramped_at(const ShadingGrid& grid, size_t vertex, float half, uint8_t sides);

}  // namespace trapeze
