/// The k-d tree for motion blur finds what testing everything finds, whatever its choices are.
#include "accel/moving/kd_tree.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "accel/builders/grid_summary.h"
#include "accel/moving/moving_tree.h"
#include "accel/moving_harness.h"

namespace trapeze {
namespace {

using testing::GridMaker;
using testing::Noise;
using Weight = KdTreeOptions::Weight;
using Guests = KdTreeOptions::Guests;

TEST(KdTree, FindsWhatTestingEverythingFinds) {
    Noise noise;
    GridMaker maker;
    testing::add_all_kinds(maker, noise);
    for (const float plane_time : {0.f, .5f, 1.f})
        for (const Weight weight : {Weight::Time, Weight::Whole})
            for (const double budget : {0., .5, 8., 100.})
                for (const int leaf : {2, 8})
                    for (const bool mailbox : {true, false}) {
                        const Guests guests = mailbox == (leaf == 2) ? Guests::Silent : Guests::Return;
                        const KdTree tree(maker.grids(), {plane_time, weight, guests, budget, leaf, mailbox});
                        EXPECT_EQ(testing::differing_rays(maker, tree, 300), 0)
                            << plane_time << ' ' << budget << ' ' << leaf << ' ' << mailbox;
                    }
}

TEST(KdTree, TellsItsPhases) {
    Noise noise;
    GridMaker maker;
    testing::add_strips(maker, 5000, 2, noise);
    const BuildPhases phases = KdTree(maker.grids()).stats().phases;
    for (const double phase : {phases.prepare, phases.divide, phases.bound, phases.cut_work})
        EXPECT_GT(phase, 0);
    EXPECT_LT(phases.cut_work, phases.divide_work);
}

/// Everything in one plane, on one line, in one point; rays that run in planes of the tree.
TEST(KdTree, OfFlatThingsFindsWhatTestingEverythingFinds) {
    for (const int flat : {0, 1, 2}) {
        Noise noise;
        GridMaker maker;
        for (int n = 0; n < 300; ++n) {
            const V3f middle = noise.point(3), along = noise.point(.5f), across = noise.point(.5f);
            maker.add(1, 1, 1 + n % 2, [&](int i, int j, float t) {
                V3f p = middle + along * static_cast<float>(i) + across * static_cast<float>(j) +
                        V3f(t, t, t) * .5f;
                p[flat] = 1;
                return p;
            });
        }
        const KdTree tree(maker.grids());
        EXPECT_GT(tree.stats().tree_leaves, 20u);
        EXPECT_EQ(testing::differing_rays(maker, tree, 1000), 0);
    }
}

/// Wherever a micropolygon is at a time, the leaf of that place has it at that time. The negative control: in
/// an ordinary k-d tree of the plane time it is not there.
TEST(KdTopology, LeavesHaveWhatIsInThemAtTheTime) {
    Noise noise;
    GridMaker maker;
    for (const int keys : {1, 2, 3, 5}) testing::add_strips(maker, 300, keys, noise);
    const SweptBoxes boxes(maker.grids(), oriented_summaries(maker.grids(), {}));
    for (const float plane_time : {0.f, .5f}) {
        const KdTopology topology = build_kd_topology(maker.grids(), boxes, {.plane_time = plane_time});
        EXPECT_GT(topology.guests, 500u);
        int missed_by_residents = 0;
        for (int round = 0; round < 20000; ++round) {
            const auto item = static_cast<uint32_t>(noise.engine() % boxes.size());
            const float time = noise(0, 1);
            const MicropolygonId id = boxes.id(item);
            const Grid& grid = maker.grids().grids[id.grid];
            const V3f corner = grid.vertex(id.u, id.v, time);
            const V3f place = corner + (grid.vertex(id.u + 1, id.v, time) - corner) * noise(0, 1);
            size_t at = 0;
            while (!topology.nodes[at].is_leaf())
                at = topology.nodes[at].index() +
                     (place[topology.nodes[at].axis()] >= topology.nodes[at].plane);
            const uint32_t leaf = topology.nodes[at].index();
            const auto first = topology.references.begin() + topology.leaf_first[leaf];
            const auto last = topology.references.begin() + topology.leaf_first[leaf + 1];
            ASSERT_TRUE(std::any_of(first, last, [&](const KdReference& reference) {
                return reference.item == item && reference.when.holds(time);
            })) << round;
            missed_by_residents += std::none_of(first, last, [&](const KdReference& reference) {
                return reference.item == item && reference.when.holds(plane_time);
            });
        }
        EXPECT_GT(missed_by_residents, 500);
    }
}

/// Where everything is elsewhere when planes are chosen, the way of what flies is divided all the same.
TEST(KdTopology, DividesWaysThatAreEmptyAtThePlaneTime) {
    GridMaker maker;
    for (int n = 0; n < 4096; ++n)
        maker.add(1, 1, 2, [n](int i, int j, float t) {
            const V3f start(static_cast<float>(n % 16), static_cast<float>(n / 16 % 16),
                            static_cast<float>(n / 256));
            return start + V3f(static_cast<float>(i), static_cast<float>(j), 0) * .5f + V3f(100 * t, 0, 0);
        });
    // What comes back to vote divides it best; of 4096.
    for (const auto& [guests, most] : {std::pair(Guests::Return, 200u), std::pair(Guests::Silent, 400u)}) {
        const KdTree tree(maker.grids(), {.guests = guests, .budget = 100});
        SampleStats stats;
        Noise noise;
        for (int round = 0; round < 1000; ++round) {
            const float time = noise(0, 1);
            TraceRay ray = TraceRay::turned(
                axis_ray({V3f(noise(0, 16) + 100 * time, noise(0, 16), -1), V3f(0, 0, 1), time}), {});
            ClosestHit policy;
            tree.trace(ray, policy, stats);
        }
        EXPECT_LT(stats.predicate_tests, most * 1000);
    }
}

/// A slanted wall of rows far away: what touches a plane reaches to its other side by rounding. Planes just
/// beside a row must not have it on both sides again and again, until there is no budget left.
TEST(KdTopology, DividesRowsThatTouchItsPlanes) {
    GridMaker maker;
    for (int n = 0; n < 9; ++n)
        maker.add(16, 16, 1, [n](int i, int j, float) {
            const float x = static_cast<float>(16 * (n % 3) + i), y = static_cast<float>(16 * (n / 3) + j);
            return V3f(x - 24, .8f * y - 10, 45 - .15f * y);
        });
    const SweptBoxes boxes(maker.grids(), summaries_along_axes(maker.grids()));
    const KdTopology topology = build_kd_topology(maker.grids(), boxes, {});
    EXPECT_LT(topology.references.size(), 10 * boxes.size());
    size_t largest = 0;
    for (size_t i = 0; i + 1 < topology.leaf_first.size(); ++i)
        largest = std::max<size_t>(largest, topology.leaf_first[i + 1] - topology.leaf_first[i]);
    EXPECT_LT(largest, 10u);
}

TEST(KdTree, ShowsTransparentHitsOnce) {
    Noise noise;
    GridMaker maker;
    testing::add_strips(maker, 400, 2, noise);
    for (const bool mailbox : {true, false})
        testing::expect_same_layers(maker, MovingTree(maker.grids()),
                                    KdTree(maker.grids(), {.mailbox = mailbox}), noise);
}

TEST(KdTree, TestsLessWithAMailbox) {
    Noise noise;
    GridMaker maker;
    testing::add_strips(maker, 2000, 1, noise);
    std::array<SampleStats, 2> stats;
    for (const size_t mailbox : {0, 1}) {
        const KdTree tree(maker.grids(), {.mailbox = mailbox == 1});
        stats[mailbox] = testing::stats_of_rays(maker, tree, 2000);
    }
    EXPECT_LT(stats[1].predicate_tests, stats[0].predicate_tests * 9 / 10);
    EXPECT_EQ(stats[1].nodes_visited, stats[0].nodes_visited);
}

TEST(KdTree, KeepsToItsBudget) {
    Noise noise;
    GridMaker maker;
    testing::add_strips(maker, 1000, 2, noise);
    for (const double budget : {0., .1, 1., 1e6}) {
        const BuildStats stats = KdTree(maker.grids(), {.budget = budget}).stats();
        EXPECT_LE(stats.tree_duplicates, static_cast<uint64_t>(1000 * budget));
        EXPECT_EQ(stats.tree_references, 1000 + stats.tree_duplicates);
        EXPECT_EQ(stats.lacked_budget, budget < 1e6) << budget;
    }
}

TEST(KdTopology, IsTheSameFromAnyNumberOfThreads) {
    Noise noise;
    GridMaker maker;
    testing::add_strips(maker, 40000, 2, noise);
    const SweptBoxes boxes(maker.grids(), oriented_summaries(maker.grids(), {}));
    std::vector<KdTopology> all;
    for (const int threads : {1, 2, 7}) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                          static_cast<size_t>(threads));
        tbb::task_arena arena(threads);
        arena.execute([&] { all.push_back(build_kd_topology(maker.grids(), boxes, {.budget = 2})); });
    }
    for (const size_t other : {1, 2}) {
        ASSERT_EQ(all[0].nodes.size(), all[other].nodes.size());
        ASSERT_EQ(all[0].references.size(), all[other].references.size());
        for (size_t i = 0; i < all[0].nodes.size(); ++i) {
            ASSERT_EQ(all[0].nodes[i].bits, all[other].nodes[i].bits);
            ASSERT_EQ(all[0].nodes[i].plane, all[other].nodes[i].plane);
        }
        for (size_t i = 0; i < all[0].references.size(); ++i) {
            ASSERT_EQ(all[0].references[i].item, all[other].references[i].item);
            ASSERT_EQ(all[0].references[i].when, all[other].references[i].when);
        }
    }
}

TEST(KdTree, OfNothingHasNothing) {
    const Grids none;
    const KdTree tree(none);
    EXPECT_EQ(tree.stats().tree_nodes, 0u);
    testing::expect_no_hit_in(tree);
}

}  // namespace
}  // namespace trapeze
