#include "sample/raytrace/blur_map.h"

#include <gtest/gtest.h>

#include <numeric>

#include "sample/raytrace/bundle_order.h"
#include "sample/raytrace/sample_order.h"

namespace trapeze {
namespace {

BlurMoments moments(float lens, float motion, float grid) {
    BlurMoments m;
    m.add(lens, motion, grid);
    return m;
}

TEST(BestOrder, SortsByWhatBlurs) {
    const BundleOrder sharp = best_order(moments(0, 0, 10), 64, {true, true});
    EXPECT_EQ(sharp.lens_bits, 0);
    EXPECT_EQ(sharp.time_bits, 0);
    const BundleOrder soft = best_order(moments(40, 0, 10), 64, {true, true});
    EXPECT_GE(soft.lens_bits, 1);
    EXPECT_EQ(soft.time_bits, 0);
    const BundleOrder smeared = best_order(moments(0, 80, 10), 64, {true, true});
    EXPECT_EQ(smeared.lens_bits, 0);
    EXPECT_GE(smeared.time_bits, 2);
    const BundleOrder both = best_order(moments(40, 80, 10), 64, {true, true});
    EXPECT_GE(both.lens_bits, 1);
    EXPECT_GE(both.time_bits, 1);
}

TEST(BestOrder, LeavesOutWhatThereIsNot) {
    const BundleOrder order = best_order(moments(40, 80, 10), 64, {false, false});
    EXPECT_EQ(order.lens_bits, 0);
    EXPECT_EQ(order.time_bits, 0);
}

TEST(BlurMap, WhereThereAreNoGridsOrNoPixelsItHasNothing) {
    Camera camera;
    camera.width = 0, camera.height = 0;
    const BlurMap map(camera, Grids{});
    EXPECT_EQ(map.at({-20, -20, -4, -4}).one, 0);
    EXPECT_EQ(map.at({5000, 5000, 5016, 5016}).one, 0);
}

TEST(SampleOrder, IsAPermutationRememberedWhileItServes) {
    Camera camera;
    camera.width = camera.height = 64, camera.lens_radius = 1;
    const Grids grids;
    const SampleOrder still(camera, grids, false), other(camera, grids, false);
    SampleTile tile;
    tile.pixels = {16, 16, 32, 32}, tile.samples_per_pixel = 4;
    tile.resize(16 * 16 * 4);
    SampleOrderScratch scratch;
    const auto first = still.of(tile, scratch);
    std::vector<uint32_t> sorted(first.begin(), first.end());
    std::sort(sorted.begin(), sorted.end());
    std::vector<uint32_t> all(tile.size());
    std::iota(all.begin(), all.end(), 0u);
    EXPECT_EQ(sorted, all);
    const uint32_t* const made = first.data();
    tile.pixels = {32, 16, 48, 32};
    EXPECT_EQ(still.of(tile, scratch).data(), made);
    tile.pixels = {0, 0, 8, 16}, tile.resize(8 * 16 * 4);
    EXPECT_EQ(still.of(tile, scratch).size(), tile.size());
    EXPECT_EQ(scratch.known.size(), 2u);
    other.of(tile, scratch);
    EXPECT_EQ(scratch.known.size(), 1u) << "another method's orders are of no use";
}

}  // namespace
}  // namespace trapeze
