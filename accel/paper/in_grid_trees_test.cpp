/// The implicit trees inside grids: their numbers of nodes follow from shapes alone; and what summaries say
/// of grids.
#include "accel/paper/in_grid_trees.h"

#include <gtest/gtest.h>

#include <random>

#include "core/grids_harness.h"

namespace trapeze {
namespace {

/// Inner nodes of a block's tree, counted one by one; `deepest`: the depth of the deepest leaf.
uint32_t counted(const GridBlock& block, int leaf_below, int depth, int& deepest) {
    deepest = std::max(deepest, depth);
    if (block.count() < leaf_below) return 0;
    const BlockHalves parts = halves(block);
    EXPECT_EQ(parts.low.count() + parts.high.count(), block.count());
    return 1 + counted(parts.low, leaf_below, depth + 1, deepest) +
           counted(parts.high, leaf_below, depth + 1, deepest);
}

TEST(InGridTrees, TopologyFollowsFromTheShape) {
    for (const int leaf_below : {4, 8, 16, 32}) {
        const ParametricSplits splits(leaf_below);
        for (int nu = 1; nu <= kMaxGridSide; ++nu)
            for (int nv = 1; nv <= kMaxGridSide; ++nv) {
                const GridBlock block{0, 0, static_cast<uint8_t>(nu), static_cast<uint8_t>(nv)};
                int deepest = 0;
                EXPECT_EQ(counted(block, leaf_below, 0, deepest), splits.inner_nodes(block));
                EXPECT_LT(deepest + 1, InGridTree::kStackSize);
            }
    }
    EXPECT_EQ(ParametricSplits(4).inner_nodes({0, 0, 16, 16}), 127u);
    EXPECT_EQ(ParametricSplits(8).inner_nodes({0, 0, 16, 16}), 63u);
    EXPECT_EQ(ParametricSplits(32).inner_nodes({0, 0, 16, 16}), 15u);
}

TEST(InGridTrees, SplitsTheLongerSideInTheMiddle) {
    const BlockHalves wide = halves({2, 3, 6, 4}), tall = halves({2, 3, 3, 9});
    EXPECT_EQ(wide.low.nu, 3);
    EXPECT_EQ(wide.high.u, 5);
    EXPECT_EQ(wide.high.nv, 4);
    EXPECT_EQ(tall.low.nv, 4);
    EXPECT_EQ(tall.high.v, 7);
    EXPECT_EQ(tall.high.nv, 5);
}

TEST(GridSummary, OrientationIsThatOfAveragedEdges) {
    const Axes turned = axes_of(V3d(1, 2, 0.5), V3d(-2, 1, 1));
    testing::GridMaker maker;
    const Grid& grid = maker.add(8, 4, 2, [&](int i, int j, float t) {
        return turned.axis[0] * (2.0f * static_cast<float>(i)) + turned.axis[1] * static_cast<float>(j) +
               V3f(0, 5 * t, 0);
    });
    const GridSummary summary = summarise(grid);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(summary.axes.axis[k].dot(turned.axis[k]), 1, 1e-5);
    EXPECT_EQ(summary.weight, 32u);
    EXPECT_NEAR(std::abs(summary.main_direction.dot(turned.axis[2])), 1, 1e-5);
    EXPECT_GE(summary.quad_extent, 2 * std::abs(turned.axis[0].y));
}

TEST(GridSummary, ACurveIsOrientedAlongItself) {
    testing::GridMaker maker;
    const Grid& ribbon = maker.add(1, 12, 1, [](int i, int j, float) {
        return V3f(0.01f * static_cast<float>(i), 0.1f * static_cast<float>(j), 0.1f * static_cast<float>(j));
    });
    EXPECT_NEAR(std::abs(summarise(ribbon).main_direction.dot(V3f(0, 1, 1).normalized())), 1, 1e-3);
}

TEST(GridSummary, WhatMayOverflowHasNoBound) {
    testing::GridMaker maker;
    const Grid& huge =
        maker.add(1, 1, 1, [](int i, int, float) { return V3f(1e20f * static_cast<float>(i), 0, 1); });
    EXPECT_EQ(summarise(huge).absolute_max, std::numeric_limits<float>::infinity());
}

}  // namespace
}  // namespace trapeze
