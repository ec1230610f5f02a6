/// Unit normals from derivatives, also where these vanish.
#pragma once

#include "tessellate/topology/placed_surface.h"

namespace trapeze {

/// The unit normal of camera-space derivatives at a point; where they have none (a pole, a collapsed edge),
/// these become those next to it, moved towards the middle of its face. A function of the point alone, so
/// that all who share it agree. 0 when there is none there either.
V3f normal_at(const PlacedSurface& surface, SurfacePoint at, EvaluationScratch& scratch, V3f* dPdu,
              V3f* dPdv);

}  // namespace trapeze
