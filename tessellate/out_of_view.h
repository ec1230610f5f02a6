/// Primitives that no sample of the picture sees, found before anything is measured: a tile of a picture
/// costs little for what lies in others.
#pragma once

#include "tessellate/raster_bound.h"
#include "tessellate/topology/placed_surface.h"

namespace trapeze {

/// Whether no sample sees any part of a surface, displaced by up to `displacement_bound`: looked at face by
/// face, so that one that is seen is found at once. Where no sure bound is known, or a coordinate is
/// `farthest` or more, it may be seen.
bool is_out_of_view(const PlacedSurface& placed, const RasterBound& raster, float displacement_bound,
                    float farthest);

}  // namespace trapeze
