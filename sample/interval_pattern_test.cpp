#include "sample/interval_pattern.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "sample/stratified_pattern.h"
#include "sample/test_frame.h"

namespace trapeze {
namespace {

using testing::TestFrame;

constexpr std::pair<int, int> kRates[] = {{1, 1}, {2, 2}, {3, 3}, {4, 4}, {8, 8}, {4, 2}, {1, 5}, {13, 13}};

TestFrame frame_of_samples(int nx, int ny, bool motion = true, bool defocus = true) {
    TestFrame frame(64, 64, 1, motion, defocus);
    frame.context.samples_x = nx, frame.context.samples_y = ny;
    return frame;
}

template <class Pattern = IntervalPattern>
SampleTile tile_of(const TestFrame& frame, const PixelRect& pixels) {
    SampleTile tile;
    Pattern(frame.context).make_tile(pixels, tile);
    return tile;
}

void expect_within(const SampleTile& tile, size_t at, const TimeSpan& time, const LensBox& lens) {
    ASSERT_GE(tile.time[at], time.min);
    ASSERT_LE(tile.time[at], time.max);
    ASSERT_GE(tile.lens_u[at], lens.min_u);
    ASSERT_LE(tile.lens_u[at], lens.max_u);
    ASSERT_GE(tile.lens_v[at], lens.min_v);
    ASSERT_LE(tile.lens_v[at], lens.max_v);
}

TEST(IntervalPattern, BoundsHoldForSamplesOfEveryPixel) {
    for (const auto& [nx, ny] : kRates) {
        const TestFrame frame = frame_of_samples(nx, ny);
        const IntervalPattern pattern(frame.context);
        const SampleTile tile = tile_of(frame, {-20, -20, 40, 40});
        for (size_t i = 0; i < tile.size(); ++i) {
            const int s = static_cast<int>(i) % tile.samples_per_pixel;
            expect_within(tile, i, pattern.time_bounds(s), pattern.lens_bounds(s));
        }
    }
}

TEST(StratifiedPattern, BoundsHoldForSamplesOfEveryPixel) {
    for (const auto& [nx, ny] : kRates) {
        const TestFrame frame = frame_of_samples(nx, ny);
        const StratifiedPattern pattern(frame.context);
        const SampleTile tile = tile_of<StratifiedPattern>(frame, {-20, -20, 40, 40});
        for (size_t i = 0; i < tile.size(); ++i) {
            const int s = static_cast<int>(i) % tile.samples_per_pixel,
                      pixel = static_cast<int>(i) / tile.samples_per_pixel;
            const uint32_t shift = pattern.time_shift(pixel % 60 - 20, pixel / 60 - 20);
            expect_within(tile, i, pattern.time_bounds(s, shift), pattern.lens_bounds(s));
        }
    }
}

/// The box of each region against a fine net over it, edges included: it holds all of it and no more.
TEST(LensRegion, IsBoundedTightly) {
    for (const auto& [nx, ny] : kRates)
        for (int cell = 0; cell < nx * ny; ++cell) {
            const LensBox box = lens_region(static_cast<uint32_t>(cell), nx, ny);
            LensBox seen{2, 2, -2, -2};
            constexpr int kSteps = 64;
            for (int j = 0; j <= kSteps; ++j)
                for (int i = 0; i <= kSteps; ++i) {
                    const float u = (static_cast<float>(cell % nx) + static_cast<float>(i) / kSteps) /
                                    static_cast<float>(nx),
                                v = (static_cast<float>(cell / nx) + static_cast<float>(j) / kSteps) /
                                    static_cast<float>(ny);
                    const V2f p = disk_from_square(u, v);
                    seen = {std::min(seen.min_u, p.x), std::min(seen.min_v, p.y), std::max(seen.max_u, p.x),
                            std::max(seen.max_v, p.y)};
                }
            ASSERT_LE(box.min_u, seen.min_u);
            ASSERT_LE(box.min_v, seen.min_v);
            ASSERT_GE(box.max_u, seen.max_u);
            ASSERT_GE(box.max_v, seen.max_v);
            const float slack = 0.02f;  // of the net
            ASSERT_GT(box.min_u, seen.min_u - slack);
            ASSERT_GT(box.min_v, seen.min_v - slack);
            ASSERT_LT(box.max_u, seen.max_u + slack);
            ASSERT_LT(box.max_v, seen.max_v + slack);
        }
}

TEST(IntervalPattern, TimesAndPlacesAreStratifiedInEveryPixel) {
    for (const auto& [nx, ny] : kRates) {
        const SampleTile tile = tile_of(frame_of_samples(nx, ny), {-1, -2, 3, 2});
        const int count = nx * ny;
        ASSERT_EQ(tile.samples_per_pixel, count);
        for (int py = -2; py < 2; ++py)
            for (int px = -1; px < 3; ++px) {
                std::set<int> places, times;
                for (int i = 0; i < count; ++i) {
                    const size_t at = tile.first_of_pixel(px, py) + static_cast<size_t>(i);
                    const float fx = tile.x[at] - static_cast<float>(px),
                                fy = tile.y[at] - static_cast<float>(py);
                    places.insert(static_cast<int>(fy * static_cast<float>(ny)) * nx +
                                  static_cast<int>(fx * static_cast<float>(nx)));
                    times.insert(static_cast<int>(tile.time[at] * static_cast<float>(count)));
                }
                ASSERT_EQ(places.size(), static_cast<size_t>(count));
                ASSERT_EQ(times.size(), static_cast<size_t>(count));
            }
    }
}

/// Every sample has a lens region of its own: the boxes' middles are apart.
TEST(IntervalPattern, EverySampleHasItsOwnLensRegion) {
    const IntervalPattern pattern(frame_of_samples(8, 8).context);
    std::set<std::pair<float, float>> middles;
    for (int s = 0; s < 64; ++s) {
        const LensBox box = pattern.lens_bounds(s);
        middles.insert({box.min_u + box.max_u, box.min_v + box.max_v});
    }
    EXPECT_EQ(middles.size(), 64u);
}

TEST(IntervalPattern, SubpixelPlacesDifferFromPixelToPixel) {
    const SampleTile tile = tile_of(frame_of_samples(4, 4), {0, 0, 64, 64});
    std::vector<int> of_first(16);
    for (size_t pixel = 0; pixel < 64 * 64; ++pixel) {
        const float x = tile.x[pixel * 16] - static_cast<float>(pixel % 64),
                    y = tile.y[pixel * 16] - static_cast<float>(pixel / 64);
        ++of_first[static_cast<size_t>(static_cast<int>(y * 4) * 4 + static_cast<int>(x * 4))];
    }
    for (const int n : of_first) EXPECT_NEAR(n, 256, 80);  // five standard deviations
}

TEST(IntervalPattern, StaysInThePixelTheDiskAndTheShutter) {
    TestFrame frame = frame_of_samples(8, 8);
    frame.options.width = 20000, frame.update();
    for (const PixelRect& pixels : {PixelRect{-16, -16, 0, 0}, PixelRect{16384, 4096, 16400, 4112}}) {
        const SampleTile tile = tile_of(frame, pixels);
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

TEST(IntervalPattern, APixelsSamplesDoNotDependOnTheTile) {
    const TestFrame frame = frame_of_samples(3, 3);
    const SampleTile large = tile_of(frame, {-4, -4, 12, 12}), small = tile_of(frame, {5, -1, 7, 3});
    for (int py = -1; py < 3; ++py)
        for (int px = 5; px < 7; ++px)
            for (size_t i = 0; i < 9; ++i) {
                const size_t a = large.first_of_pixel(px, py) + i, b = small.first_of_pixel(px, py) + i;
                ASSERT_EQ(large.x[a], small.x[b]);
                ASSERT_EQ(large.lens_u[a], small.lens_u[b]);
                ASSERT_EQ(large.time[a], small.time[b]);
                ASSERT_EQ(large.rays[a].ux, small.rays[b].ux);
            }
}

TEST(IntervalPattern, RaysAreTheCameras) {
    const TestFrame frame = frame_of_samples(2, 2);
    const SampleTile tile = tile_of(frame, {3, 3, 5, 5});
    for (size_t i = 0; i < tile.size(); ++i) {
        const AxisRay ray =
            frame.context.camera.ray(tile.x[i], tile.y[i], tile.lens_u[i], tile.lens_v[i], tile.time[i]);
        ASSERT_EQ(tile.rays[i].ox, ray.ox);
        ASSERT_EQ(tile.rays[i].uy, ray.uy);
        ASSERT_EQ(tile.rays[i].time, tile.time[i]);
    }
}

TEST(IntervalPattern, WithoutMotionOrLensTheseAreZero) {
    const TestFrame frame = frame_of_samples(4, 4, false, false);
    const IntervalPattern pattern(frame.context);
    const SampleTile tile = tile_of(frame, {0, 0, 8, 8});
    for (size_t i = 0; i < tile.size(); ++i) {
        ASSERT_EQ(tile.time[i], 0);
        ASSERT_EQ(tile.lens_u[i], 0);
        ASSERT_EQ(tile.lens_v[i], 0);
    }
    EXPECT_EQ(pattern.time_bounds(7), TimeSpan{});
    EXPECT_EQ(pattern.lens_bounds(7), LensBox{});
}

TEST(IntervalPattern, SeedsGiveOtherSamples) {
    TestFrame frame = frame_of_samples(4, 4);
    const SampleTile first = tile_of(frame, {0, 0, 4, 4});
    frame.context.seed = 8;
    const SampleTile second = tile_of(frame, {0, 0, 4, 4});
    size_t equal = 0;
    for (size_t i = 0; i < first.size(); ++i) equal += first.x[i] == second.x[i];
    EXPECT_LT(equal, first.size() / 20);
}

}  // namespace
}  // namespace trapeze
