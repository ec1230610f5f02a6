#include "tessellate/raster_bound.h"

#include <algorithm>
#include <cmath>

namespace trapeze {
namespace {

/// Pixels that make up for the rounding of projections.
constexpr float kSlack = 0.02f;

/// NaN counts as the lower end.
int clamped_int(float value, int lo, int hi) {
    if (!(value > static_cast<float>(lo))) return lo;
    return value < static_cast<float>(hi) ? static_cast<int>(value) : hi;
}

}  // namespace

/// Displacement is in all directions, for shaders may move points any way; the rounding is relative to the
/// largest coordinate.
Box3f grown(const Box3f& box, float displacement_bound) {
    constexpr float kRounding = 4e-6f;
    float largest = 0;
    for (int k = 0; k < 3; ++k) largest = std::max({largest, std::abs(box.min[k]), std::abs(box.max[k])});
    const V3f grow(displacement_bound + kRounding * largest);
    return {box.min - grow, box.max + grow};
}

/// In front of the eye a perspective image of a box is bounded by those of its corners; the blur of the lens
/// and of the keys between is added to that.
RasterBound::Result RasterBound::of(std::span<const Box3f> boxes) const {
    if (everything_) return {picture_, true};
    Box3f all;
    for (const Box3f& box : boxes) all.extendBy(box);
    if (all.isEmpty() || all.max.z < camera_.near_clip || all.min.z > camera_.far_clip) return {};
    const float nearest_sure = std::max(camera_.near_clip, 1e-6f);
    if (camera_.perspective && !(all.min.z > nearest_sure)) {
        // Through the near plane: projections mean nothing. Rays are compared as whole lines.
        return {missed_by_all_rays(all) ? PixelRect{} : picture_, false};
    }
    Rect r{1e30f, 1e30f, -1e30f, -1e30f};
    for (const Box3f& box : boxes) {
        const Rect one = projected(box);
        r = {std::min(r.x0, one.x0), std::min(r.y0, one.y0), std::max(r.x1, one.x1), std::max(r.y1, one.y1)};
    }
    // The blur is |1 / z - 1 / focal distance| times a constant (orthographic: |1 - z / focal distance|):
    // largest at an end, also for the depths between two keys.
    const V2f blur_near = camera_.circle_of_confusion(all.min.z);
    const V2f blur_far = camera_.circle_of_confusion(all.max.z);
    const float bx = std::max(blur_near.x, blur_far.x) * 1.0001f + kSlack;
    const float by = std::max(blur_near.y, blur_far.y) * 1.0001f + kSlack;
    const auto low = [](float x, int lo, int hi) { return clamped_int(std::floor(x), lo, hi); };
    const auto high = [](float x, int lo, int hi) {
        return std::isnan(x) ? hi : clamped_int(std::floor(x) + 1, lo, hi);
    };
    const PixelRect& p = picture_;
    Result result;
    result.rect = {low(r.x0 - bx, p.x0, p.x1), low(r.y0 - by, p.y0, p.y1), high(r.x1 + bx, p.x0, p.x1),
                   high(r.y1 + by, p.y0, p.y1)};
    if (result.rect.empty()) result.rect = {};
    const auto holds = [](float lo, float hi, int from, int to) {
        return lo > static_cast<float>(from) && hi < static_cast<float>(to);
    };
    result.inside = holds(r.x0 - bx, r.x1 + bx, p.x0, p.x1) && holds(r.y0 - by, r.y1 + by, p.y0, p.y1) &&
                    all.max.z <= camera_.far_clip;
    return result;
}

/// Holds for boxes before the eye: there the projection of a convex body is the hull of its corners'
/// projections.
RasterBound::Rect RasterBound::projected(const Box3f& box) const {
    Rect r{1e30f, 1e30f, -1e30f, -1e30f};
    for (int corner = 0; corner < 8; ++corner) {
        const V2f p = camera_.raster_from_camera({corner & 1 ? box.max.x : box.min.x,
                                                  corner & 2 ? box.max.y : box.min.y,
                                                  corner & 4 ? box.max.z : box.min.z});
        r.x0 = std::min(r.x0, p.x), r.x1 = std::max(r.x1, p.x);
        r.y0 = std::min(r.y0, p.y), r.y1 = std::max(r.y1, p.y);
    }
    return r;
}

/// Sees the two axes apart, which is not tight but needs no projection.
bool RasterBound::missed_by_all_rays(const Box3f& box) const {
    return missed_along(0, box) || missed_along(1, box);
}

/// A ray through plane position i from lens point l is at l * (1 - z / f) + i * z: all of them at the box'
/// depths against the box' extent.
bool RasterBound::missed_along(int axis, const Box3f& box) const {
    const float scale = axis == 0 ? camera_.plane_scale_x : camera_.plane_scale_y;
    const float offset = axis == 0 ? camera_.plane_offset_x : camera_.plane_offset_y;
    const int from = axis == 0 ? picture_.x0 : picture_.y0, to = axis == 0 ? picture_.x1 : picture_.y1;
    float lo = 1e30f, hi = -1e30f;
    for (const float z : {box.min.z, box.max.z}) {
        const float lens = camera_.lens_radius * std::abs(1 - z / camera_.focal_distance) * 1.0001f;
        for (const int pixel : {from - 1, to + 1}) {  // a pixel more, for rounding
            const float at = (static_cast<float>(pixel) * scale + offset) * z;
            lo = std::min(lo, at - lens), hi = std::max(hi, at + lens);
        }
    }
    return box.min[axis] > hi || box.max[axis] < lo;
}

}  // namespace trapeze
