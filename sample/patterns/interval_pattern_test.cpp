#include "sample/patterns/interval_pattern.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "sample/frame_harness.h"
#include "sample/patterns/stratified_pattern.h"

namespace trapeze {
namespace {

using testing::frame_of_samples;
using testing::TestFrame;

constexpr std::pair<int, int> kIntervalRates[] = {{1, 1}, {2, 2}, {3, 3}, {4, 4},
                                                  {8, 8}, {4, 2}, {1, 5}, {13, 13}};

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
    for (const auto& [nx, ny] : kIntervalRates) {
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
    for (const auto& [nx, ny] : kIntervalRates) {
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
    for (const auto& [nx, ny] : kIntervalRates)
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
    for (const auto& [nx, ny] : kIntervalRates) {
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

TEST(IntervalPattern, WithoutMotionOrLensBoundsAreZero) {
    const IntervalPattern pattern(frame_of_samples(4, 4, false, false).context);
    EXPECT_EQ(pattern.time_bounds(7), TimeSpan{});
    EXPECT_EQ(pattern.lens_bounds(7), LensBox{});
}

}  // namespace
}  // namespace trapeze
