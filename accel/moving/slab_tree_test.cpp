/// Trees bounded by planes of fixed directions find what testing everything finds, and their bounds are as
/// close as their authors say.
#include "accel/moving/slab_tree.h"

#include <gtest/gtest.h>

#include "accel/moving/moving_tree.h"
#include "accel/moving_harness.h"

namespace trapeze {
namespace {

using testing::add_all_kinds;
using testing::add_strips;
using testing::differing_rays;
using testing::expect_same_layers;
using testing::GridMaker;
using testing::Noise;
using testing::stats_of_rays;
using Planes = SlabTreeOptions::Planes;

TEST(SlabTree, FindsWhatTestingEverythingFinds) {
    Noise noise;
    GridMaker maker;
    add_all_kinds(maker, noise);
    for (const Planes planes : {Planes::Moving, Planes::SpaceTime})
        for (const int leaf : {2, 8, 32}) {
            const SlabTree tree(maker.grids(), {planes, leaf});
            EXPECT_EQ(differing_rays(maker, tree, 800), 0) << static_cast<int>(planes) << ' ' << leaf;
        }
}

TEST(SlabTree, ShowsAllLayers) {
    Noise noise;
    GridMaker maker;
    add_all_kinds(maker, noise);
    const MovingTree plain(maker.grids());
    for (const Planes planes : {Planes::Moving, Planes::SpaceTime})
        expect_same_layers(maker, plain, SlabTree(maker.grids(), {planes, 8}), noise);
}

TEST(SlabTree, MayBeEmptyOrALeaf) {
    GridMaker maker;
    for (const Planes planes : {Planes::Moving, Planes::SpaceTime}) {
        EXPECT_EQ(SlabTree(maker.grids(), {planes, 8}).stats().tree_nodes, 0u);
        EXPECT_EQ(stats_of_rays(GridMaker(), SlabTree(GridMaker().grids(), {planes, 8}), 0).leaves_visited,
                  0u);
    }
    maker.add(1, 1, 2,
              [](int i, int j, float t) { return V3f(static_cast<float>(i), static_cast<float>(j), 3 + t); });
    for (const Planes planes : {Planes::Moving, Planes::SpaceTime})
        EXPECT_EQ(SlabTree(maker.grids(), {planes, 8}).stats().tree_nodes, 1u);
}

/// Diagonals cut the corners of boxes: of what stands still anywhere, rays look at less [Kay86].
TEST(SlabTree, LooksAtLessThanBoxesDo) {
    Noise noise;
    GridMaker maker;
    add_strips(maker, 2000, 2, noise);
    const uint64_t boxes = stats_of_rays(maker, MovingTree(maker.grids()), 2000).predicate_tests;
    const uint64_t planes = stats_of_rays(maker, SlabTree(maker.grids()), 2000).predicate_tests;
    EXPECT_LT(planes, boxes * 95 / 100);
    EXPECT_GT(planes, boxes / 4);
}

/// Bounds for all times are the larger the farther things go, and lean with what goes one way: things that
/// fly together cost hardly more than still ones, things that fly asunder far more.
TEST(SlabTree, OfSpaceTimeLeansWithWhatFliesTogether) {
    const auto tests_of = [](float speed, bool together, Planes planes) {
        Noise noise;
        GridMaker maker;
        for (int n = 0; n < 3000; ++n) {
            const V3f at = noise.point(3), along = noise.point(.2f), across = noise.point(.2f);
            const V3f way = V3f(together || n % 2 == 0 ? speed : -speed, 0, 0);
            maker.add(1, 1, 2, [&](int i, int j, float t) {
                return at + along * static_cast<float>(i) + across * static_cast<float>(j) + way * t;
            });
        }
        return static_cast<double>(
            stats_of_rays(maker, SlabTree(maker.grids(), {planes, 8}), 2000).predicate_tests);
    };
    const double still = tests_of(0, true, Planes::SpaceTime);
    EXPECT_LT(tests_of(2, true, Planes::SpaceTime), 1.5 * still);
    EXPECT_GT(tests_of(2, false, Planes::SpaceTime), 3 * still);
    EXPECT_LT(tests_of(2, false, Planes::Moving), 3 * still);
}

}  // namespace
}  // namespace trapeze
