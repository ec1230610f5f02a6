#include "tessellate/normals.h"

#include <cmath>

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

V3f unit_normal(const V3f& dPdu, const V3f& dPdv) {
    // Scaled first: derivatives of tiny faces have squares that underflow.
    const auto scale = [](const V3f& v) {
        const float largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
        return largest > 0 && std::isfinite(largest) ? 1 / largest : 0.0f;
    };
    const V3f u = dPdu * scale(dPdu), v = dPdv * scale(dPdv);
    const V3f n = u.cross(v);
    const float length = std::sqrt(n.dot(n));
    constexpr float kParallel = 1e-5f;  // below, the cross product is mostly rounding
    return length > kParallel ? n / length : V3f(0, 0, 0);
}

V3f normal_at(const PlacedSurface& surface, SurfacePoint at, EvaluationScratch& scratch, V3f* dPdu,
              V3f* dPdv) {
    const V3f normal = unit_normal(*dPdu, *dPdv);
    if (normal != V3f(0, 0, 0)) return normal;
    nearby_derivatives(surface, at, scratch, dPdu, dPdv);
    return unit_normal(*dPdu, *dPdv);
}

}  // namespace trapeze
