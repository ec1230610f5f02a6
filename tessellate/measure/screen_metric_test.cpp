#include "tessellate/measure/screen_metric.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/noise_harness.h"
#include "core/scene/scene.h"

namespace trapeze {
namespace {

using testing::Noise;

/// 200x100 pixels, 90 degrees across the shorter side.
Camera camera_of(const char* projection) {
    Options options;
    options.projection = projection;
    options.fov = 90;
    options.width = 200, options.height = 100;
    return make_camera(options);
}

TEST(ScreenMetric, IsRasterDistanceInView) {
    const Camera camera = camera_of("perspective");
    const ScreenMetric metric(camera);
    Noise noise;
    for (int n = 0; n < 200; ++n) {
        V3f p = noise.point(.6f, 1, 9), q = noise.point(.6f, 1, 9);
        p.x *= p.z, p.y *= p.z, q.x *= q.z, q.y *= q.z;
        const PixelLength length = metric.of(p, q);
        EXPECT_TRUE(length.in_view);
        const float raster = (camera.raster_from_camera(p) - camera.raster_from_camera(q)).length();
        EXPECT_NEAR(length.seen, raster, 1e-3f * (1 + raster));
    }
}

TEST(ScreenMetric, SquareOnIsSeenWhereAPieceIs) {
    const ScreenMetric metric(camera_of("perspective"));
    const PixelLength square = metric.of({0, 0, 5}, {1, 0, 5});
    EXPECT_NEAR(square.seen, 10, 1e-4f);
    EXPECT_NEAR(square.square_on, 10, 1e-4f);
    const PixelLength along = metric.of({0, 0, 5}, {0, 0, 6});
    EXPECT_EQ(along.seen, 0);
    EXPECT_NEAR(along.square_on, 50 / 5.5f, 1e-4f);
    EXPECT_FLOAT_EQ(metric.length({0, 0, 5}, {0, 0, 6}), kLeastForeshortening * along.square_on);
}

/// Behind the eye and in its plane, lengths are angles: finite, and without a step where the view ends.
TEST(ScreenMetric, IsBoundedBehindTheEye) {
    const ScreenMetric metric(camera_of("perspective"));
    Noise noise;
    const float half_turn = 3.15f * metric.pixels() / (metric.view_cosine() * metric.view_cosine());
    for (int n = 0; n < 500; ++n) {
        const V3f p = noise.point(3, -3, n % 5 ? 3.f : 0.f), q = noise.point(3, -3, 3);
        const PixelLength length = metric.of(p, q);
        EXPECT_TRUE(std::isfinite(length.seen) && std::isfinite(length.square_on));
        EXPECT_TRUE(length.in_view || length.seen <= half_turn) << length.seen;
    }
    const PixelLength through_eye = metric.of({0, 0, -1}, {0, 0, 1}),
                      nothing = metric.of({0, 0, 0}, {0, 0, 0});
    EXPECT_TRUE(std::isfinite(through_eye.seen) && std::isfinite(through_eye.square_on));
    EXPECT_EQ(nothing.seen, 0);
    // Across the ray through a corner of the picture, just inside and just outside.
    const V3f corner = V3f(2, 1, 1).normalized();
    const V3f step = V3f(-1, 2, 0).normalized() * 1e-3f;
    const PixelLength inside =
                          metric.of(corner * .9999f + V3f(0, 0, 1e-3f), corner + V3f(0, 0, 1e-3f) + step),
                      outside = metric.of(corner - V3f(0, 0, 1e-3f), corner - V3f(0, 0, 1e-3f) + step);
    EXPECT_TRUE(inside.in_view);
    EXPECT_FALSE(outside.in_view);
    EXPECT_NEAR(inside.square_on / outside.square_on, metric.view_cosine() / corner.z, .02f);
}

TEST(ScreenMetric, OfParallelRaysShrinksBesideTheWindow) {
    const Camera camera = camera_of("orthographic");
    const ScreenMetric metric(camera);
    EXPECT_FALSE(metric.is_perspective());
    EXPECT_NEAR(metric.of({0, 0, 5}, {1, 0, 90}).seen, 50, 1e-3f);
    EXPECT_NEAR(metric.of({.5f, 0, -5}, {.5f, 1, -5}).seen, 50, 1e-3f);
    const float radius = std::sqrt(5.f);  // of the circle around a window of 4 by 2
    EXPECT_NEAR(metric.of({100, 0, 5}, {101, 0, 5}).seen, 50 * radius / 100, 1e-3f);
}

TEST(ScreenMetric, OfSeveralPiecesIsTheSame) {
    for (const char* projection : {"perspective", "orthographic"}) {
        const ScreenMetric metric(camera_of(projection));
        Noise noise;
        std::vector<V3f> from, to;
        for (int n = 0; n < 45; ++n)
            from.push_back(noise.point(4, -2, 6)), to.push_back(noise.point(4, -2, 6));
        std::vector<PixelLength> lengths(from.size());
        metric.of(from, to, lengths);
        size_t in_view = 0;
        for (size_t i = 0; i < from.size(); ++i) {
            const PixelLength one = metric.of(from[i], to[i]);
            EXPECT_EQ(lengths[i].seen, one.seen);
            EXPECT_EQ(lengths[i].square_on, one.square_on);
            EXPECT_EQ(lengths[i].in_view, one.in_view);
            in_view += one.in_view;
        }
        EXPECT_GT(in_view, 2u);
    }
}

}  // namespace
}  // namespace trapeze
