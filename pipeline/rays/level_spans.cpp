#include "pipeline/rays/level_spans.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace trapeze {
namespace {

/// A ray is as wide as so many micropolygons' sides where it comes to a level.
constexpr float kSidesOfWidth = 2;
/// How far a surface may lie from itself on the next finer level, along a ray; in wished sides. Needles have
/// sides of nearly twice what is wished, and a curved surface that a ray grazes leaves its chord for half a
/// side.
constexpr float kOverlap = 4;

}  // namespace

LevelRule::LevelRule(const Camera& camera, std::vector<int> levels)
    : perspective_(camera.perspective),
      pixel_(std::max(std::abs(camera.plane_scale_x), std::abs(camera.plane_scale_y))),
      levels_(std::move(levels)) {
    const V2f first(camera.plane_offset_x, camera.plane_offset_y);
    const V2f size(camera.plane_scale_x * static_cast<float>(camera.width),
                   camera.plane_scale_y * static_cast<float>(camera.height));
    center_ = first + size * 0.5f;
    radius_ = size.length() / 2;
    growth_ = perspective_ ? pixel_ : pixel_ / radius_;
}

float LevelRule::pixel(const V3f& P) const {
    if (perspective_) return pixel_ * P.length();
    return pixel_ * std::max(1.0f, (V2f(P.x, P.y) - center_).length() / radius_);
}

/// Where a level begins, infinite where nowhere: the ray has to be wide enough, and two overlaps away from
/// where it begins, so that what it leaves is not met. At t a pixel's side is at most p + growth * t.
float LevelRule::begin_of(int level, const RaySegment& ray) const {
    const float p = pixel(ray.origin);
    // Wide enough: p + spread * t >= width * (p + growth * t)
    const float width = kSidesOfWidth * level_side(level), gain = ray.spread - width * growth_;
    // Far enough: t >= min + overlaps * (p + growth * t)
    const float overlaps = 2 * kOverlap * level_side(level), rest = 1 - overlaps * growth_;
    if (!(gain > 0) || !(rest > 0)) return std::numeric_limits<float>::infinity();
    return std::max((width - 1) * p / gain, (ray.min + overlaps * p) / rest);
}

LevelSpans LevelRule::of(const RaySegment& ray) const {
    LevelSpans spans;
    int level = 0;
    float from = ray.min;
    for (const int next : levels_) {
        if (next <= ray.level) {
            level = next;
            continue;
        }
        const float end = begin_of(next, ray);
        if (!(end < ray.max)) break;
        spans.span[spans.count++] = {level, from, end};
        from = end - kOverlap * level_side(next) * (pixel(ray.origin) + growth_ * end);
        level = next;
    }
    spans.span[spans.count++] = {level, from, ray.max};
    return spans;
}

}  // namespace trapeze
