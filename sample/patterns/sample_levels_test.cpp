#include "sample/patterns/sample_levels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "core/random.h"
#include "sample/frame_harness.h"
#include "sample/patterns/stratified_pattern.h"

namespace trapeze {
namespace {

using testing::frame_of_samples;
using testing::TestFrame;

/// A frame with lens and motion whose pixels may stop below the top level.
TestFrame frame_of_levels(int nx, int ny, int levels) {
    TestFrame frame = frame_of_samples(nx, ny);
    frame.context.sample_levels = levels;
    return frame;
}

/// Levels of random strata.
struct RandomStrata {
    std::vector<uint32_t> lens_of, time_of;
    PixelStrata strata;

    RandomStrata(int nx, int ny, uint32_t seed)
        : lens_of(hashed_permutation(static_cast<size_t>(nx) * ny, seed)),
          time_of(hashed_permutation(static_cast<size_t>(nx) * ny, seed + 1)),
          strata{nx, ny, lens_of, time_of} {}
};

struct Shape {
    int nx, ny, levels;
};
constexpr Shape kTileShapes[] = {{4, 4, 2}, {8, 8, 2}, {8, 8, 3}, {16, 16, 3}, {8, 4, 2}, {12, 6, 2}};

std::vector<uint32_t> samples_of(const SampleLevels& levels, size_t variant, int level) {
    std::vector<uint32_t> samples;
    for (int l = 0; l <= level; ++l) {
        const auto added = levels.added(variant, l);
        samples.insert(samples.end(), added.begin(), added.end());
    }
    return samples;
}

TEST(SampleLevels, HaveOneSampleInEachCellOfThePixelAndAllAtTheTop) {
    for (const auto& [nx, ny, count] : kTileShapes) {
        const RandomStrata random(nx, ny, 7);
        const SampleLevels levels(random.strata, count, 3);
        for (size_t variant = 0; variant < levels.variants(); ++variant)
            for (int level = 0; level < count; ++level) {
                const int side = 1 << (levels.top() - level);
                const std::vector<uint32_t> samples = samples_of(levels, variant, level);
                ASSERT_EQ(samples.size(), levels.samples(level));
                std::set<std::pair<int, int>> cells;
                for (const uint32_t sample : samples) {
                    const int at = static_cast<int>(sample);
                    ASSERT_LT(at, nx * ny);
                    EXPECT_TRUE(cells.insert({at % nx / side, at / nx / side}).second) << nx << " " << level;
                }
                EXPECT_TRUE(std::ranges::is_sorted(levels.added(variant, level)));
            }
    }
}

/// Else some regions would never be looked at where pixels stop early.
TEST(SampleLevels, HaveEachRegionInEquallyManyVariants) {
    for (const auto& [nx, ny, count] : kTileShapes) {
        const RandomStrata random(nx, ny, 11);
        const SampleLevels levels(random.strata, count, 5);
        for (int level = 0; level < count; ++level) {
            std::vector<size_t> times(static_cast<size_t>(nx) * ny);
            for (size_t variant = 0; variant < levels.variants(); ++variant)
                for (const uint32_t sample : samples_of(levels, variant, level)) ++times[sample];
            for (const size_t n : times) EXPECT_EQ(n, levels.variants() >> 2 * (levels.top() - level));
        }
    }
}

/// First levels spread over lens and shutter nearly as a pattern of as many samples would: of cells, and of
/// parts, as many as there are samples, they leave out few. Drawn blindly they leave out more than a third
/// (1 / e).
TEST(SampleLevels, SpreadOverLensAndShutter) {
    for (const auto& [n, count] : {std::pair{8, 2}, {16, 2}, {16, 3}}) {
        const TestFrame frame = frame_of_levels(n, n, count);
        const StratifiedPattern pattern(frame.context);
        const SampleLevels& levels = *pattern.levels();
        const auto nx = static_cast<uint32_t>(n), side = 1u << levels.top();
        size_t lens_cells = 0, time_parts = 0;
        for (size_t variant = 0; variant < levels.variants(); ++variant) {
            std::set<uint32_t> lens, time;
            for (const uint32_t sample : levels.added(variant, 0)) {
                const uint32_t region = pattern.lens_region_of(static_cast<int>(sample));
                lens.insert(region / nx / side * nx + region % nx / side);
                time.insert(pattern.time_region_of(static_cast<int>(sample), 0) / (side * side));
            }
            lens_cells += lens.size(), time_parts += time.size();
        }
        const auto all = static_cast<double>(n * n);
        EXPECT_GE(static_cast<double>(lens_cells), .8 * all) << n;
        EXPECT_GE(static_cast<double>(time_parts), .8 * all) << n;
    }
}

TEST(SampleLevels, KnowNeighbours) {
    const TestFrame frame = frame_of_levels(8, 8, 2);
    const StratifiedPattern pattern(frame.context);
    const SampleLevels& levels = *pattern.levels();
    for (size_t variant = 0; variant < levels.variants(); ++variant) {
        const std::span<const uint32_t> samples = levels.added(variant, 0);
        const SampleLevels::Neighbours& near = levels.neighbours(variant);
        EXPECT_EQ(near.pixel.size(), 24u);  // 4 rows of 3, 4 columns of 3
        EXPECT_EQ(near.time.size(), 16u);
        EXPECT_GE(near.lens.size(), 8u);
        for (const auto& [a, b] : near.pixel) {
            const int x = static_cast<int>(samples[a] % 8 / 2) - static_cast<int>(samples[b] % 8 / 2),
                      y = static_cast<int>(samples[a] / 16) - static_cast<int>(samples[b] / 16);
            EXPECT_EQ(x * x + y * y, 1);
        }
        for (const auto& [a, b] : near.lens) {
            EXPECT_NE(a, b);
            EXPECT_LT(std::max(a, b), samples.size());
        }
    }
}

/// Listed pixels have samples of the whole pattern, to the bit, each once over all levels.
TEST(SampleLevels, AreSamplesOfTheWholePattern) {
    for (const auto& [nx, ny, count] : kTileShapes) {
        const TestFrame frame = frame_of_levels(nx, ny, count);
        const StratifiedPattern pattern(frame.context);
        const PixelRect pixels{-3, 5, 13, 21};
        SampleTile whole, some;
        pattern.make_tile(pixels, whole);
        const std::vector<PixelPlace> listed{{2, 7}, {-3, 5}, {12, 20}};
        std::map<std::pair<int, int>, std::set<uint32_t>> seen;
        for (const auto& [from, to] : {std::pair{0, 0}, {1, count - 1}}) {
            pattern.make_levels(pixels, listed, from, to, some);
            ASSERT_EQ(some.size(), listed.size() * static_cast<size_t>(some.samples_per_pixel));
            for (size_t s = 0; s < some.size(); ++s) {
                const PixelPlace pixel = some.pixel_of(s);
                EXPECT_EQ(pixel, listed[s / static_cast<size_t>(some.samples_per_pixel)]);
                const size_t at = whole.first_of_pixel(pixel.x, pixel.y) + some.number_in_pixel(s);
                const auto number = static_cast<uint32_t>(some.number_in_pixel(s));
                EXPECT_TRUE((seen[std::pair(pixel.x, pixel.y)].insert(number).second));
                EXPECT_EQ(some.x[s], whole.x[at]);
                EXPECT_EQ(some.y[s], whole.y[at]);
                EXPECT_EQ(some.lens_u[s], whole.lens_u[at]);
                EXPECT_EQ(some.lens_v[s], whole.lens_v[at]);
                EXPECT_EQ(some.time[s], whole.time[at]);
                EXPECT_EQ(some.rays[s].ux, whole.rays[at].ux);
                EXPECT_EQ(some.rays[s].oy, whole.rays[at].oy);
            }
        }
        EXPECT_EQ(seen.size(), 3u);
        for (const auto& [pixel, numbers] : seen) EXPECT_EQ(numbers.size(), static_cast<size_t>(nx) * ny);
    }
}

TEST(SampleLevels, AreNotThereUnlessAskedFor) {
    EXPECT_EQ(StratifiedPattern(frame_of_samples(8, 8).context).levels(), nullptr);
}

}  // namespace
}  // namespace trapeze
