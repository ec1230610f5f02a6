#include "tessellate/surfaces/blobby/repelling_ground.h"

#include <algorithm>
#include <cmath>

#include "core/scene/scene.h"

namespace trapeze {
namespace {

/// The height that all points at or below the ground count as having; nearer the field would be infinite.
constexpr float kLeastHeight = 1e-6f;

/// The profile that lets a Blobby bulge above the ground: 1 at r = 1, and 0 with its slope at both ends.
float bump(float r) {
    if (!(r > 0 && r < 2)) return 0;
    const float s = r * (2 - r);
    return s * s * s;
}

float bump_slope(float r) {
    if (!(r > 0 && r < 2)) return 0;
    const float s = r * (2 - r);
    return 6 * s * s * (1 - r);
}

/// From 0 to 1 without a bend at either end; with it the field fades out at its reach.
float ease(float r) {
    r = std::clamp(r, 0.0f, 1.0f);
    return r * r * (3 - 2 * r);
}

float ease_slope(float r) {
    r = std::clamp(r, 0.0f, 1.0f);
    return 6 * r * (1 - r);
}

}  // namespace

/// The barrier grows without bound towards the ground and is held at a least height, so that sums with other
/// fields stay finite.
float Repulsion::at(float z) const {
    if (z >= reach) return 0;
    z = std::max(z, kLeastHeight);
    return (bulge * bump(z / peak) - barrier / z) * (1 - ease(z / reach));
}

float Repulsion::slope(float z) const {
    if (z >= reach || z <= kLeastHeight) return 0;
    const float held = bulge * bump(z / peak) - barrier / z;
    const float held_slope = bulge * bump_slope(z / peak) / peak + barrier / (z * z);
    return held_slope * (1 - ease(z / reach)) - held * ease_slope(z / reach) / reach;
}

/// Central differences: the ground is known by its depth map only, which has no derivatives.
FieldValue RepellingGround::at(const V3f& p) const {
    const float z = height(p);
    FieldValue f{repulsion.at(z), {0, 0, 0}};
    const float slope = repulsion.slope(z);
    if (slope == 0) return f;
    for (int k = 0; k < 3; ++k) {
        V3f before = p, after = p;
        before[k] -= step, after[k] += step;
        const float low = height(before), high = height(after);
        // At the ground's end there is no telling.
        if (low < kInfinity / 2 && high < kInfinity / 2) f.gradient[k] = slope * (high - low) / (2 * step);
    }
    return f;
}

}  // namespace trapeze
