#include "core/scene/camera.h"

#include <algorithm>
#include <cmath>

#include "core/portable_math.h"
#include "core/samples.h"
#include "core/scene/adaptive_sampling.h"
#include "core/scene/scene.h"

namespace trapeze {

AxisRay Camera::ray(float raster_x, float raster_y, float lens_u, float lens_v, float time01) const {
    const float x = raster_x * plane_scale_x + plane_offset_x;
    const float y = raster_y * plane_scale_y + plane_offset_y;
    const float lens_x = lens_u * lens_radius, lens_y = lens_v * lens_radius;
    // Through (x, y) on the focal plane whatever the lens point: what is there is sharp.
    const float slope_x = lens_x / focal_distance, slope_y = lens_y / focal_distance;
    if (perspective) return {lens_x, lens_y, 0, x - slope_x, y - slope_y, time01};
    return {x + lens_x, y + lens_y, 0, -slope_x, -slope_y, time01};
}

V2f Camera::raster_from_camera(const V3f& p) const {
    const float w = perspective ? 1 / p.z : 1.0f;
    return {(p.x * w - plane_offset_x) / plane_scale_x, (p.y * w - plane_offset_y) / plane_scale_y};
}

V2f Camera::pixels_per_length(float z) const {
    const float w = perspective ? 1 / z : 1.0f;
    return {std::abs(w / plane_scale_x), std::abs(w / plane_scale_y)};
}

V2f Camera::circle_of_confusion(float z) const {
    if (!has_lens()) return {0, 0};
    // Where the ray from the lens' rim meets depth z, minus the central ray: lens_radius * (1 - z /
    // focal_distance).
    const float at = perspective ? std::max(z, near_clip) : z;
    const float offset = lens_radius * std::abs(1 - at / focal_distance);
    return pixels_per_length(at) * offset;
}

Camera make_camera(const Options& options) {
    Camera camera;
    camera.perspective = options.projection == "perspective";
    camera.width = options.width, camera.height = options.height;
    const float image_aspect =
        static_cast<float>(options.width) * options.pixel_aspect / static_cast<float>(options.height);
    const float aspect = options.frame_aspect.value_or(image_aspect);
    std::array<float, 4> window = aspect >= 1 ? std::array{-aspect, aspect, -1.0f, 1.0f}
                                              : std::array{-1.0f, 1.0f, -1 / aspect, 1 / aspect};
    if (options.screen_window) window = *options.screen_window;
    camera.screen_window = window;
    // On the plane the window stands where the projection has what is then moved into it.
    for (size_t i = 0; i < 4; ++i)
        window[i] = (window[i] - options.screen_offset[i / 2]) / options.screen_scale[i / 2];
    camera.left = window[0], camera.right = window[1], camera.bottom = window[2], camera.top = window[3];
    camera.tan_half_fov =
        camera.perspective ? static_cast<float>(portable::tan(options.fov * (M_PI / 360))) : 1.0f;
    camera.plane_scale_x = (window[1] - window[0]) * camera.tan_half_fov / static_cast<float>(options.width);
    camera.plane_offset_x = window[0] * camera.tan_half_fov;
    camera.plane_scale_y = (window[2] - window[3]) * camera.tan_half_fov / static_cast<float>(options.height);
    camera.plane_offset_y = window[3] * camera.tan_half_fov;
    // RISpec 4.1.1: the pixels from ceil(size * min) to ceil(size * max) - 1, so that neighbouring crops
    // abut. Three tenths of 200 pixels are 60, and not 61 since a float's .3 is a little more.
    const auto edge = [](float fraction, int size) {
        constexpr double kRounding = 0x1p-23;
        const double at = static_cast<double>(fraction) * size;
        return std::clamp(static_cast<int>(std::ceil(at - at * kRounding)), 0, size);
    };
    camera.crop = {edge(options.crop_window[0], options.width), edge(options.crop_window[2], options.height),
                   edge(options.crop_window[1], options.width), edge(options.crop_window[3], options.height)};
    camera.near_clip = options.near_clip, camera.far_clip = options.far_clip;
    const bool lens = options.f_stop < kInfinity && options.f_stop > 0 && options.focal_length > 0 &&
                      options.focal_distance > 0;
    camera.lens_radius = lens ? 0.5f * options.focal_length / options.f_stop : 0.0f;
    camera.focal_distance = lens ? options.focal_distance : 1.0f;
    if (lens) camera.aperture = aperture_of(options);
    return camera;
}

namespace {

int floor_to_tile(int pixel) {
    const int tile = pixel >= 0 ? pixel / kTileSide : -((kTileSide - 1 - pixel) / kTileSide);
    return tile * kTileSide;
}

/// The tiles that a rectangle has a part of.
PixelRect whole_tiles(const PixelRect& r) {
    return {floor_to_tile(r.x0), floor_to_tile(r.y0), floor_to_tile(r.x1 - 1) + kTileSide,
            floor_to_tile(r.y1 - 1) + kTileSide};
}

}  // namespace

PixelRect sampled_pixels(const Camera& camera, const Options& options) {
    // A sample at x reaches the centre p + 1/2 of a pixel when |x - p - 1/2| <= width / 2.
    const auto reach = [](float width) { return std::max(0, static_cast<int>(std::ceil((width - 1) / 2))); };
    const int rx = reach(options.filter.width_x), ry = reach(options.filter.width_y);
    const PixelRect& c = camera.crop;
    const PixelRect pixels{c.x0 - rx, c.y0 - ry, c.x1 + rx, c.y1 + ry};
    if (pixels.empty() || !adaptive_sampling(options).is_on()) return pixels;
    const PixelRect all{-rx, -ry, camera.width + rx, camera.height + ry};
    return intersection(whole_tiles(pixels), all);
}

M44f screen_from_camera(const Camera& camera) {
    // x' = x / (z tan) for perspective, mapped so that the screen window spans [-1, 1] (OpenEXR's
    // worldToNDC).
    const float n = camera.near_clip, f = std::min(camera.far_clip, kInfinity);
    const float sx = 2 / ((camera.right - camera.left) * camera.tan_half_fov);
    const float sy = 2 / ((camera.top - camera.bottom) * camera.tan_half_fov);
    const float cx = -(camera.right + camera.left) / (camera.right - camera.left);
    const float cy = -(camera.top + camera.bottom) / (camera.top - camera.bottom);
    M44f m;
    if (camera.perspective) {
        const float depth = f / (f - n);
        m = M44f(sx, 0, 0, 0, 0, sy, 0, 0, cx, cy, depth, 1, 0, 0, -n * depth, 0);
    } else {
        m = M44f(sx, 0, 0, 0, 0, sy, 0, 0, 0, 0, 1 / (f - n), 0, cx, cy, -n / (f - n), 1);
    }
    return m;
}

}  // namespace trapeze
