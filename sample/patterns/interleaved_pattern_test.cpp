#include "sample/patterns/interleaved_pattern.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "sample/frame_harness.h"

namespace trapeze {
namespace {

using testing::frame_of_samples;
using testing::square_from_disk;
using testing::TestFrame;

struct Rate {
    int nx, ny, side;
};
constexpr Rate kRates[] = {{1, 1, 1}, {1, 1, 2}, {1, 1, 4}, {2, 2, 2}, {3, 3, 1},  {4, 4, 2},
                           {8, 8, 2}, {8, 8, 4}, {4, 2, 2}, {1, 5, 4}, {13, 13, 4}};

SampleTile tile_of(const InterleavedPattern& pattern, const PixelRect& pixels) {
    SampleTile tile;
    pattern.make_tile(pixels, tile);
    return tile;
}

/// Which of nx * ny regions of the unit square.
int region(float x, float y, int nx, int ny) {
    return static_cast<int>(y * static_cast<float>(ny)) * nx + static_cast<int>(x * static_cast<float>(nx));
}

struct Regions {
    std::set<int> places, lens, times;

    void add(const SampleTuple& tuple, int nx, int ny) {
        const V2f on_lens = square_from_disk(tuple.lens_u, tuple.lens_v);
        places.insert(region(tuple.x, tuple.y, nx, ny));
        lens.insert(region(on_lens.x, on_lens.y, nx, ny));
        times.insert(static_cast<int>(tuple.time * static_cast<float>(nx * ny)));
    }
    void expect_all(int count) const {
        ASSERT_EQ(places.size(), static_cast<size_t>(count));
        ASSERT_EQ(lens.size(), static_cast<size_t>(count));
        ASSERT_EQ(times.size(), static_cast<size_t>(count));
        for (const auto* all : {&places, &lens, &times}) {
            ASSERT_GE(*all->begin(), 0);
            ASSERT_LT(*all->rbegin(), count);
        }
    }
};

TEST(InterleavedPattern, GroupsAndAllTuplesAreStratified) {
    for (const auto& [nx, ny, side] : kRates) {
        const InterleavedPattern pattern(frame_of_samples(nx, ny).context, side);
        ASSERT_EQ(pattern.tuple_count(), nx * ny * side * side);
        Regions all;
        for (int group = 0; group < side * side; ++group) {
            Regions of_group;
            for (int s = 0; s < nx * ny; ++s) {
                const SampleTuple& tuple = pattern.tuple(group * nx * ny + s);
                of_group.add(tuple, nx, ny);
                all.add(tuple, nx * side, ny * side);
            }
            of_group.expect_all(nx * ny);
        }
        all.expect_all(pattern.tuple_count());
    }
}

/// Projections on an axis are as fine as the number of tuples allows.
TEST(InterleavedPattern, NoTwoTuplesShareACoordinate) {
    const InterleavedPattern pattern(frame_of_samples(8, 8).context, 2);
    std::set<int> xs, ys;
    for (int t = 0; t < 256; ++t) {
        xs.insert(static_cast<int>(pattern.tuple(t).x * 256));
        ys.insert(static_cast<int>(pattern.tuple(t).y * 256));
    }
    EXPECT_EQ(xs.size(), 256u);
    EXPECT_EQ(ys.size(), 256u);
}

TEST(InterleavedPattern, PixelsHaveTheTuplesOfTheirGroup) {
    for (const auto& [nx, ny, side] : kRates) {
        const InterleavedPattern pattern(frame_of_samples(nx, ny).context, side);
        const SampleTile tile = tile_of(pattern, {-7, -5, 14, 12});
        for (int ty = -1; ty < 2; ++ty)
            for (int tx = -1; tx < 3; ++tx) {
                const InterleavedPattern::Groups groups = pattern.groups_of_tile(tx, ty);
                std::set<int> seen;
                for (int i = 0; i < side * side; ++i) {
                    const int px = tx * side + i % side, py = ty * side + i / side;
                    seen.insert(groups[static_cast<size_t>(i)]);
                    for (int s = 0; s < nx * ny; ++s) {
                        const SampleTuple& tuple =
                            pattern.tuple(groups[static_cast<size_t>(i)] * nx * ny + s);
                        const size_t at = tile.first_of_pixel(px, py) + static_cast<size_t>(s);
                        ASSERT_EQ(tile.x[at], InterleavedPattern::coordinate(px, tuple.x));
                        ASSERT_EQ(tile.y[at], InterleavedPattern::coordinate(py, tuple.y));
                        ASSERT_EQ(tile.lens_u[at], tuple.lens_u);
                        ASSERT_EQ(tile.lens_v[at], tuple.lens_v);
                        ASSERT_EQ(tile.time[at], tuple.time);
                    }
                }
                ASSERT_EQ(seen.size(), static_cast<size_t>(side * side));
                ASSERT_EQ(*seen.begin(), 0);
                ASSERT_EQ(*seen.rbegin(), side * side - 1);
            }
    }
}

/// Every group is at every place of the tile about equally often.
TEST(InterleavedPattern, AssignmentsDifferFromTileToTile) {
    const InterleavedPattern pattern(frame_of_samples(1, 1).context, 4);
    std::vector<int> seen(256);
    for (int ty = -32; ty < 32; ++ty)
        for (int tx = -32; tx < 32; ++tx) {
            const InterleavedPattern::Groups groups = pattern.groups_of_tile(tx, ty);
            for (size_t i = 0; i < 16; ++i) ++seen[i * 16 + groups[i]];
        }
    for (const int n : seen) EXPECT_NEAR(n, 256, 80);  // five standard deviations
}

TEST(InterleavedPattern, IsChosenByNameWithItsSide) {
    std::string error;
    const TestFrame frame = frame_of_samples(2, 2);
    for (const int side : {1, 2, 4}) {
        const auto spec = parse_pattern("interleaved:k=" + std::to_string(side), &error);
        ASSERT_TRUE(spec) << error;
        const auto pattern = make_sample_pattern(frame.context, *spec);
        EXPECT_EQ(dynamic_cast<const InterleavedPattern&>(*pattern).side(), side);
    }
    EXPECT_FALSE(parse_pattern("interleaved:k=3", &error));
}

}  // namespace
}  // namespace trapeze
