/// What every pattern of samples promises.
#include "sample/patterns/sample_pattern.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "sample/frame_harness.h"

namespace trapeze {
namespace {

using testing::frame_of_samples;
using testing::TestFrame;

class EveryPattern : public ::testing::TestWithParam<std::string> {
  protected:
    static SampleTile tile_of(const TestFrame& frame, const PixelRect& pixels) {
        std::string error;
        const auto spec = parse_pattern(GetParam(), &error);
        SampleTile tile;
        if (!spec)
            ADD_FAILURE() << error;
        else
            make_sample_pattern(frame.context, *spec)->make_tile(pixels, tile);
        return tile;
    }
};

TEST_P(EveryPattern, StaysInThePixelTheDiskAndTheShutter) {
    TestFrame frame = frame_of_samples(8, 8);
    frame.options.width = 20000, frame.update();
    for (const PixelRect& pixels : {PixelRect{-16, -16, 0, 0},
                                    {-15, -16, 0, 3},
                                    {16384, 4096, 16400, 4112},
                                    {16384, 4097, 16400, 4112}}) {
        const SampleTile tile = tile_of(frame, pixels);
        ASSERT_EQ(tile.size(), static_cast<size_t>(pixels.width() * pixels.height() * 64));
        for (size_t i = 0; i < tile.size(); ++i) {
            const int pixel = static_cast<int>(i) / tile.samples_per_pixel;
            ASSERT_EQ(std::floor(tile.x[i]), static_cast<float>(pixels.x0 + pixel % pixels.width()));
            ASSERT_EQ(std::floor(tile.y[i]), static_cast<float>(pixels.y0 + pixel / pixels.width()));
            ASSERT_LE(std::hypot(tile.lens_u[i], tile.lens_v[i]), 1.00001f);
            ASSERT_GE(tile.time[i], 0);
            ASSERT_LT(tile.time[i], 1);
        }
    }
}

TEST_P(EveryPattern, LooksThroughTheOpenPartOfTheLens) {
    TestFrame frame = frame_of_samples(8, 8);
    frame.context.camera.aperture = {4, 0, 0, 0};
    const SampleTile tile = tile_of(frame, {0, 0, 16, 16});
    float most = 0;
    for (size_t i = 0; i < tile.size(); ++i) {
        const float from_middle = std::abs(tile.lens_u[i]) + std::abs(tile.lens_v[i]);
        ASSERT_LE(from_middle, 1.00001f);  // a square on its corner
        most = std::max(most, from_middle);
    }
    EXPECT_GT(most, .98f);
}

TEST_P(EveryPattern, APixelsSamplesDoNotDependOnTheTile) {
    const TestFrame frame = frame_of_samples(3, 3);
    const SampleTile large = tile_of(frame, {-4, -4, 12, 12}), small = tile_of(frame, {5, -1, 7, 3});
    for (int py = -1; py < 3; ++py)
        for (int px = 5; px < 7; ++px)
            for (size_t i = 0; i < 9; ++i) {
                const size_t a = large.first_of_pixel(px, py) + i, b = small.first_of_pixel(px, py) + i;
                ASSERT_EQ(large.x[a], small.x[b]);
                ASSERT_EQ(large.y[a], small.y[b]);
                ASSERT_EQ(large.lens_u[a], small.lens_u[b]);
                ASSERT_EQ(large.lens_v[a], small.lens_v[b]);
                ASSERT_EQ(large.time[a], small.time[b]);
                ASSERT_EQ(large.rays[a].ux, small.rays[b].ux);
            }
}

TEST_P(EveryPattern, RaysAreTheCameras) {
    const TestFrame frame = frame_of_samples(2, 2);
    const SampleTile tile = tile_of(frame, {3, 3, 6, 6});
    for (size_t i = 0; i < tile.size(); ++i) {
        const AxisRay ray =
            frame.context.camera.ray(tile.x[i], tile.y[i], tile.lens_u[i], tile.lens_v[i], tile.time[i]);
        ASSERT_EQ(tile.rays[i].ox, ray.ox);
        ASSERT_EQ(tile.rays[i].oy, ray.oy);
        ASSERT_EQ(tile.rays[i].ux, ray.ux);
        ASSERT_EQ(tile.rays[i].uy, ray.uy);
        ASSERT_EQ(tile.rays[i].time, tile.time[i]);
    }
}

TEST_P(EveryPattern, WithoutMotionOrLensTheseAreZero) {
    const SampleTile tile = tile_of(frame_of_samples(4, 4, false, false), {0, 0, 8, 8});
    for (size_t i = 0; i < tile.size(); ++i) {
        ASSERT_EQ(tile.time[i], 0);
        ASSERT_EQ(tile.lens_u[i], 0);
        ASSERT_EQ(tile.lens_v[i], 0);
    }
}

TEST_P(EveryPattern, SeedsGiveOtherSamples) {
    TestFrame frame = frame_of_samples(4, 4);
    const SampleTile first = tile_of(frame, {0, 0, 4, 4});
    frame.context.seed = 8;
    const SampleTile second = tile_of(frame, {0, 0, 4, 4});
    size_t same_place = 0, same_lens = 0;
    for (size_t i = 0; i < first.size(); ++i)
        same_place += first.x[i] == second.x[i], same_lens += first.lens_u[i] == second.lens_u[i];
    EXPECT_LT(same_place, first.size() / 20);
    EXPECT_LT(same_lens, first.size() / 20);
}

INSTANTIATE_TEST_SUITE_P(Names, EveryPattern,
                         ::testing::Values("stratified", "interval", "interleaved:k=1", "interleaved:k=2",
                                           "interleaved:k=4"),
                         [](const ::testing::TestParamInfo<std::string>& tested) {
                             std::string name = tested.param;
                             std::replace_if(
                                 name.begin(), name.end(), [](char c) { return !std::isalnum(c); }, '_');
                             return name;
                         });

}  // namespace
}  // namespace trapeze
