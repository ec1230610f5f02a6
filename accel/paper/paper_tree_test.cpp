/// The reference tree against testing every micropolygon, bit for bit and in all directions; closed surfaces
/// without leaks; bounds that hold vertices at all times; memory; degenerate grids.
#include "accel/paper/paper_tree.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>

#include "accel/rays_harness.h"

namespace trapeze {
namespace {

using testing::add_sheets;
using testing::add_torus;
using testing::closest_naively;
using testing::GridMaker;
using testing::Noise;

TEST(PaperTree, ClosestAndAnyInAllDirectionsEqualTestingEverything) {
    for (const int keys : {1, 2, 5}) {
        Noise noise;
        GridMaker maker;
        add_sheets(maker, 25, keys, noise);
        add_sheets(maker, 5, 1, noise);
        const PaperTree tree(maker.grids());
        int hits = 0;
        for (int round = 0; round < 5000; ++round) {
            const SpaceRay ray{noise.point(5), noise.point(1), noise(0, 1)};
            const DepthRange range{noise(-1, 1), noise(2, 8)};
            const Hit truth = closest_naively(maker.grids(), ray, range);
            const std::optional<Hit> closest = tree.closest(ray, range);
            ASSERT_EQ(closest.value_or(kNoHit), truth);
            ASSERT_EQ(tree.any(ray, range), closest.has_value());
            hits += closest.has_value();
        }
        EXPECT_GT(hits, 500);
    }
}

/// Turning a ray once or anew for each node is the same arithmetic.
TEST(PaperTree, GoesTheSameWayWithKeptRays) {
    Noise noise;
    GridMaker maker;
    add_sheets(maker, 40, 2, noise);
    PaperTreeOptions options;
    const PaperTree anew(maker.grids(), options);
    options.keep_turned_rays = true;
    const PaperTree kept(maker.grids(), options);
    SampleStats stats_anew, stats_kept;
    for (int round = 0; round < 2000; ++round) {
        const SpaceRay ray{noise.point(5), noise.point(1), noise(0, 1)};
        const auto hit = [&](const PaperTree& tree, SampleStats& stats) {
            TraceRay trace_ray = TraceRay::turned(axis_ray(ray), {});
            ClosestHit policy;
            tree.trace(trace_ray, policy, stats);
            return policy.best;
        };
        ASSERT_EQ(hit(anew, stats_anew), hit(kept, stats_kept));
    }
    EXPECT_EQ(stats_anew.nodes_visited, stats_kept.nodes_visited);
    EXPECT_GT(stats_anew.predicate_hits, 100u);
}

TEST(PaperTree, AlongTheAxesToo) {
    Noise noise;
    GridMaker maker;
    add_torus(maker, 2);
    const PaperTree tree(maker.grids());
    for (int round = 0; round < 3000; ++round) {
        V3f direction(0);
        direction[round % 3] = round % 2 ? 1.0f : -1.0f;
        const SpaceRay ray{noise.point(3), direction, noise(0, 1)};
        ASSERT_EQ(tree.closest(ray, {}).value_or(kNoHit), closest_naively(maker.grids(), ray, {}));
    }
}

TEST(PaperTree, NoRayLeavesAClosedSurface) {
    for (const int keys : {1, 2, 5}) {
        Noise noise;
        GridMaker maker;
        add_torus(maker, keys);
        const PaperTree tree(maker.grids());
        int leaks = 0;
        for (int round = 0; round < 200000; ++round) {
            const float phi = noise(0, 6.28f), time = keys == 1 ? 0.0f : noise(0, 1);
            const V3f inside(3 * std::cos(phi) + time, 3 * std::sin(phi), -0.5f * time);
            leaks += !tree.closest({inside, noise.point(1), time}, {}).has_value();
        }
        EXPECT_EQ(leaks, 0) << keys << " keys";
    }
}

TEST(PaperTree, TakesAtMostTwentyBytesAMicropolygonWithTwoKeys) {
    for (const auto& [keys, limit] : {std::pair{1, 10.0}, {2, 20.0}}) {
        GridMaker maker;
        for (int n = 0; n < 400; ++n)
            maker.add(16, 16, keys, [n](int i, int j, float t) {
                return V3f(static_cast<float>(i + 16 * n), static_cast<float>(j), t);
            });
        const double bytes = static_cast<double>(PaperTree(maker.grids()).stats().tree_bytes);
        EXPECT_LE(bytes / static_cast<double>(maker.grids().micropolygon_count()), limit);
    }
}

TEST(PaperTree, OfNothingIsHitByNothing) {
    const Grids none;
    const PaperTree tree(none);
    EXPECT_FALSE(tree.any({V3f(0), V3f(0, 0, 1), 0}, {}));
    EXPECT_EQ(tree.stats().tree_nodes, 0u);
}

TEST(PaperTree, OneMicropolygonIsATree) {
    GridMaker maker;
    maker.add(1, 1, 1,
              [](int i, int j, float) { return V3f(static_cast<float>(i), static_cast<float>(j), 3); });
    const PaperTree tree(maker.grids());
    const std::optional<Hit> hit = tree.closest({V3f(0.5f, 0.5f, 1), V3f(0, 0, 2), 0}, {});
    ASSERT_TRUE(hit.has_value());
    EXPECT_EQ(hit->depth, 2);  // along the axis, whatever the length of the direction
    EXPECT_FALSE(tree.any({V3f(0.5f, 0.5f, 1), V3f(0, 0, -1), 0}, {}));
    EXPECT_FALSE(tree.any({V3f(0.5f, 0.5f, 1), V3f(0, 0, 1), 0}, {0, 1.5f}));
}

TEST(PaperTree, DegenerateGridsAreNoTrouble) {
    Noise noise;
    GridMaker maker;
    for (int n = 0; n < 300; ++n)
        maker.add(4, 4, 2, [](int, int, float) { return V3f(1, 2, 3); });  // all one point
    for (int n = 0; n < 300; ++n)
        maker.add(5, 5, 1,
                  [](int i, int, float) { return V3f(static_cast<float>(i), 0, 3); });  // all one line
    maker.add(2, 2, 1, [](int i, int j, float) { return V3f(3e38f * (i - 1), 3e38f * (j - 1), 3e38f); });
    maker.add(2, 2, 2, [](int i, int j, float t) { return V3f(1e-38f * i, 1e-38f * j, 1e-38f * t); });
    add_sheets(maker, 5, 2, noise);
    const PaperTree tree(maker.grids());
    for (int round = 0; round < 2000; ++round) {
        const SpaceRay ray{noise.point(5), noise.point(1), noise(0, 1)};
        ASSERT_EQ(tree.closest(ray, {}).value_or(kNoHit), closest_naively(maker.grids(), ray, {}));
    }
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(tree.any({V3f(nan), V3f(0, 0, 1), 0}, {}));
    EXPECT_FALSE(tree.any({V3f(0), V3f(0), 0}, {}));
}

/// Walks the top level; calls visit(index of node, grids below).
template <class Visit>
std::vector<uint32_t> walk(const TopLevel& top, size_t index, Visit&& visit) {
    const TopLink link = top.nodes[index].link;
    std::vector<uint32_t> below;
    if (link.is_leaf()) {
        below = {link.index()};
    } else {
        for (const size_t child : {2 * size_t{link.index()}, 2 * size_t{link.index()} + 1}) {
            const auto part = walk(top, child, visit);
            below.insert(below.end(), part.begin(), part.end());
        }
    }
    visit(index, below);
    return below;
}

/// Looks whether a node's box holds a vertex of some of the grids below at a time.
void expect_inside(const TopLevel& top, size_t index, const Grid& grid, Noise& noise) {
    const float time = noise(0, 1);
    const MotionSegment s = segment_at(time, top.key_count);
    const auto& column = top.axes_of(index).column;
    const KeyBox *box = top.boxes_of(index) + s.index, *next = top.key_count > 1 ? box + 1 : box;
    const V3f p = grid.vertex(static_cast<int>(noise.engine() % grid.shape.vertices_u()),
                              static_cast<int>(noise.engine() % grid.shape.vertices_v()), time);
    for (int k = 0; k < 3; ++k) {
        const float at = column[0][k] * p.x + column[1][k] * p.y + column[2][k] * p.z, slop = 1e-5f;
        ASSERT_GE(at + slop, box->low[k] + s.local * (next->low[k] - box->low[k]));
        ASSERT_LE(at - slop, box->high[k] + s.local * (next->high[k] - box->high[k]));
    }
}

TEST(PaperTree, EveryNodeHoldsTheVerticesBelowAtAnyTime) {
    Noise noise;
    GridMaker maker;
    for (const int keys : {1, 2, 3, 5}) add_sheets(maker, 8, keys, noise);
    const PaperTree tree(maker.grids());
    const TopLevel& top = tree.top();
    ASSERT_EQ(top.key_count, 5);
    size_t nodes = 0;
    const auto all = walk(top, top.nodes.size() - 1, [&](size_t index, const std::vector<uint32_t>& below) {
        ++nodes;
        for (int round = 0; round < 30; ++round)
            expect_inside(top, index, maker.grids().grids[below[noise.engine() % below.size()]], noise);
    });
    EXPECT_EQ(nodes, 2 * maker.grids().grids.size() - 1);
    EXPECT_EQ(std::set<uint32_t>(all.begin(), all.end()).size(), maker.grids().grids.size());
}

/// Nodes of more than 1024 grids are bounded from their children's boxes, each of which is turned: fibres
/// that all run alike, along no axis, keep such nodes oriented, in axes that differ.
TEST(PaperTree, NodesOfThousandsOfGridsHoldWhatIsBelow) {
    for (const int keys : {1, 2}) {
        Noise noise;
        GridMaker maker;
        for (int n = 0; n < 5000; ++n) {
            const V3f root = noise.point(1), way = V3f(6, 5, 4) + noise.point(0.3f),
                      shift = noise.point(0.5f), across = noise.point(0.01f);
            maker.add(1, 4, keys, [=](int i, int j, float t) {
                return root + way * (0.25f * static_cast<float>(j)) + across * static_cast<float>(i) +
                       shift * t;
            });
        }
        const PaperTree tree(maker.grids());
        const TopLevel& top = tree.top();
        size_t large = 0, turned = 0;
        walk(top, top.nodes.size() - 1, [&](size_t index, const std::vector<uint32_t>& below) {
            if (below.size() <= 1024) return;
            ++large;
            const uint32_t first = 2 * top.nodes[index].link.index();
            for (const uint32_t child : {first, first + 1})
                for (size_t row = 0; row < 3; ++row)
                    turned +=
                        !std::ranges::equal(top.axes_of(index).column[row], top.axes_of(child).column[row]);
            for (const uint32_t grid : below)
                for (int round = 0; round < 4; ++round)
                    expect_inside(top, index, maker.grids().grids[grid], noise);
        });
        EXPECT_GT(large, 3u);
        EXPECT_GT(turned, 0u);
        int hits = 0;
        for (int round = 0; round < 40; ++round) {
            const SpaceRay ray{noise.point(3), noise.point(1), noise(0, 1)};
            const Hit truth = closest_naively(maker.grids(), ray, {});
            ASSERT_EQ(tree.closest(ray, {}).value_or(kNoHit), truth);
            hits += truth != kNoHit;
        }
        EXPECT_GT(hits, 4);
    }
}

TEST(PaperTree, IsTheSameFromAnyNumberOfThreads) {
    Noise noise;
    GridMaker maker;
    add_sheets(maker, 3000, 2, noise);
    std::vector<UnsetVector<KeyBox>> boxes;
    for (const size_t threads : {1, 2, 7}) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        tbb::task_arena arena(static_cast<int>(threads));
        arena.execute([&] { boxes.push_back(PaperTree(maker.grids()).top().boxes); });
    }
    for (const size_t other : {1, 2})
        for (size_t i = 0; i < boxes[0].size(); ++i)
            for (int k = 0; k < 3; ++k) {
                ASSERT_EQ(boxes[0][i].low[k], boxes[other][i].low[k]);
                ASSERT_EQ(boxes[0][i].high[k], boxes[other][i].high[k]);
            }
}

TEST(PaperTree, LooksAtFewMicropolygons) {
    GridMaker maker;
    add_torus(maker, 2);
    const PaperTree tree(maker.grids());
    Noise noise;
    SampleStats stats;
    for (int round = 0; round < 2000; ++round) {
        TraceRay ray = TraceRay::turned(axis_ray({noise.point(5), noise.point(1), noise(0, 1)}), {});
        ClosestHit policy;
        tree.trace(ray, policy, stats);
    }
    EXPECT_EQ(stats.rays, 2000u);
    EXPECT_LT(static_cast<double>(stats.predicate_tests) / static_cast<double>(stats.rays), 20);  // of 6144
}

}  // namespace
}  // namespace trapeze
