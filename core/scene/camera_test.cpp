#include "core/scene/camera.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/scene/scene.h"

namespace trapeze {
namespace {

Options small_options() {
    Options options;
    options.width = 200, options.height = 100;
    options.projection = "perspective";
    options.fov = 90;
    options.near_clip = 0.1f, options.far_clip = 100;
    return options;
}

Options with_lens() {
    Options options = small_options();
    options.f_stop = 2, options.focal_length = 1, options.focal_distance = 4;
    return options;
}

V3f at_depth(const AxisRay& ray, float z) {
    return {ray.ox + ray.ux * (z - ray.oz), ray.oy + ray.uy * (z - ray.oz), z};
}

TEST(Camera, RaysGoThroughWhatTheirPixelsSee) {
    for (const char* projection : {"perspective", "orthographic"}) {
        Options options = small_options();
        options.projection = projection;
        const Camera camera = make_camera(options);
        for (const V2f& raster : {V2f(0, 0), V2f(200, 100), V2f(13.5f, 77.25f)})
            for (const float z : {0.5f, 3.0f, 50.0f}) {
                const V2f back =
                    camera.raster_from_camera(at_depth(camera.ray(raster.x, raster.y, 0, 0, 0), z));
                EXPECT_NEAR(back.x, raster.x, 1e-3) << projection;
                EXPECT_NEAR(back.y, raster.y, 1e-3) << projection;
            }
    }
}

TEST(Camera, FovSpansTheShorterSideAndRasterRunsDown) {
    const Camera camera = make_camera(small_options());
    const AxisRay top = camera.ray(100, 0, 0, 0, 0), left = camera.ray(0, 50, 0, 0, 0);
    EXPECT_NEAR(top.uy, 1, 1e-6);  // 45 degrees up
    EXPECT_NEAR(top.ux, 0, 1e-6);
    EXPECT_NEAR(left.ux, -2, 1e-6);
}

/// RISpec 4.1.1: the window is of the screen, on which what is projected is scaled and shifted first.
TEST(Camera, TheScreenMayBeScaledAndShifted) {
    Options options = small_options();
    options.screen_window = {-2, 2, -1, 1};
    options.screen_scale = {-2, 0.5f}, options.screen_offset = {0.5f, 0.25f};
    const Camera camera = make_camera(options);
    for (const V2f& plane : {V2f(0, 0), V2f(0.3f, -0.7f), V2f(-1, 2)}) {
        const V2f screen(plane.x * -2 + 0.5f, plane.y * 0.5f + 0.25f);
        const V2f raster = camera.raster_from_camera(V3f(plane.x * 3, plane.y * 3, 3));
        EXPECT_NEAR(raster.x, (screen.x + 2) / 4 * 200, 1e-3);
        EXPECT_NEAR(raster.y, (1 - screen.y) / 2 * 100, 1e-3);
    }
    EXPECT_EQ(camera.screen_window, *options.screen_window);
    // -1 to 1 across the picture, as without.
    V3f end;
    screen_from_camera(camera).multVecMatrix(V3f(camera.left * 3, camera.top * 3, 3), end);
    EXPECT_NEAR(end.x, -1, 1e-5);
    EXPECT_NEAR(end.y, 1, 1e-5);
    EXPECT_NEAR(camera.left * -2 + 0.5f, -2, 1e-5);
}

TEST(Camera, WhatIsInFocusIsSharpFromAllOfTheLens) {
    for (const char* projection : {"perspective", "orthographic"}) {
        Options options = with_lens();
        options.projection = projection;
        const Camera camera = make_camera(options);
        ASSERT_TRUE(camera.has_lens());
        EXPECT_FLOAT_EQ(camera.lens_radius, 0.25f);
        const V3f sharp = at_depth(camera.ray(30, 40, 0, 0, 0), 4);
        for (const V2f& lens : {V2f(1, 0), V2f(0, -1), V2f(0.5f, 0.5f)}) {
            const AxisRay ray = camera.ray(30, 40, lens.x, lens.y, 0);
            EXPECT_LT((at_depth(ray, 4) - sharp).length(), 1e-5);
            EXPECT_EQ(ray.oz, 0);
        }
    }
}

TEST(Camera, CircleOfConfusionIsWhereRaysFromTheRimLand) {
    const Camera camera = make_camera(with_lens());
    EXPECT_NEAR(camera.circle_of_confusion(4).x, 0, 1e-5);
    for (const float z : {1.0f, 2.0f, 10.0f}) {
        // The point at z straight ahead is seen from the rim at the raster place whose ray passes it.
        const V3f point = at_depth(camera.ray(100, 50, 1, 0, 0), z);
        const float shift = std::abs(camera.raster_from_camera(point).x - 100);
        EXPECT_NEAR(camera.circle_of_confusion(z).x, shift, 1e-3);
    }
}

TEST(Camera, WithoutAnFStopThereIsNoLens) {
    Options options = with_lens();
    options.f_stop = kInfinity;
    EXPECT_FALSE(make_camera(options).has_lens());
    EXPECT_EQ(make_camera(options).circle_of_confusion(1), V2f(0, 0));
}

TEST(Camera, NeighbouringCropsAbut) {
    for (const float cut : {0.0f, 0.1f, 0.333f, 0.5f, 0.9999f, 1.0f}) {
        Options left = small_options(), right = small_options();
        left.crop_window = {0, cut, 0, 1}, right.crop_window = {cut, 1, 0, 1};
        EXPECT_EQ(make_camera(left).crop.x1, make_camera(right).crop.x0);
        EXPECT_EQ(make_camera(left).crop.width() + make_camera(right).crop.width(), 200);
    }
}

TEST(Camera, CropsEndWhereTheirFractionsSay) {
    Options options = small_options();
    options.crop_window = {.3f, .5f, .2f, .6f};
    EXPECT_EQ(make_camera(options).crop, (PixelRect{60, 20, 100, 60}));
    for (int i = 0; i <= 10; ++i) {
        options.crop_window = {static_cast<float>(i) / 10, 1, 0, static_cast<float>(i) / 10};
        const PixelRect crop = make_camera(options).crop;
        EXPECT_EQ(crop.x0, 20 * i);
        EXPECT_EQ(crop.y1, 10 * i);
    }
}

TEST(Camera, SampledPixelsReachAsFarAsTheFilter) {
    Options options = small_options();
    options.crop_window = {0.5f, 0.75f, 0, 0.5f};
    options.filter.width_x = 1, options.filter.width_y = 4;
    EXPECT_EQ(sampled_pixels(make_camera(options), options), (PixelRect{100, -2, 150, 52}));
}

TEST(Camera, ScreenMatrixAgreesWithTheRaster) {
    for (const char* projection : {"perspective", "orthographic"}) {
        Options options = small_options();
        options.projection = projection;
        const Camera camera = make_camera(options);
        const M44f screen = screen_from_camera(camera);
        V3f ndc;
        screen.multVecMatrix(at_depth(camera.ray(150, 25, 0, 0, 0), 7), ndc);
        EXPECT_NEAR(ndc.x, 0.5f, 1e-5) << projection;
        EXPECT_NEAR(ndc.y, 0.5f, 1e-5) << projection;
        screen.multVecMatrix(V3f(0, 0, 100), ndc);
        EXPECT_NEAR(ndc.z, 1, 1e-5) << projection;
        screen.multVecMatrix(V3f(0, 0, 0.1f), ndc);
        EXPECT_NEAR(ndc.z, 0, 1e-5) << projection;
    }
}

TEST(AxisRay, TurnsTheMainAxisToZ) {
    const SpaceRay ray{V3f(1, 2, 3), V3f(-4, 1, 2), 0.5f};
    const TurnedRay turned = axis_ray(ray);
    EXPECT_EQ(turned.z_plane, 0);
    EXPECT_EQ(turned.depth_sign, -1);
    EXPECT_EQ(turned.ray.oz, 1);
    EXPECT_EQ(turned.ray.time, 0.5f);
    // A point of the ray has the coordinates that the turned ray says, in the planes that it names.
    const V3f point = ray.origin + ray.direction * 2.0f;
    const float dz = point[turned.z_plane] - turned.ray.oz;
    EXPECT_FLOAT_EQ(turned.ray.ox + turned.ray.ux * dz, point[turned.x_plane]);
    EXPECT_FLOAT_EQ(turned.ray.oy + turned.ray.uy * dz, point[turned.y_plane]);
}

}  // namespace
}  // namespace trapeze
