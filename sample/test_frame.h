/// Small frames for tests and benchmarks.
#pragma once

#include <algorithm>
#include <vector>

#include "core/render_context.h"
#include "core/samples.h"
#include "core/scene.h"
#include "core/test_grids.h"

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

inline std::vector<PixelRect> tiles_of(const PixelRect& all) {
    std::vector<PixelRect> tiles;
    for (int y = all.y0; y < all.y1; y += kTileSide)
        for (int x = all.x0; x < all.x1; x += kTileSide)
            tiles.push_back({x, y, std::min(x + kTileSide, all.x1), std::min(y + kTileSide, all.y1)});
    return tiles;
}

}  // namespace trapeze::testing
