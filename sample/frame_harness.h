/// Small frames for tests and benchmarks.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/grids_harness.h"
#include "core/samples.h"
#include "core/scene/render_context.h"
#include "core/scene/scene.h"

namespace trapeze::testing {

/// A frame without a scene: options and the context made from them.
struct TestFrame {
    Options options;
    RenderContext context;

    TestFrame(int width, int height, int samples, bool motion, bool defocus) {
        options.width = width, options.height = height;
        options.projection = "perspective";
        options.fov = 60;
        options.near_clip = 0.1f, options.far_clip = 1000;
        if (defocus) options.f_stop = 2, options.focal_length = 1, options.focal_distance = 5;
        context.samples_x = context.samples_y = samples;
        context.motion = motion;
        context.seed = 7;
        update();
    }
    /// After a change of the options.
    void update() { context.camera = make_camera(options); }
};

/// 64x64 pixels.
inline TestFrame frame_of_samples(int nx, int ny, bool motion = true, bool defocus = true) {
    TestFrame frame(64, 64, 1, motion, defocus);
    frame.context.samples_x = nx, frame.context.samples_y = ny;
    return frame;
}

/// Back from the disk to the square [0, 1)^2 [Shirley97].
inline V2f square_from_disk(float u, float v) {
    const double r = std::hypot(u, v), quarter = M_PI / 4;
    if (r == 0) return {0.5f, 0.5f};
    const bool sideways = std::abs(u) >= std::abs(v);
    const double major = std::copysign(r, sideways ? u : v),
                 minor =
                     (sideways ? r * std::atan2(v, std::abs(u)) : r * std::atan2(u, std::abs(v))) / quarter;
    const auto to_unit = [](double x) { return static_cast<float>((x + 1) / 2); };
    return sideways ? V2f(to_unit(major), to_unit(minor)) : V2f(to_unit(minor), to_unit(major));
}

inline std::vector<PixelRect> tiles_of(const PixelRect& all) {
    std::vector<PixelRect> tiles;
    for (int y = all.y0; y < all.y1; y += kTileSide)
        for (int x = all.x0; x < all.x1; x += kTileSide)
            tiles.push_back({x, y, std::min(x + kTileSide, all.x1), std::min(y + kTileSide, all.y1)});
    return tiles;
}

}  // namespace trapeze::testing
