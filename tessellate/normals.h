/// Unit normals from derivatives, also where these vanish.
#pragma once

#include "tessellate/placed_surface.h"

namespace trapeze {

/// dPdu x dPdv, unit length, or 0 when they are parallel, 0 or not finite.
V3f unit_normal(const V3f& dPdu, const V3f& dPdv);

/// Camera-space derivatives at a point next to one where they have no normal (a pole, a collapsed edge):
/// moved towards the middle of its face. A function of the point alone, so that all who share it agree.
void nearby_derivatives(const PlacedSurface& surface, SurfacePoint at, EvaluationScratch& scratch, V3f* dPdu,
                        V3f* dPdv);

}  // namespace trapeze
