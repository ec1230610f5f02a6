#include "tessellate/normals.h"

#include "tessellate/topology/point_lanes.h"

namespace trapeze {

namespace {

/// Derivatives at a 1024th of the way from a point to the middle of its face.
void nearby_derivatives(const PlacedSurface& surface, SurfacePoint at, EvaluationScratch& scratch, V3f* dPdu,
                        V3f* dPdv) {
    constexpr float kShare = 1.0f / 1024;
    const V2f nearby = at.uv + (V2f(0.5f, 0.5f) - at.uv) * kShare;
    V3f P;
    surface.positions_and_derivatives(at.face, {&nearby, 1}, 1, scratch, {&P, 1}, {dPdu, 1}, {dPdv, 1});
}

}  // namespace

/// The derivatives are replaced too where they had no normal, so that dPdu and dPdv of the grid agree with
/// it.
V3f normal_at(const PlacedSurface& surface, SurfacePoint at, EvaluationScratch& scratch, V3f* dPdu,
              V3f* dPdv) {
    const V3f normal = unit_normal(*dPdu, *dPdv);
    if (normal != V3f(0, 0, 0)) return normal;
    nearby_derivatives(surface, at, scratch, dPdu, dPdv);
    return unit_normal(*dPdu, *dPdv);
}

}  // namespace trapeze
