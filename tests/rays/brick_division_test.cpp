/// Bricks into which subpatches are put together.
#include "pipeline/rays/brick_division.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

namespace trapeze {
namespace {

RunExtent subpatch(uint32_t number, const V3f& middle, uint32_t bytes) {
    RunExtent known{{number, 1}, bytes, {}};
    for (KeyBounds& bounds : known.extent.box.at)
        for (int k = 0; k < 3; ++k) bounds.low[k] = middle[k] - .05f, bounds.high[k] = middle[k] + .05f;
    known.extent.absolute_max = 1;
    return known;
}

std::vector<RunExtent> scattered(uint32_t count) {
    std::minstd_rand bits;
    std::uniform_real_distribution<float> number(-1, 1);
    std::vector<RunExtent> all;
    for (uint32_t i = 0; i < count; ++i)
        all.push_back(subpatch(i, V3f(number(bits), number(bits), number(bits)), 100 + i % 7 * 50));
    return all;
}

double volume(const GridExtent& extent) {
    const KeyBounds& box = extent.box.at[0];
    double product = 1;
    for (int k = 0; k < 3; ++k) product *= double(box.high[k]) - box.low[k];
    return product;
}

TEST(BrickDivision, EachSubpatchIsInOneBrickThatHoldsItAndIsNotTooLarge) {
    std::vector<RunExtent> all = scattered(3000);
    all[5].bytes = 100000;  // more than a brick
    all[7].extent.absolute_max = all[9].extent.absolute_max = std::numeric_limits<float>::infinity();
    const BrickDivision bricks = divide_into_bricks(all, 10000);
    ASSERT_EQ(bricks.first.size(), bricks.extents.size() + 1);
    ASSERT_EQ(bricks.runs.size(), all.size());
    std::vector<int> times(all.size());
    for (size_t b = 0; b < bricks.extents.size(); ++b) {
        size_t bytes = 0;
        const uint32_t first = bricks.first[b], end = bricks.first[b + 1];
        ASSERT_LT(first, end);
        for (uint32_t i = first; i < end; ++i) {
            const RunExtent& held = all[bricks.runs[i].first];
            ++times[held.run.first], bytes += held.bytes;
            EXPECT_TRUE(i == first || bricks.runs[i - 1].first < bricks.runs[i].first);
            EXPECT_EQ(std::isfinite(bricks.extents[b].absolute_max), std::isfinite(held.extent.absolute_max));
            for (int k = 0; k < 3; ++k) {
                EXPECT_LE(bricks.extents[b].box.at[1].low[k], held.extent.box.at[1].low[k]);
                EXPECT_GE(bricks.extents[b].box.at[1].high[k], held.extent.box.at[1].high[k]);
            }
        }
        EXPECT_TRUE(bytes <= 10000 || end - first == 1);
    }
    EXPECT_EQ(std::ranges::count(times, 1), static_cast<std::ptrdiff_t>(all.size()));
}

/// Things far away take nothing from how finely things nearby are told apart.
TEST(BrickDivision, BricksAreCompactWhateverElseThereIs) {
    std::vector<RunExtent> all = scattered(4000);
    for (uint32_t i = 0; i < 100; ++i)
        all.push_back(subpatch(4000 + i, V3f(1e6f * static_cast<float>(i % 3), 1e6f, 1e5f), 200));
    const BrickDivision bricks = divide_into_bricks(all, 10000);
    double near = 0;
    for (const GridExtent& extent : bricks.extents)
        if (extent.box.at[0].high[1] < 2) near += volume(extent);
    EXPECT_LT(near, 3 * 8.0) << "they overlap little: all of them fill a cube of 2";
    EXPECT_LT(bricks.extents.size(), 250u) << "about 40 of them fill a brick";
}

TEST(BrickDivision, TheOrderOfSubpatchesChangesNothing) {
    std::vector<RunExtent> all = scattered(2000);
    const BrickDivision bricks = divide_into_bricks(all, 5000);
    std::shuffle(all.begin(), all.end(), std::minstd_rand());
    const BrickDivision again = divide_into_bricks(all, 5000);
    std::vector<std::vector<uint32_t>> parts[2];
    for (const BrickDivision* division : {&bricks, &again}) {
        auto& part = parts[division == &again];
        for (size_t b = 0; b + 1 < division->first.size(); ++b)
            for (uint32_t i = division->first[b], first = i; i < division->first[b + 1]; ++i) {
                if (i == first) part.emplace_back();
                part.back().push_back(division->runs[i].first);
            }
        std::ranges::sort(part);
    }
    EXPECT_EQ(parts[0], parts[1]);
}

}  // namespace
}  // namespace trapeze
