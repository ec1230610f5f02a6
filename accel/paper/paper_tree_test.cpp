/// The reference tree against testing every micropolygon, bit for bit and in all directions; closed surfaces
/// without leaks; bounds that hold vertices at all times; memory; degenerate grids.
#include "accel/paper/paper_tree.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <limits>
#include <random>
#include <set>

#include "accel/rays_harness.h"

namespace trapeze {
namespace {

using testing::add_sheets;
using testing::closest_naively;
using testing::GridMaker;
using testing::Noise;

/// A closed, bumpy, moving torus whose shared vertices are the same bits on both sides.
void add_torus(GridMaker& maker, int keys) {
    constexpr int kAround = 6, kAcross = 4;  // grids
    const auto vertex = [](int i, int j, float t) {
        constexpr float kTurn = 6.2831853f;
        const float phi = kTurn * static_cast<float>(i % (16 * kAround)) / (16 * kAround);
        const float theta = kTurn * static_cast<float>(j % (16 * kAcross)) / (16 * kAcross);
        const float r = 1 + 0.1f * std::sin(5 * phi) + 0.2f * t * std::cos(phi);
        const float ring = 3 + r * std::cos(theta);
        return V3f(ring * std::cos(phi) + t, ring * std::sin(phi), r * std::sin(theta) - 0.5f * t);
    };
    for (int gu = 0; gu < kAround; ++gu)
        for (int gv = 0; gv < kAcross; ++gv)
            maker.add(16, 16, keys,
                      [&](int i, int j, float t) { return vertex(16 * gu + i, 16 * gv + j, t); });
}

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
        const auto& column = top.frame_of(index).column;
        for (int round = 0; round < 30; ++round) {
            const float time = noise(0, 1);
            const MotionSegment s = segment_at(time, top.key_count);
            const KeyBox* box = top.boxes_of(index) + s.index;
            const Grid& grid = maker.grids().grids[below[noise.engine() % below.size()]];
            const V3f p = grid.vertex(static_cast<int>(noise.engine() % grid.shape.vertices_u()),
                                      static_cast<int>(noise.engine() % grid.shape.vertices_v()), time);
            for (int k = 0; k < 3; ++k) {
                const float at = column[0][k] * p.x + column[1][k] * p.y + column[2][k] * p.z, slop = 1e-5f;
                ASSERT_GE(at + slop, box[0].low[k] + s.local * (box[1].low[k] - box[0].low[k]));
                ASSERT_LE(at - slop, box[0].high[k] + s.local * (box[1].high[k] - box[0].high[k]));
            }
        }
    });
    EXPECT_EQ(nodes, 2 * maker.grids().grids.size() - 1);
    EXPECT_EQ(std::set<uint32_t>(all.begin(), all.end()).size(), maker.grids().grids.size());
}

TEST(PaperTree, IsTheSameFromAnyNumberOfThreads) {
    Noise noise;
    GridMaker maker;
    add_sheets(maker, 3000, 2, noise);
    std::vector<std::vector<KeyBox>> boxes;
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
