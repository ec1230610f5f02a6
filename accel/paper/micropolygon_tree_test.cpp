/// All variants of the paper's study, of both trees: they find what testing everything finds, and differ only
/// in what they are named for.
#include "accel/paper/micropolygon_tree.h"

#include <gtest/gtest.h>

#include "accel/paper/paper_tree.h"
#include "accel/paper/top_level_harness.h"
#include "accel/rays_harness.h"

namespace trapeze {
namespace {

using testing::add_sheets;
using testing::closest_naively;
using testing::GridMaker;
using testing::Noise;
using Bounds = PaperTreeOptions::Bounds;

/// Every combination of the study's choices.
std::vector<PaperTreeOptions> all_options() {
    std::vector<PaperTreeOptions> all;
    for (const Bounds bounds : {Bounds::Oriented, Bounds::AxisAligned, Bounds::WholeMotion})
        for (const bool orient_split : {true, false})
            for (const bool orient_propagation : {true, false})
                for (const int leaf : {4, 8, 32})
                    all.push_back({bounds, orient_split, orient_propagation, leaf});
    return all;
}

/// Sheets with one, two and five keys, and what has no bound.
void add_everything(GridMaker& maker, Noise& noise) {
    for (const int keys : {1, 2, 5}) add_sheets(maker, 8, keys, noise);
    maker.add(2, 2, 1, [](int i, int j, float) { return V3f(3e38f * (i - 1), 3e38f * (j - 1), 3e38f); });
    maker.add(1, 1, 2, [](int i, int j, float t) { return V3f(2e20f * (i - 0.5f), 2e20f * (j - 0.5f), t); });
    maker.add(3, 4, 2, [](int, int, float) { return V3f(1, 2, 3); });
}

template <class Tree>
void expect_what_testing_everything_finds(const PaperTreeOptions& options) {
    Noise noise;
    GridMaker maker;
    add_everything(maker, noise);
    const Tree tree(maker.grids(), options);
    SampleStats stats;
    int hits = 0;
    for (int round = 0; round < 400; ++round) {
        V3f direction = noise.point(1);
        if (round % 4 == 0) direction = V3f(0), direction[round / 4 % 3] = 1;
        const SpaceRay ray{noise.point(5), direction, noise(0, 1)};
        const DepthRange range{noise(-1, 1), noise(2, 8)};
        TraceRay trace_ray = TraceRay::turned(axis_ray(ray), range);
        ClosestHit policy;
        tree.trace(trace_ray, policy, stats);
        ASSERT_EQ(policy.best, closest_naively(maker.grids(), ray, range));
        hits += policy.found();
    }
    EXPECT_GT(hits, 50);
    EXPECT_EQ(stats.rays, 400u);
    EXPECT_GT(stats.leaves_visited, 0u);
    EXPECT_GE(stats.predicate_tests, stats.leaves_visited);
}

TEST(PaperTreeOptions, AllFindWhatTestingEverythingFinds) {
    for (const PaperTreeOptions& options : all_options()) {
        expect_what_testing_everything_finds<PaperTree>(options);
        expect_what_testing_everything_finds<MicropolygonTree>(options);
    }
}

/// Links of all nodes: what the topology is.
template <class Tree>
std::vector<uint32_t> links_of(const Tree& tree) {
    std::vector<uint32_t> links;
    for (const TopLevel::Node& node : tree.top().nodes) links.push_back(node.link.value);
    return links;
}

template <class Tree>
void expect_one_topology_for_all_bounds() {
    Noise noise;
    GridMaker maker;
    for (const int keys : {1, 2, 5}) add_sheets(maker, 30, keys, noise);
    const Tree obb(maker.grids()), aabb(maker.grids(), {.bounds = Bounds::AxisAligned}),
        aabb4d(maker.grids(), {.bounds = Bounds::WholeMotion});
    EXPECT_EQ(links_of(obb), links_of(aabb));
    EXPECT_EQ(links_of(obb), links_of(aabb4d));
    EXPECT_EQ(obb.stats().tree_leaves, aabb4d.stats().tree_leaves);
    EXPECT_EQ(aabb.top().key_count, 5);
    EXPECT_EQ(aabb4d.top().key_count, 1);
    EXPECT_LT(aabb.stats().tree_bytes, obb.stats().tree_bytes);
    EXPECT_LT(aabb4d.stats().tree_bytes, aabb.stats().tree_bytes);
}

TEST(PaperTreeOptions, BoundsDoNotChangeTheTopology) {
    expect_one_topology_for_all_bounds<PaperTree>();
    expect_one_topology_for_all_bounds<MicropolygonTree>();
}

TEST(PaperTreeOptions, WithoutPropagationNodesAboveLeavesAreAxisAligned) {
    Noise noise;
    GridMaker maker;
    add_sheets(maker, 50, 2, noise);
    for (const bool propagation : {true, false}) {
        const PaperTree tree(maker.grids(), {.orient_propagation = propagation});
        int turned_inner = 0, turned_leaves = 0;
        for (size_t i = 0; i < tree.top().nodes.size(); ++i) {
            const bool turned = tree.top().axes_of(i).column[0][0] != 1;
            (tree.top().nodes[i].link.is_leaf() ? turned_leaves : turned_inner) += turned;
        }
        EXPECT_EQ(turned_leaves, 50);
        EXPECT_EQ(turned_inner, propagation ? 49 : 0);
    }
}

TEST(PaperTreeOptions, SmallerLeavesAreMoreLeavesAndFewerTests) {
    Noise noise;
    GridMaker maker;
    add_sheets(maker, 50, 1, noise);
    uint64_t tests = 0, leaves = 0;
    for (const int leaf : {4, 8, 16, 32}) {
        const PaperTree tree(maker.grids(), {.leaf = leaf});
        SampleStats stats;
        Noise rays;
        for (int round = 0; round < 500; ++round) {
            TraceRay ray = TraceRay::turned(axis_ray({rays.point(5), rays.point(1), 0}), {});
            ClosestHit policy;
            tree.trace(ray, policy, stats);
        }
        EXPECT_GT(stats.predicate_tests, tests);
        if (leaves > 0) {
            EXPECT_LT(tree.stats().tree_leaves, leaves);
        }
        tests = stats.predicate_tests, leaves = tree.stats().tree_leaves;
    }
}

TEST(MicropolygonTree, LeavesAreSmallAndThereIsNothingInNone) {
    GridMaker maker;
    maker.add(16, 16, 2,
              [](int i, int j, float t) { return V3f(static_cast<float>(i) + t, static_cast<float>(j), 3); });
    const MicropolygonTree tree(maker.grids());
    EXPECT_GE(tree.stats().tree_leaves, 256u / 7);
    EXPECT_EQ(tree.stats().tree_nodes, 2 * tree.stats().tree_leaves - 1);
    const Grids none;
    const MicropolygonTree empty(none);
    EXPECT_EQ(empty.stats().tree_nodes, 0u);
    testing::expect_no_hit_in(empty);
}

TEST(MicropolygonTree, IsTheSameFromAnyNumberOfThreads) {
    Noise noise;
    GridMaker maker;
    add_sheets(maker, 800, 2, noise);
    testing::expect_same_from_any_threads([&] { return MicropolygonTree(maker.grids()).top(); });
}

}  // namespace
}  // namespace trapeze
