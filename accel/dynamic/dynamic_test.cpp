/// Structures that are updated from frame to frame: after every frame rays see in them what testing
/// everything sees.
#include <gtest/gtest.h>

#include "accel/dynamic/insertion_tree.h"
#include "accel/dynamic/loose_tree.h"
#include "accel/dynamic/two_level_tree.h"
#include "accel/moving_harness.h"

namespace trapeze {
namespace {

using testing::GridMaker;
using Reinsertion = InsertionOptions::Reinsertion;
using testing::Noise;

/// Small and large quads that drift, each on its way; every third one stands still. The same in every frame
/// but for where they are.
GridMaker drifting_frame(int frame, int count = 600) {
    Noise noise;
    GridMaker maker;
    for (int n = 0; n < count; ++n) {
        const V3f start = noise.point(3), drift = n % 3 == 0 ? V3f(0) : noise.point(.3f);
        const V3f along = noise.point(n % 16 == 0 ? 2 : .2f), across = noise.point(.2f);
        const int keys = n % 2 == 0 ? 1 : 2;
        maker.add(1, 1, keys, [&](int i, int j, float t) {
            return start + drift * (static_cast<float>(frame) + t) + along * static_cast<float>(i) +
                   across * static_cast<float>(j);
        });
    }
    maker.add(1, 1, 1, [](int i, int j, float) { return V3f(3e38f * (i - 1), 3e38f * (j - 1), 3e38f); });
    return maker;
}

/// Everything whose boxes have no insides.
GridMaker points_frame() {
    GridMaker maker;
    for (int n = 0; n < 200; ++n)
        maker.add(1, 1, 1, [n](int i, int, float) { return V3f(0, n < 100 ? 1 : 2, static_cast<float>(i)); });
    return maker;
}

template <class Tree>
void expect_every_frame_right(Tree tree) {
    std::vector<GridMaker> frames;
    for (int frame = 0; frame < 6; ++frame) frames.push_back(drifting_frame(frame));
    tree.build(frames[0].grids());
    EXPECT_EQ(testing::differing_rays(frames[0], tree, 300), 0);
    for (const int frame : {1, 2, 5, 5, 0}) {
        tree.update(frames[static_cast<size_t>(frame)].grids());
        EXPECT_EQ(testing::differing_rays(frames[static_cast<size_t>(frame)], tree, 300), 0) << frame;
    }
    // What is no later frame of the same sequence is built.
    for (const int count : {1, 2, 3, 100}) {
        const GridMaker other = drifting_frame(0, count);
        tree.update(other.grids());
        EXPECT_EQ(testing::differing_rays(other, tree, 100, count / 10), 0) << count;
    }
    const GridMaker points = points_frame();
    tree.update(points.grids());
    EXPECT_EQ(testing::differing_rays(points, tree, 100, 0), 0);
    const Grids none;
    tree.update(none);
    testing::expect_no_hit_in(tree);
}

TEST(InsertionTree, SeesEveryFrameAsItIs) {
    for (const int passes : {0, 2})
        for (const float thinning : {0.f, 1.1f, 2.f})
            for (const auto order : {InsertionOptions::Order::Shuffled, InsertionOptions::Order::Given})
                for (const auto reinsertion :
                     {Reinsertion::Ancestor, Reinsertion::Root, Reinsertion::Rebuilt})
                    expect_every_frame_right(InsertionTree({passes, thinning, order, reinsertion}));
}

TEST(LooseTree, SeesEveryFrameAsItIs) {
    for (const int levels : {0, 3, 12, 18})
        for (const bool by_size : {true, false})
            for (const bool skip : {true, false})
                expect_every_frame_right(LooseTree({levels, by_size, skip}));
}

TEST(TwoLevelTree, SeesEveryFrameAsItIs) {
    expect_every_frame_right(TwoLevelTree());
}

TEST(InsertionTree, StaysATreeWhateverMoves) {
    for (const auto& [thinning, reinsertion] : {std::pair{0.f, Reinsertion::Ancestor},
                                                {1.1f, Reinsertion::Root},
                                                {1.5f, Reinsertion::Ancestor},
                                                {0.f, Reinsertion::Rebuilt},
                                                {1.1f, Reinsertion::Rebuilt}}) {
        InsertionTree tree({.passes = 1, .thinning = thinning, .reinsertion = reinsertion});
        uint64_t dissolved = 0;
        for (int frame = 0; frame < 20; ++frame) {
            const GridMaker maker = drifting_frame(frame);
            if (frame == 0)
                tree.build(maker.grids());
            else
                tree.update(maker.grids());
            ASSERT_EQ(tree.contradiction(), "") << frame;
            EXPECT_EQ(tree.moved(), frame == 0 ? 0u : 400u);
            const bool rebuilds = reinsertion == Reinsertion::Rebuilt && frame > 0;
            EXPECT_EQ(tree.rebuilt() >= 400, rebuilds);
            EXPECT_LE(tree.rebuilt(), rebuilds ? 600u : 0u);
            dissolved += tree.dissolved();
        }
        // Nodes that are built anew in each frame have no time to become thin.
        EXPECT_EQ(dissolved > 0, thinning > 0 && reinsertion != Reinsertion::Rebuilt) << thinning;
    }
}

/// Told what has moved, a tree becomes the same as one that looks for itself.
TEST(InsertionTree, LooksAtNothingButWhatItIsToldHasMoved) {
    const auto wall_of_quads = [](float moved_by, int count = 500) {
        GridMaker maker;
        for (int n = 0; n < count; ++n)
            maker.add(n % 7 == 0 ? 2 : 1, 1, 1, [n, moved_by](int i, int j, float) {
                const float by = n % 10 == 3 ? moved_by : 0;
                return V3f(.2f * (static_cast<float>(n % 25) + .9f * static_cast<float>(i)) - 2.5f + by,
                           .25f * (static_cast<float>(n / 25) + .9f * static_cast<float>(j)) - 2.5f + by, by);
            });
        return maker;
    };
    const GridMaker first = wall_of_quads(0), second = wall_of_quads(3), fewer = wall_of_quads(5, 480),
                    endless = wall_of_quads(2e38f);
    std::vector<uint32_t> changed;
    for (uint32_t n = 3; n < 500; n += 10) changed.push_back(n);
    InsertionTree told({.passes = 1}), untold({.passes = 1});
    told.build(first.grids()), untold.build(first.grids());
    told.update(second.grids(), changed), untold.update(second.grids());
    EXPECT_EQ(told.moved(), 57u);  // 50 grids, of which 7 have two micropolygons
    EXPECT_EQ(untold.moved(), 57u);
    EXPECT_EQ(told.contradiction(), "");
    EXPECT_EQ(told.expected_visits(), untold.expected_visits());
    EXPECT_EQ(testing::differing_rays(second, told, 300, 20), 0);
    told.update(first.grids(), std::vector<uint32_t>{13});
    EXPECT_EQ(told.moved(), 1u);
    // What has other objects, or objects without bounds, is read whole.
    told.update(fewer.grids(), std::vector<uint32_t>{0});
    EXPECT_EQ(told.contradiction(), "");
    EXPECT_EQ(testing::differing_rays(fewer, told, 200, 20), 0);
    told.build(first.grids());
    told.update(endless.grids(), changed);
    EXPECT_EQ(testing::differing_rays(endless, told, 200, 0), 0);
}

/// A frame of quads in a wall, of which every tenth stands out by some way.
GridMaker wall_frame(float moved_by) {
    GridMaker maker;
    for (int n = 0; n < 500; ++n)
        maker.add(1, 1, 1, [n, moved_by](int i, int j, float) {
            const float by = n % 10 == 3 ? moved_by : 0;
            return V3f(.2f * (static_cast<float>(n % 25) + .9f * static_cast<float>(i)) - 2.5f,
                       .25f * (static_cast<float>(n / 25) + .9f * static_cast<float>(j)) - 2.5f, by);
        });
    return maker;
}

TEST(InsertionTree, BuildsAnewBelowWhatHasMovedAlone) {
    // Two walls far from each other, of which something moves in one.
    const auto walls = [](float moved_by) {
        GridMaker maker;
        for (const float x : {-20.f, 20.f})
            for (int n = 0; n < 300; ++n)
                maker.add(1, 1, 1, [=](int i, int j, float) {
                    const float by = x > 0 && n % 30 == 0 ? moved_by : 0;
                    return V3f(x + .2f * static_cast<float>(n % 15 + i),
                               .2f * static_cast<float>(n / 15 + j) + by, 0);
                });
        return maker;
    };
    const GridMaker first = walls(0), second = walls(.1f);
    InsertionTree tree({.passes = 1, .reinsertion = Reinsertion::Rebuilt});
    tree.build(first.grids());
    tree.update(second.grids());
    EXPECT_EQ(tree.contradiction(), "");
    EXPECT_EQ(tree.moved(), 10u);
    EXPECT_GT(tree.rebuilt(), 10u);
    EXPECT_LE(tree.rebuilt(), 300u);
    EXPECT_EQ(testing::differing_rays(second, tree, 300, 0), 0);
}

TEST(TwoLevelTree, KeepsWhatHasNotMoved) {
    const GridMaker first = wall_frame(0), second = wall_frame(.5f), third = wall_frame(1);
    std::vector<uint32_t> changed;
    for (uint32_t n = 3; n < 500; n += 10) changed.push_back(n);
    TwoLevelTree told, untold;
    told.build(first.grids()), untold.build(first.grids());
    EXPECT_EQ(told.moving(), 0u);
    for (const GridMaker* frame : {&second, &third, &third, &first}) {
        told.update(frame->grids(), changed), untold.update(frame->grids());
        EXPECT_EQ(told.moving(), 50u);
        EXPECT_EQ(untold.moving(), 50u);
        EXPECT_EQ(testing::differing_rays(*frame, told, 300, 20), 0);
        EXPECT_EQ(testing::differing_rays(*frame, untold, 300, 20), 0);
    }
}

TEST(InsertionTree, OfAFrameAsItWasMovesNothing) {
    const GridMaker maker = drifting_frame(3), same = drifting_frame(3);
    InsertionTree tree;
    tree.build(maker.grids());
    const double before = tree.expected_visits();
    tree.update(same.grids());
    EXPECT_EQ(tree.moved(), 0u);
    EXPECT_EQ(tree.expected_visits(), before);
}

TEST(InsertionTree, IsBetterWhereObjectsAreInsertedAgain) {
    const GridMaker maker = drifting_frame(0, 2000);
    InsertionTree once, thrice({2});
    once.build(maker.grids());
    thrice.build(maker.grids());
    EXPECT_LT(thrice.expected_visits(), once.expected_visits() * .95);
}

/// Sorted objects make a tree as deep as it has objects: nothing may be bounded by a depth.
TEST(InsertionTree, MayBeDeep) {
    GridMaker maker;
    for (int n = 0; n < 3000; ++n) {
        const float size = std::ldexp(1.0f, n % 90 - 60);
        maker.add(1, 1, 1, [size](int i, int j, float) {
            return V3f(static_cast<float>(i) * size, static_cast<float>(j) * size, 1);
        });
    }
    InsertionTree tree({.order = InsertionOptions::Order::Given});
    tree.build(maker.grids());
    EXPECT_EQ(tree.contradiction(), "");
    EXPECT_EQ(testing::differing_rays(maker, tree, 200, 20), 0);
}

/// A row of quads, one beside the other, each a little larger.
TEST(InsertionTree, IsBetterWhereRowsAreShuffled) {
    GridMaker maker;
    for (int n = 0; n < 1500; ++n)
        maker.add(1, 1, 1, [n](int i, int j, float) {
            const auto at = static_cast<float>(n + i);
            return V3f(1e-3f * at * at, static_cast<float>(j), 1);
        });
    InsertionTree given({.order = InsertionOptions::Order::Given}), shuffled;
    given.build(maker.grids());
    shuffled.build(maker.grids());
    EXPECT_LT(shuffled.expected_visits(), given.expected_visits() * .2);
}

/// A node's objects reach at most half a voxel beyond the voxel that the node stands for.
TEST(LooseTree, KeepsObjectsByTheirSize) {
    const GridMaker maker = drifting_frame(0, 2000);
    const LooseOptions options{.levels = 12};
    LooseTree tree(options);
    tree.build(maker.grids());
    FrameBoxes objects;
    objects.read(maker.grids());
    KeyBox scene = empty_box();
    for (const KeyBox& box : objects.boxes) scene = joined(scene, box);
    std::array<size_t, 5> at_level{};
    for (size_t object = 0; object < objects.boxes.size(); ++object) {
        uint32_t node = tree.nodes().node_of(object);
        int level = 0;
        for (uint32_t at = node; at > 0; at = (at - 1) / 2) ++level;
        ASSERT_EQ(level % 3, 0);
        ++at_level[static_cast<size_t>(level / 3)];
        // The voxel, from the way up to the root: halves of x, y and z in turn.
        KeyBox voxel = scene;
        std::vector<bool> upper;
        for (; node > 0; node = (node - 1) / 2) upper.push_back(node % 2 == 0);
        for (int step = 0; step < level; ++step) {
            const int axis = step % 3;
            const float middle = voxel.low[axis] * .5f + voxel.high[axis] * .5f;
            (upper[static_cast<size_t>(level - 1 - step)] ? voxel.low : voxel.high)[axis] = middle;
        }
        const KeyBox& box = objects.boxes[object];
        for (int k = 0; k < 3; ++k) {
            const float half = (voxel.high[k] - voxel.low[k]) * .501f;
            EXPECT_GE(box.low[k], voxel.low[k] - half);
            EXPECT_LE(box.high[k], voxel.high[k] + half);
        }
        EXPECT_TRUE(holds(tree.nodes().box_of(tree.nodes().node_of(object)), box));
    }
    EXPECT_GT(at_level[2], 50u);
    EXPECT_GT(at_level[3], 50u);
}

TEST(LooseTree, VisitsLessWhenItSkips) {
    const GridMaker maker = drifting_frame(0, 200);
    std::array<SampleStats, 2> stats;
    for (const size_t skips : {0, 1}) {
        LooseTree tree({.skip = skips == 1});
        tree.build(maker.grids());
        stats[skips] = testing::stats_of_rays(maker, tree, 1000);
    }
    EXPECT_LT(stats[1].nodes_visited, stats[0].nodes_visited * 9 / 10);
    EXPECT_EQ(stats[1].predicate_tests, stats[0].predicate_tests);
}

}  // namespace
}  // namespace trapeze
