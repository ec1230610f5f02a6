/// u and v of polygons, which are x and y of their points in object space (RISpec 5.1) and run along none of
/// a grid's axes.
#pragma once

#include <cstddef>

#include "core/scene/shading_grid.h"

namespace trapeze {

/// Whether the grid's u and v are x and y in object space: it is of a polygon mesh.
bool has_places_as_parameters(const ShadingGrid& grid);

/// How far the face's own parameters, which dPdu and dPdv are by, go from vertex to vertex along the axes of
/// a piece's grid. Only where x and y do not tell a piece's points apart (a polygon parallel to the z axis,
/// or nearly so); else 0. `piece` counts pieces of the grid's shape.
V2f steps_of_face(const ShadingGrid& grid, size_t piece);

}  // namespace trapeze
