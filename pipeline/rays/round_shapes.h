/// The round bodies that particles and hairs stand for, as area lights: the camera sees a disk or a ribbon
/// that turns to it, and so does each point that they shine on [decision 0030].
#pragma once

#include "core/scene/light_shape.h"
#include "core/scene/scene.h"
#include "core/scene/shading_grid.h"

namespace trapeze {

/// Points, but for those that are pictures.
bool are_balls(const Primitive& primitive);
/// Curves without normals of their own.
bool are_tubes(const Primitive& primitive);

/// Adds a ball for each point, where it is at a time of the shutter; as large as at shutter open.
void add_balls(const Primitive& points, float time, LightMesh& mesh);
/// Adds the tubes about a grid of a ribbon, one a row of micropolygons, where they are at a time and as thick
/// as at shutter open; of grids that share the ribbon's width the first one does.
void add_tubes(const ShadingGrid& ribbon, float time, LightMesh& mesh);

}  // namespace trapeze
