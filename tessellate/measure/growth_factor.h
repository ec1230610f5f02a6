/// What grows while the shutter is open is diced for how large it becomes.
#pragma once

#include "tessellate/measure/screen_metric.h"
#include "tessellate/topology/placed_surface.h"

namespace trapeze {

/// How many times finer than its size at shutter open asks for a primitive is diced, along an edge: so that
/// its micropolygons are never more than twice as long, in the mean, as the shading rate's for having grown.
/// 1 for what does not double its size. Its own size counts, in camera space, and not how near it comes; nor
/// is anything diced finer than if it covered the picture a few times over.
float growth_factor(const PlacedSurface& surface, const Camera& camera, const ScreenMetric& metric);

}  // namespace trapeze
