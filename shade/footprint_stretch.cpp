#include "shade/footprint_stretch.h"

#include <algorithm>
#include <cmath>

namespace trapeze {
namespace {

/// A symmetric matrix, 2 x 2, by its parts; `determinant` is given where it is known better than from them.
/// Returns that with the same axes whose eigenvalues are of() its own.
template <class Of>
Stretch map_axes(float uu, float uv, float vv, float determinant, const Of& of) {
    const float middle = (uu + vv) / 2, apart = std::sqrt((uu - vv) * (uu - vv) / 4 + uv * uv);
    const float longer = middle + apart, shorter = determinant / std::max(longer, 1e-30f);
    const float of_longer = of(longer), of_shorter = of(shorter);
    const float more = apart > 0 ? (of_longer - of_shorter) / (2 * apart) : 0;
    return {of_shorter + more * (uu - shorter), more * uv, of_shorter + more * (vv - shorter)};
}

float area_of(const V2f& u, const V2f& v) {
    return u.x * v.y - u.y * v.x;
}

}  // namespace

bool Stretch::is_finite() const {
    return std::isfinite(uu + uv + vv);
}

/// The ellipse's axes are the singular values of the matrix (u v), roots of the eigenvalues of its square;
/// the stretch multiplies each by what it lacks.
Stretch stretch_to_least(const V2f& u, const V2f& v, float least) {
    const float area = area_of(u, v);
    return map_axes(u.dot(u), u.dot(v), v.dot(v), area * area, [least](float square) {
        return std::clamp(least / std::sqrt(std::max(square, 1e-30f)), 1.0f, kMostStretch);
    });
}

/// With M = (u v) and G the square of (a b), of which no eigenvalue is less than that of `least`: the root of
/// M^-1 G M^-T, since M times it spans the same ellipse as (a b).
Stretch stretch_to_ellipse(const V2f& u, const V2f& v, const V2f& a, const V2f& b, float least,
                           bool shrinks) {
    const float across = area_of(a, b);
    const Stretch wide =
        map_axes(a.x * a.x + b.x * b.x, a.x * a.y + b.x * b.y, a.y * a.y + b.y * b.y, across * across,
                 [least](float square) { return std::max(std::sqrt(std::max(square, 0.0f)), least); });
    // M^-1 W, W = `wide` being a symmetric root of G.
    const float area = area_of(u, v);
    const V2f x(wide.uu, wide.uv), y(wide.uv, wide.vv);
    const V2f by_x(area_of(x, v) / area, area_of(u, x) / area),
        by_y(area_of(y, v) / area, area_of(u, y) / area);
    const float determinant = area_of(by_x, by_y);
    return map_axes(by_x.x * by_x.x + by_y.x * by_y.x, by_x.x * by_x.y + by_y.x * by_y.y,
                    by_x.y * by_x.y + by_y.y * by_y.y, determinant * determinant, [shrinks](float square) {
                        return std::clamp(std::sqrt(std::max(square, 0.0f)),
                                          shrinks ? 1 / kMostStretch : 1.0f, kMostStretch);
                    });
}

}  // namespace trapeze
