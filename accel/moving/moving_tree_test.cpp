/// Trees of boxes that are interpolated between keys, with spatial splits and without: they find what testing
/// everything finds, and the wrong form of clipping does not.
#include "accel/moving/moving_tree.h"

#include <gtest/gtest.h>

#include <chrono>

#include "accel/builders/grid_summary.h"
#include "accel/builders/micropolygon_boxes.h"
#include "accel/moving/linear_topology.h"
#include "accel/moving_harness.h"
#include "accel/paper/top_level_harness.h"

namespace trapeze {
namespace {

using testing::add_all_kinds;
using testing::add_strips;
using testing::differing_rays;
using testing::GridMaker;
using testing::Noise;
using testing::noisy_ray;
using Clipping = MovingTreeOptions::Clipping;

TEST(MovingTree, FindsWhatTestingEverythingFinds) {
    Noise noise;
    GridMaker maker;
    add_all_kinds(maker, noise);
    for (const Clipping clipping : {Clipping::Polygon, Clipping::Box})
        for (const double budget : {0., .5, 8.})
            for (const int keys : {0, 1, 2, 3, 65})
                for (const int leaf : {2, 8}) {
                    if (budget == 0 && clipping == Clipping::Box) continue;
                    const MovingTree tree(maker.grids(), {budget, clipping, keys, leaf});
                    EXPECT_EQ(tree.top().key_count, keys == 0 ? 17 : keys);
                    EXPECT_EQ(tree.stats().tree_duplicates > 0, budget > 0);
                    EXPECT_EQ(differing_rays(maker, tree, 400), 0)
                        << static_cast<int>(clipping) << ' ' << budget << ' ' << keys << ' ' << leaf;
                }
}

TEST(MovingTree, InTheOrderOfMortonCodesFindsWhatTestingEverythingFinds) {
    Noise noise;
    GridMaker maker;
    add_all_kinds(maker, noise);
    for (const int keys : {0, 2})
        for (const int leaf : {2, 8}) {
            const MovingTree tree(
                maker.grids(), {.keys = keys, .leaf = leaf, .topology = MovingTreeOptions::Topology::Morton});
            EXPECT_EQ(tree.stats().tree_duplicates, 0u);
            EXPECT_EQ(differing_rays(maker, tree, 400), 0) << keys << ' ' << leaf;
        }
}

/// Codes divide space by halves: what is left of a plane's middle is below what is right of it.
TEST(LinearTopology, DividesByTheHighestBit) {
    std::vector<V3f> points;
    for (const float x : {.9f, .1f, .6f, .2f, .4f, .0f, 1.f}) points.push_back(V3f(x, 0, 0));
    const LinearTopology topology = build_linear_topology(points, Box3f(V3f(0), V3f(1, 0, 0)), 2);
    std::vector<float> xs;
    for (const uint32_t item : topology.items) xs.push_back(points[item].x);
    EXPECT_EQ(xs, (std::vector<float>{0, .1f, .2f, .4f, .6f, .9f, 1}));
    EXPECT_EQ(topology.tree.inner.size(), 6u);
    // The root's lower side is what lies below a half.
    const TopLink high = topology.tree.inner[0][1];
    ASSERT_FALSE(high.is_leaf());
    EXPECT_EQ(high.index(), 4u);
}

/// Items of a leaf are in their own order, by whatever name.
TEST(LinearTopology, HasItemsByTheirNames) {
    Noise noise;
    std::vector<V3f> points;
    std::vector<uint32_t> names;
    for (uint32_t i = 0; i < 1000; ++i) {
        points.push_back(noise.point(1));
        names.push_back(3 * i + 100);
    }
    const Box3f box(V3f(-1), V3f(1));
    for (const size_t leaf_below : {size_t{2}, size_t{8}, size_t{32}}) {
        const LinearTopology by_number = build_linear_topology(points, box, leaf_below),
                             by_name = build_linear_topology(points, box, leaf_below, names);
        EXPECT_EQ(by_name.leaf_first, by_number.leaf_first);
        for (size_t i = 0; i < points.size(); ++i) EXPECT_EQ(by_name.items[i], 3 * by_number.items[i] + 100);
        for (size_t leaf = 0; leaf + 1 < by_name.leaf_first.size(); ++leaf) {
            const auto first = by_name.items.begin() + by_name.leaf_first[leaf],
                       last = by_name.items.begin() + by_name.leaf_first[leaf + 1];
            EXPECT_LT(static_cast<size_t>(last - first), leaf_below);
            EXPECT_TRUE(std::is_sorted(first, last));
        }
    }
}

/// The negative control: boxes of clipped polygons that move as whole boxes do lose hits [Gruenschloss11 fig.
/// 3].
TEST(MovingTree, LosesHitsWhenClippedNaively) {
    Noise noise;
    GridMaker maker;
    add_strips(maker, 1000, 2, noise);
    const MovingTree right(maker.grids(), {4, Clipping::Polygon}), wrong(maker.grids(), {4, Clipping::Naive});
    EXPECT_GT(right.stats().tree_splits, 20u);
    EXPECT_EQ(differing_rays(maker, right, 2000), 0);
    EXPECT_GT(differing_rays(maker, wrong, 2000), 10);
}

TEST(MovingTree, LooksAtLessOfStillStripsWithSpatialSplits) {
    Noise noise;
    GridMaker maker;
    add_strips(maker, 2000, 1, noise);
    std::array<SampleStats, 2> stats;
    std::array<double, 2> sah_costs{};
    for (const size_t splits : {0, 1}) {
        const MovingTree tree(maker.grids(), {splits ? 4. : 0.});
        sah_costs[splits] = tree.stats().tree_sah_cost;
        Noise rays;
        for (int round = 0; round < 2000; ++round) {
            TraceRay ray = TraceRay::turned(axis_ray(noisy_ray(maker, rays, round)), {});
            ClosestHit policy;
            tree.trace(ray, policy, stats[splits]);
        }
    }
    EXPECT_LT(stats[1].predicate_tests, stats[0].predicate_tests * 4 / 5);
    EXPECT_LT(stats[1].nodes_visited, stats[0].nodes_visited * 4 / 5);
    EXPECT_LT(sah_costs[1], sah_costs[0] * .8);
}

/// Two squares, a quarter of the whole box's width each, far apart: a line through the whole meets each with
/// the ratio of their areas.
TEST(MovingTree, CountsItsCostByTheSurfaceAreaHeuristic) {
    const auto squares = [](int count, int keys, float apart_then) {
        GridMaker maker;
        for (int n = 0; n < count; ++n)
            maker.add(1, 1, keys, [=](int i, int j, float t) {
                const float apart = n == 0 ? 0 : 3 + (apart_then - 3) * t;
                return V3f(static_cast<float>(i) + apart, static_cast<float>(j), 5);
            });
        return maker;
    };
    const auto cost = [](const GridMaker& maker, int leaf) {
        MovingTreeOptions options;
        options.leaf = leaf;
        return MovingTree(maker.grids(), options).stats().tree_sah_cost;
    };
    EXPECT_DOUBLE_EQ(cost(squares(1, 1, 0), 4), 1);
    EXPECT_DOUBLE_EQ(cost(squares(2, 1, 0), 4), 2);            // one leaf of two
    EXPECT_NEAR(cost(squares(2, 1, 0), 2), 1 + 2 / 4., 1e-3);  // a step, and squares of 1 in a box of 4
    // At the end 9 apart: the mean area is 7.
    EXPECT_NEAR(cost(squares(2, 2, 9), 2), 1 + 2 / 7., 1e-3);
}

TEST(MovingTree, ShowsTransparentHitsOnce) {
    Noise noise;
    GridMaker maker;
    add_strips(maker, 400, 2, noise);
    const MovingTree plain(maker.grids()), cut(maker.grids(), {4});
    testing::expect_same_layers(maker, plain, cut, noise);
}

TEST(MovingTree, TellsItsPhases) {
    Noise noise;
    GridMaker maker;
    add_strips(maker, 20'000, 2, noise);
    const auto begin = std::chrono::steady_clock::now();
    const BuildPhases cut = MovingTree(maker.grids(), {4}).stats().phases;
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    for (const double phase : {cut.prepare, cut.divide, cut.bound, cut.divide_work, cut.cut_work})
        EXPECT_GT(phase, 0);
    EXPECT_LE(cut.told(), seconds);
    EXPECT_LT(cut.cut_work, cut.divide_work);
    const BuildPhases whole = MovingTree(maker.grids(), {0}).stats().phases;
    EXPECT_GT(whole.divide_work, 0);
    EXPECT_EQ(whole.cut_work, 0);
}

TEST(MovingTree, KeepsToItsBudget) {
    Noise noise;
    GridMaker maker;
    add_strips(maker, 1000, 2, noise);
    for (const double budget : {0., .1, 1., 8.}) {
        const BuildStats stats = MovingTree(maker.grids(), {budget}).stats();
        EXPECT_LE(stats.tree_duplicates, static_cast<uint64_t>(1000 * budget));
        EXPECT_EQ(stats.tree_references, 1000 + stats.tree_duplicates);
        EXPECT_EQ(stats.tree_splits > 0, budget > 0);
        if (budget != 1) {
            EXPECT_EQ(stats.lacked_budget, budget == .1) << budget;
        }
    }
}

TEST(MovingTree, IsTheSameFromAnyNumberOfThreads) {
    Noise noise;
    GridMaker maker;
    add_strips(maker, 3000, 2, noise);
    for (const auto topology : {MovingTreeOptions::Topology::Sah, MovingTreeOptions::Topology::Morton})
        testing::expect_same_from_any_threads(
            [&] { return MovingTree(maker.grids(), {.budget = 2, .topology = topology}).top(); });
}

TEST(MovingTree, RefittedSeesEveryFrameAsItIs) {
    const auto frame_of = [](float shift, int strips = 300) {
        Noise noise;
        GridMaker parts, maker;
        add_strips(parts, strips, 3, noise);
        for (const Grid& grid : parts.grids().grids)
            maker.add(grid.shape.nu, grid.shape.nv, 3, [&](int i, int j, float t) {
                const V3f at = grid.vertex(i, j, t);
                return at + V3f(std::sin(at.y), std::sin(at.z), std::sin(at.x)) * shift;
            });
        return maker;
    };
    const GridMaker first = frame_of(0), second = frame_of(2), other = frame_of(0, 200), fewer_keys = [] {
        Noise noise;
        GridMaker maker;
        add_strips(maker, 300, 1, noise);
        return maker;
    }();
    for (const MovingTreeOptions options : {MovingTreeOptions{},
                                            {.budget = 2},
                                            {.budget = 2, .clipping = MovingTreeOptions::Clipping::Box},
                                            {.budget = 2, .keys = 1},
                                            {.topology = MovingTreeOptions::Topology::Morton}}) {
        MovingTree tree(first.grids(), options);
        const uint64_t nodes = tree.stats().tree_nodes;
        const double built = tree.stats().tree_sah_cost;
        // The same frame once more: parts are cut by boxes that hold little more than them.
        tree.refit(first.grids());
        EXPECT_EQ(testing::differing_rays(first, tree, 300, 30), 0);
        EXPECT_LT(tree.stats().tree_sah_cost, built * 1.1);
        for (const GridMaker* frame : {&second, &fewer_keys, &first}) {
            tree.refit(frame->grids());
            EXPECT_EQ(testing::differing_rays(*frame, tree, 300, 30), 0);
            EXPECT_EQ(tree.stats().tree_nodes, nodes);
            if (frame == &second) {
                EXPECT_GT(tree.stats().tree_sah_cost, built);
            }
        }
        tree.refit(other.grids());
        EXPECT_EQ(testing::differing_rays(other, tree, 300, 30), 0);
        EXPECT_LT(tree.stats().tree_nodes, nodes);
    }
}

TEST(MovingTree, OfNothingHasNothing) {
    const Grids none;
    const MovingTree tree(none, {2});
    EXPECT_EQ(tree.stats().tree_nodes, 0u);
    testing::expect_no_hit_in(tree);
}

/// Every reference's box holds what its micropolygon has there: together they hold all of it.
TEST(SpatialTopology, ReferencesHoldAllOfTheirMicropolygons) {
    Noise noise;
    GridMaker maker;
    add_strips(maker, 2000, 3, noise);
    UnsetVector<MicropolygonId> ids;
    UnsetVector<SahItem> items;
    micropolygon_items(maker.grids(), oriented_summaries(maker.grids(), {}), ids, items);
    for (const bool tight : {true, false}) {
        const SpatialTopology topology =
            build_spatial_topology(items, maker.grids(), {.leaf_below = 4, .budget = 8000, .tight = tight});
        EXPECT_GT(topology.splits, 20u);
        std::vector<std::vector<Box3f>> boxes(ids.size());
        for (const SahItem& reference : topology.references)
            boxes[PartId::index(reference.id)].push_back(reference.box);
        for (size_t id = 0; id < ids.size(); ++id) {
            const QuadPose pose = pose_of(maker.grids().grids[ids[id].grid], ids[id], .5f);
            for (int n = 0; n < 20; ++n) {
                const float v = noise(0, 1), u = noise(0, 1);
                const V3f a = pose[0] + (pose[3] - pose[0]) * v;
                const V3f b = n % 2 ? pose[1] : pose[2], point = a + (b - a) * u;
                const V3f slack(2 * part_slack(pose));
                EXPECT_TRUE(std::any_of(boxes[id].begin(), boxes[id].end(), [&](const Box3f& box) {
                    return Box3f(box.min - slack, box.max + slack).intersects(point);
                })) << id;
            }
        }
    }
}

}  // namespace
}  // namespace trapeze
