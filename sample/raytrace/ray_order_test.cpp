#include "sample/raytrace/ray_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "sample/frame_harness.h"
#include "sample/patterns/stratified_pattern.h"

namespace trapeze {
namespace {

using testing::TestFrame;

SampleTile tile_in_order(const TestFrame& frame, const PixelRect& pixels) {
    SampleTile tile;
    StratifiedPattern(frame.context).make_tile(pixels, tile);
    return tile;
}

bool is_permutation_of_all(std::vector<uint32_t> order, size_t count) {
    std::sort(order.begin(), order.end());
    std::vector<uint32_t> all(count);
    std::iota(all.begin(), all.end(), 0u);
    return order == all;
}

TEST(RayOrder, IsAPermutationForAnyTileAndEffects) {
    for (const bool motion : {false, true})
        for (const bool defocus : {false, true})
            for (const PixelRect& pixels : {PixelRect{0, 0, 16, 16}, PixelRect{-2, 3, 5, 4},
                                            PixelRect{0, 0, 1, 1}, PixelRect{5, 5, 22, 7}}) {
                const TestFrame frame(64, 64, 3, motion, defocus);
                const SampleTile tile = tile_in_order(frame, pixels);
                RayOrder result;
                order_rays(tile, {motion, defocus}, result);
                EXPECT_TRUE(is_permutation_of_all(result.order, tile.size()));
            }
}

TEST(RayOrder, OfNoPixelsIsEmpty) {
    RayOrder result;
    result.order = {1, 2};
    order_rays(SampleTile{}, {true, true}, result);
    EXPECT_TRUE(result.order.empty());
}

TEST(RayOrder, PixelsFollowTheZCurve) {
    const TestFrame frame(64, 64, 1, false, false);
    const SampleTile tile = tile_in_order(frame, {0, 0, 16, 16});
    RayOrder result;
    order_rays(tile, {false, false}, result);
    const std::vector<uint32_t> first(result.order.begin(), result.order.begin() + 8);
    EXPECT_EQ(first, (std::vector<uint32_t>{0, 1, 16, 17, 2, 3, 18, 19}));
}

TEST(RayOrder, TimeComesBeforeThePixelAndIsStable) {
    const TestFrame frame(64, 64, 3, true, false);
    const SampleTile tile = tile_in_order(frame, {0, 0, 16, 16});
    RayOrder still, moving;
    order_rays(tile, {false, false}, still);
    order_rays(tile, {true, false}, moving);
    std::vector<uint32_t> expected = still.order;
    std::stable_sort(expected.begin(), expected.end(), [&](uint32_t a, uint32_t b) {
        return static_cast<int>(tile.time[a] * 16) < static_cast<int>(tile.time[b] * 16);
    });
    EXPECT_EQ(moving.order, expected);
}

TEST(RayOrder, DirectionComesBeforeTime) {
    const TestFrame frame(64, 64, 4, true, true);
    const SampleTile tile = tile_in_order(frame, {0, 0, 16, 16});
    RayOrder by_time, by_both;
    order_rays(tile, {true, false}, by_time);
    order_rays(tile, {true, true}, by_both);
    const auto [low, high] = std::minmax_element(
        tile.rays.begin(), tile.rays.end(), [](const AxisRay& a, const AxisRay& b) { return a.uy < b.uy; });
    const float cell = (high->uy - low->uy) / 16;
    // Along the order y of the direction only falls back within a cell.
    float highest = low->uy;
    for (const uint32_t sample : by_both.order) {
        ASSERT_GE(tile.rays[sample].uy, highest - 1.001f * cell);
        highest = std::max(highest, tile.rays[sample].uy);
    }
    // Where direction is one cell, the order by time holds.
    SampleTile parallel = tile;
    for (AxisRay& ray : parallel.rays) ray.ux = ray.uy = 0;
    order_rays(parallel, {true, true}, by_both);
    EXPECT_EQ(by_both.order, by_time.order);
}

}  // namespace
}  // namespace trapeze
