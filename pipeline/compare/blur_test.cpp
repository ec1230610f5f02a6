#include "pipeline/compare/blur.h"

#include <gtest/gtest.h>

#include "pipeline/compare/compare_harness.h"
#include "sample/frame_harness.h"

namespace trapeze {
namespace {

using testing::GridMaker;
using testing::TestFrame;

TEST(WeightedMedian, HalfOfTheWeightLiesBelow) {
    EXPECT_EQ(weighted_median({}), 0);
    EXPECT_EQ(weighted_median({{5.0f, 1}, {1.0f, 1}, {2.0f, 1}}), 2);
    EXPECT_EQ(weighted_median({{5.0f, 10}, {1.0f, 1}, {2.0f, 1}}), 5);
}

TEST(Blur, IsWhatTheCameraSaysOfTheGrids) {
    TestFrame frame(640, 480, 1, true, true);
    GridMaker maker;
    const float z = 20;
    const float pixel = 1 / frame.context.camera.pixels_per_length(z).x;
    // 1 x 1 micropolygon at rest; 2 x 2 that go 3 pixels right, then (another key) 4 down.
    maker.add(1, 1, 1, [&](int i, int j, float) { return V3f(i * pixel, j * pixel, z); });
    maker.add(2, 2, 3, [&](int i, int j, float t) {
        const float right = std::min(t, 0.5f) * 2 * 3 * pixel,
                    down = std::max(t - 0.5f, 0.0f) * 2 * 4 * pixel;
        return V3f(i * pixel + right, j * pixel - down, z);
    });
    const FrameBlur blur = measure_blur(frame.context.camera, maker.grids());
    EXPECT_NEAR(blur.motion.largest, 7, 1e-3);
    EXPECT_NEAR(blur.motion.median, 7, 1e-3) << "most micropolygons move";
    EXPECT_NEAR(blur.defocus.largest, 2 * frame.context.camera.circle_of_confusion(z).x, 1e-3);
    EXPECT_GT(blur.defocus.median, 1);
}

TEST(Blur, WhatIsBehindTheCameraDoesNotCount) {
    TestFrame frame(640, 480, 1, true, true);
    GridMaker maker;
    maker.add(1, 1, 2, [](int i, int j, float t) { return V3f(i + 5 * t, j, -3 + t); });
    const FrameBlur blur = measure_blur(frame.context.camera, maker.grids());
    EXPECT_EQ(blur.motion.largest, 0);
    EXPECT_EQ(blur.defocus.largest, 0);
    EXPECT_EQ(blur.motion.median, 0);
}

TEST(Blur, ASharpSceneHasNone) {
    const testing::SharedScene shared("quadric_sphere.rib");
    const FrameBlur blur = measure_blur(shared.frame->context.camera, shared.frame->grids);
    EXPECT_EQ(blur.motion.largest, 0);
    EXPECT_EQ(blur.defocus.largest, 0);
}

}  // namespace
}  // namespace trapeze
