#include "tessellate/measure/screen_metric.h"

#include <array>
#include <cmath>

#include "core/portable_math.h"

namespace trapeze {
namespace {

/// Pieces at once: loops over lanes are what compilers vectorise.
constexpr size_t kLanes = 8;
using FloatLanes = std::array<float, kLanes>;

/// Points in lanes; those behind the last are as the last.
struct PointLanes {
    FloatLanes x, y, z;

    explicit PointLanes(std::span<const V3f> points) {
        for (size_t l = 0; l < kLanes; ++l) {
            const V3f& p = points[std::min(l, points.size() - 1)];
            x[l] = p.x, y[l] = p.y, z[l] = p.z;
        }
    }
};

/// The parameter of the segment's point nearest to the origin.
template <class V>
float nearest_to_origin(const V& p, const V& d) {
    const float dd = d.dot(d);
    return dd > 0 ? std::clamp(-p.dot(d) / dd, 0.0f, 1.0f) : 0.0f;
}

}  // namespace

/// Lengths are taken from the image plane's scales, so that pixels which are not square count as they are.
ScreenMetric::ScreenMetric(const Camera& camera)
    : perspective_(camera.perspective),
      pixels_x_(std::abs(1 / camera.plane_scale_x)),
      pixels_y_(std::abs(1 / camera.plane_scale_y)),
      pixels_(std::max(pixels_x_, pixels_y_)) {
    // The whole image, not the crop: a crop shows the same micropolygons.
    const float x0 = camera.plane_offset_x, y0 = camera.plane_offset_y;
    const float x1 = x0 + camera.plane_scale_x * static_cast<float>(camera.width);
    const float y1 = y0 + camera.plane_scale_y * static_cast<float>(camera.height);
    const float x = std::max(std::abs(x0), std::abs(x1)), y = std::max(std::abs(y0), std::abs(y1));
    view_cosine_ = 1 / std::sqrt(1 + x * x + y * y);
    center_ = {(x0 + x1) / 2, (y0 + y1) / 2};
    radius_ = portable::hypot(x1 - x0, y1 - y0) / 2;
}

/// Where both ends are in view, the length on the raster. Elsewhere the angle at the eye times what an angle
/// is worth at the picture's corner, which joins on without a step there and stays finite behind the eye.
PixelLength ScreenMetric::perspective_length(const V3f& p, const V3f& q) const {
    const V3f d = q - p;
    // A point is in view when the cosine of its angle to the axis is at least the corner's.
    const float least = view_cosine_ * view_cosine_;
    const bool in_view = p.z > 0 && q.z > 0 && p.z * p.z >= least * p.dot(p) && q.z * q.z >= least * q.dot(q);
    if (in_view) {
        const float p_scale = 1 / p.z, q_scale = 1 / q.z;
        const float x = (q.x * q_scale - p.x * p_scale) * pixels_x_;
        const float y = (q.y * q_scale - p.y * p_scale) * pixels_y_;
        return {std::sqrt(x * x + y * y), std::sqrt(d.dot(d)) * pixels_ * 2 / (p.z + q.z)};
    }
    const float angle = portable::atan2(p.cross(q).length(), p.dot(q));
    const float nearest = (p + d * nearest_to_origin(p, d)).length();
    // A bound for pieces through the eye itself, whose splitting the depth limit ends.
    const float distance = std::max(nearest, d.length() / 64);
    const float square_on = distance > 0 ? d.length() / distance : 0.0f;
    const float scale = pixels_ / view_cosine_;
    return {angle / view_cosine_ * scale, square_on * scale, false};
}

/// What lies in view is computed in lanes, all of it; the few pieces that do not are done again one by one.
void ScreenMetric::perspective_lengths(std::span<const V3f> from, std::span<const V3f> to,
                                       std::span<PixelLength> lengths) const {
    const PointLanes p(from), q(to);
    const float least = view_cosine_ * view_cosine_;
    FloatLanes seen, square_on;
    std::array<int32_t, kLanes> in_view;
    for (size_t l = 0; l < kLanes; ++l) {
        const float pp = p.x[l] * p.x[l] + p.y[l] * p.y[l] + p.z[l] * p.z[l];
        const float qq = q.x[l] * q.x[l] + q.y[l] * q.y[l] + q.z[l] * q.z[l];
        in_view[l] = (p.z[l] > 0 ? 1 : 0) & (q.z[l] > 0 ? 1 : 0) & (p.z[l] * p.z[l] >= least * pp ? 1 : 0) &
                     (q.z[l] * q.z[l] >= least * qq ? 1 : 0);
        const float p_scale = 1 / p.z[l], q_scale = 1 / q.z[l];
        const float x = (q.x[l] * q_scale - p.x[l] * p_scale) * pixels_x_;
        const float y = (q.y[l] * q_scale - p.y[l] * p_scale) * pixels_y_;
        const float dx = q.x[l] - p.x[l], dy = q.y[l] - p.y[l], dz = q.z[l] - p.z[l];
        seen[l] = std::sqrt(x * x + y * y);
        square_on[l] = std::sqrt(dx * dx + dy * dy + dz * dz) * pixels_ * 2 / (p.z[l] + q.z[l]);
    }
    for (size_t l = 0; l < from.size(); ++l)
        lengths[l] =
            in_view[l] ? PixelLength{seen[l], square_on[l], true} : perspective_length(from[l], to[l]);
}

void ScreenMetric::of(std::span<const V3f> from, std::span<const V3f> to,
                      std::span<PixelLength> lengths) const {
    if (!perspective_) {
        for (size_t i = 0; i < from.size(); ++i) lengths[i] = orthographic_length(from[i], to[i]);
        return;
    }
    for (size_t first = 0; first < from.size(); first += kLanes) {
        const size_t count = std::min(kLanes, from.size() - first);
        perspective_lengths(from.subspan(first, count), to.subspan(first, count), lengths.subspan(first));
    }
}

/// Far beside the window lengths shrink with the distance from it, so that a large plane does not cost by its
/// size.
PixelLength ScreenMetric::orthographic_length(const V3f& p, const V3f& q) const {
    const V3f d = q - p;
    const V2f from_center = V2f(p.x, p.y) - center_, across(d.x, d.y);
    const float outside = (from_center + across * nearest_to_origin(from_center, across)).length();
    const float x = d.x * pixels_x_, y = d.y * pixels_y_;
    const float scale = outside > radius_ ? radius_ / outside : 1;
    return {std::sqrt(x * x + y * y) * scale, std::sqrt(d.dot(d)) * pixels_ * scale};
}

}  // namespace trapeze
