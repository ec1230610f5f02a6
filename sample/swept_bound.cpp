#include "sample/swept_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace trapeze {
namespace {

constexpr double kEverywhere = std::numeric_limits<double>::infinity();

/// Along one axis, in the image plane at depth 1 (perspective) or in camera space (orthographic); doubles, so
/// that only the predicate's own rounding has to be covered.
struct PlaneRange {
    double min, max;
};

/// Raster coordinates of a range of the image plane, which is first grown by `grow`.
PlaneRange raster_range(PlaneRange plane, double grow, double scale, double offset) {
    const double a = (plane.min - grow - offset) / scale, b = (plane.max + grow - offset) / scale;
    return {std::min(a, b), std::max(a, b)};
}

}  // namespace

/// How far from the axis, at depth 1, any ray of the picture and its border can be; the lens moves it by its
/// radius over the distance of focus.
double ray_reach(const Camera& camera) {
    const double x = std::abs(camera.plane_scale_x) * (camera.width + kMostPixelsOutside) +
                     std::abs(camera.plane_offset_x);
    const double y = std::abs(camera.plane_scale_y) * (camera.height + kMostPixelsOutside) +
                     std::abs(camera.plane_offset_y);
    return std::max(x, y) + camera.lens_radius * (1 + kRasterRounding) / camera.focal_distance;
}

/// Infinite both ways: intersected with any pixels it gives all of them.
RasterBox RasterBox::everything() {
    return {-kEverywhere, -kEverywhere, kEverywhere, kEverywhere};
}

RasterBox RasterBox::nothing() {
    return {kEverywhere, kEverywhere, -kEverywhere, -kEverywhere};
}

/// Perspective takes lines to lines, so the places of a moving corner in the image plane lie between those at
/// its ends, as long as both are in front of the eye.
void SweptBound::add(float xf, float yf, float zf) {
    const double x = xf, y = yf, z = zf;
    z_min_ = std::min(z_min_, z), z_max_ = std::max(z_max_, z);
    x_min_ = std::min(x_min_, x), x_max_ = std::max(x_max_, x);
    y_min_ = std::min(y_min_, y), y_max_ = std::max(y_max_, y);
    absolute_max_ = std::max({absolute_max_, std::abs(x), std::abs(y), std::abs(z)});
    // Only points in front of the eye have a place in the image plane.
    if (!(z > 0)) return;
    px_min_ = std::min(px_min_, x / z), px_max_ = std::max(px_max_, x / z);
    py_min_ = std::min(py_min_, y / z), py_max_ = std::max(py_max_, y / z);
}

/// The circle of confusion is linear in 1 / z (orthographic: in z) and so largest at one of both ends of the
/// depths; the box grows by it, and by what the predicate and the camera's rays may round.
RasterBox SweptBound::raster(const Camera& camera) const {
    if (z_max_ < camera.near_clip || z_min_ > camera.far_clip) return RasterBox::nothing();
    if (!(absolute_max_ < kBoundable)) return RasterBox::everything();
    const double radius = camera.lens_radius * (1 + kRasterRounding), in_focus = 1.0 / camera.focal_distance;
    const double reach = ray_reach(camera);
    PlaneRange x{x_min_, x_max_}, y{y_min_, y_max_};
    double grow;
    if (camera.perspective) {
        if (!(z_min_ > camera.near_clip && z_min_ > 0)) return RasterBox::everything();
        x = {px_min_, px_max_}, y = {py_min_, py_max_};
        grow = radius * std::max(std::abs(in_focus - 1 / z_min_), std::abs(in_focus - 1 / z_max_)) +
               kRasterRounding * ((absolute_max_ + radius + reach * z_max_) / z_min_ + reach);
    } else {
        grow = radius * std::max(std::abs(z_min_ * in_focus - 1), std::abs(z_max_ * in_focus - 1)) +
               kRasterRounding * (absolute_max_ * (1 + radius * in_focus) + reach);
    }
    const PlaneRange rx = raster_range(x, grow, camera.plane_scale_x, camera.plane_offset_x);
    const PlaneRange ry = raster_range(y, grow, camera.plane_scale_y, camera.plane_offset_y);
    return {rx.min, ry.min, rx.max, ry.max};
}

/// The end of a segment is computed as the predicate does it, by position_at(), and not taken from the next
/// segment's start: the two may differ by a rounding.
void add_vertex(const Grid& grid, int i, int j, SweptBound& bound) {
    const int at = grid.shape.tiled_index(i, j);
    for (int segment = 0; segment < segment_count(grid.key_count); ++segment) {
        const float x = grid.plane(segment, 0)[at], y = grid.plane(segment, 1)[at],
                    z = grid.plane(segment, 2)[at];
        bound.add(x, y, z);
        if (!grid.moves()) continue;
        bound.add(position_at(x, grid.plane(segment, 3)[at], 1),
                  position_at(y, grid.plane(segment, 4)[at], 1),
                  position_at(z, grid.plane(segment, 5)[at], 1));
    }
}

RasterBox raster_bound(const Grid& grid, const Camera& camera) {
    SweptBound bound;
    for (int j = 0; j <= grid.shape.nv; ++j)
        for (int i = 0; i <= grid.shape.nu; ++i) add_vertex(grid, i, j, bound);
    return bound.raster(camera);
}

/// Boxes are closed and may be infinite, so they are clamped in doubles before anything becomes an int. A
/// sample on a pixel's left or upper edge is that pixel's.
PixelRect pixels_within(const RasterBox& box, const PixelRect& pixels) {
    const auto floor_in = [](double at, int low, int high) {
        return static_cast<int>(
            std::clamp(std::floor(at), static_cast<double>(low), static_cast<double>(high)));
    };
    if (!(box.min_x <= box.max_x && box.min_y <= box.max_y)) return {};
    if (box.max_x < pixels.x0 || box.max_y < pixels.y0) return {};
    if (box.min_x >= pixels.x1 || box.min_y >= pixels.y1) return {};
    return {floor_in(box.min_x, pixels.x0, pixels.x1), floor_in(box.min_y, pixels.y0, pixels.y1),
            floor_in(box.max_x, pixels.x0, pixels.x1 - 1) + 1,
            floor_in(box.max_y, pixels.y0, pixels.y1 - 1) + 1};
}

}  // namespace trapeze
