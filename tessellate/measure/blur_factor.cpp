#include "tessellate/measure/blur_factor.h"

#include <algorithm>

#include "tessellate/measure/some_faces.h"

namespace trapeze {
namespace {

/// Pixels of blur that double the shading rate.
constexpr float kPixelsOfBlur = 16;

/// Pixels that a point is blurred over: along its way through all keys, and across its circle of confusion at
/// the first; each times its factor, the larger one counts. `keys`: its camera-space positions.
float blur_of(std::span<const V3f> keys, const Attributes& attributes, const Camera& camera,
              const ScreenMetric& metric) {
    float moved = 0;
    for (size_t key = 1; key < keys.size(); ++key) moved += metric.length(keys[key - 1], keys[key]);
    const V2f half_width = camera.circle_of_confusion(keys.front().z);
    const float defocused = camera.has_lens() ? 2 * std::min(half_width.x, half_width.y) : 0;
    return std::max(attributes.motion_factor * moved, attributes.focus_factor * defocused);
}

}  // namespace

/// Some faces, their corners and their middles stand for all: a factor is a wish and no bound.
float blur_factor(const PlacedSurface& surface, const Camera& camera, const ScreenMetric& metric) {
    const Attributes& attributes = *surface.primitive().attributes;
    const int faces = surface.surface().face_count(), keys = surface.key_count();
    if ((attributes.motion_factor <= 0 && attributes.focus_factor <= 0) || faces == 0) return 1;
    constexpr std::array<V2f, 5> kPlaces{V2f(0, 0), V2f(1, 0), V2f(0, 1), V2f(1, 1), V2f(0.5f, 0.5f)};
    EvaluationScratch scratch;
    std::vector<V3f> P(kPlaces.size() * keys), point(keys);
    float least = kInfinity;
    for_some_faces(faces, [&](int face) {
        surface.positions(face, kPlaces, keys, scratch, P);
        for (size_t i = 0; i < kPlaces.size(); ++i) {
            for (int key = 0; key < keys; ++key) point[key] = P[key * kPlaces.size() + i];
            least = std::min(least, blur_of(point, attributes, camera, metric));
        }
    });
    return 1 + (least > 0 ? least / kPixelsOfBlur : 0);  // 1 for NaN
}

}  // namespace trapeze
