/// The wide tree's single rays against the paper's tree, its boxes against the vertices that they hold, and
/// the memory that it takes. (Bundles are tested in sample, against all other methods.)
#include "accel/wide/wide_tree.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstring>
#include <random>

#include "accel/paper/paper_tree.h"
#include "core/grids_harness.h"
#include "core/noise_harness.h"

namespace trapeze {
namespace {

using testing::GridMaker;
using testing::Noise;

/// Adds waves on grids of every shape, ribbons among them, each on a way of its own.
void add_waves(GridMaker& maker, int count, int keys, Noise& noise) {
    for (int n = 0; n < count; ++n) {
        const V3f origin = noise.point(4), along_u = noise.point(2), along_v = noise.point(n % 4 ? 2 : 0.02f),
                  shift = noise.point(1);
        const int nu = 1 + static_cast<int>(noise.engine() % 16),
                  nv = n % 4 ? 1 + static_cast<int>(noise.engine() % 16) : 1;
        maker.add(nu, nv, keys, [=](int i, int j, float t) {
            const float u = static_cast<float>(i) / static_cast<float>(nu),
                        v = static_cast<float>(j) / static_cast<float>(nv);
            return origin + along_u * u + along_v * v + V3f(0, 0.2f * std::sin(8 * u + 5 * v), 0) +
                   shift * (t * t);
        });
    }
}

TEST(WideTree, ClosestAndAnyInAllDirectionsEqualThePaperTrees) {
    for (const int keys : {1, 2, 5}) {
        Noise noise{std::mt19937(19)};
        GridMaker maker;
        add_waves(maker, 120, keys, noise);
        add_waves(maker, 20, 1, noise);
        const PaperTree paper(maker.grids());
        const WideTree wide(maker.grids(), {});
        int hits = 0;
        for (int round = 0; round < 20000; ++round) {
            V3f direction = noise.point(1);
            if (round % 5 == 0) direction[round % 3] = 0;  // along a plane of the axes
            if (round % 15 == 0) direction = V3f(0), direction[round / 15 % 3] = round % 2 ? 1.0f : -1.0f;
            const SpaceRay ray{noise.point(5), direction, noise(0, 1)};
            const DepthRange range{noise(-1, 1), noise(2, 8)};
            const std::optional<Hit> closest = paper.closest(ray, range);
            ASSERT_EQ(wide.closest(ray, range), closest) << round;
            ASSERT_EQ(wide.any(ray, range), closest.has_value()) << round;
            hits += closest.has_value();
        }
        EXPECT_GT(hits, 2000);
    }
}

TEST(WideTree, GridsBeyondBoundsAreSeen) {
    GridMaker maker;
    maker.add(1, 1, 1, [](int i, int j, float) {
        return V3f(1e16f * (static_cast<float>(i) - 0.5f), 1e16f * (static_cast<float>(j) - 0.5f), 100);
    });
    const WideTree tree(maker.grids(), {});
    EXPECT_EQ(tree.unbounded_grids().size(), 1u);
    EXPECT_TRUE(tree.any({V3f(0), V3f(0.1f, 0.2f, 1), 0}, {}));
    EXPECT_FALSE(tree.any({V3f(0), V3f(0.1f, 0.2f, -1), 0}, {}));
}

TEST(WideTree, OfNothingIsHitByNothing) {
    const Grids none;
    const WideTree tree(none, {});
    EXPECT_FALSE(tree.closest({V3f(0), V3f(0, 0, 1), 0}, {}));
    EXPECT_EQ(tree.node_count(), 0u);
}

/// Every box, interpolated at any time, holds the vertices of its blocks.
TEST(WideTree, BoxesHoldTheirVerticesAtAnyTime) {
    for (const int keys : {1, 2, 9}) {
        Noise noise{std::mt19937(19)};
        GridMaker maker;
        add_waves(maker, 60, keys, noise);
        const WideTree tree(maker.grids(), {});
        for (uint32_t g = 0; g < maker.grids().grids.size(); ++g) {
            const Grid& grid = maker.grids().grids[g];
            const WideGrid& record = tree.grid(g);
            const MovingBox whole = tree.grid_box(record);
            const GridAxes axes = record.axes.unpacked();
            const float time = noise(0, 1);
            const MotionSegment segment = segment_at(time, grid.key_count);
            BoxPlanes boxes;
            tree.decode(record, segment.index, boxes);
            for (int j = 0; j <= grid.shape.nv; ++j)
                for (int i = 0; i <= grid.shape.nu; ++i) {
                    const V3f p = grid.vertex(i, j, time);
                    const int u = std::min(i / 4, record.blocks_u() - 1),
                              v = std::min(j / 4, record.blocks_v() - 1);
                    const int box = (v * record.blocks_u() + u) / record.blocks_per_box();
                    for (int k = 0; k < 3; ++k) {
                        ASSERT_GE(p[k], whole.low[k] + time * whole.low_delta[k]);
                        ASSERT_LE(p[k], whole.high[k] + time * whole.high_delta[k]);
                        const float* axis = axes.axis[k];
                        const float at = axis[0] * p.x + axis[1] * p.y + axis[2] * p.z;
                        const float low_delta = keys > 1 ? boxes.row(6 + static_cast<size_t>(k))[box] : 0.0f;
                        const float high_delta = keys > 1 ? boxes.row(9 + static_cast<size_t>(k))[box] : 0.0f;
                        ASSERT_GE(at, boxes.row(static_cast<size_t>(k))[box] + segment.local * low_delta);
                        ASSERT_LE(at,
                                  boxes.row(3 + static_cast<size_t>(k))[box] + segment.local * high_delta);
                    }
                }
        }
    }
}

/// The boxes of children on the way from the root to a grid.
struct Path {
    std::vector<std::pair<uint32_t, int>> steps;  ///< node, child
};

/// Calls visit(grid, path) for all grids below a node.
template <class Visit>
void walk(const WideTree& tree, uint32_t node, Path& path, const Visit& visit) {
    for (int i = 0; i < WideNode::kChildren; ++i) {
        const uint32_t link = tree.nodes()[node].child[i];
        if (link == kNoLink) continue;
        path.steps.emplace_back(node, i);
        if (link & kGridLink)
            visit(link & ~kGridLink, path);
        else
            walk(tree, link, path, visit);
        path.steps.pop_back();
    }
}

/// Every box above grids, at any time, holds all that is below; every grid is below the root once.
TEST(WideTree, BoxesHoldTheirSubtreesAtAnyTime) {
    for (const int keys : {1, 2, 9}) {
        Noise noise{std::mt19937(19)};
        GridMaker maker;
        add_waves(maker, 3000, keys, noise);
        const WideTree tree(maker.grids(), {});
        std::vector<int> times_met(maker.grids().grids.size(), 0);
        size_t deepest = 0;
        Path path;
        walk(tree, 0, path, [&](uint32_t index, const Path& way) {
            ++times_met[index];
            deepest = std::max(deepest, way.steps.size());
            const Grid& grid = maker.grids().grids[index];
            for (const float time : {0.0f, noise(0, 1), noise(0, 1), 1.0f}) {
                Box3f box;
                for (int j = 0; j <= grid.shape.nv; ++j)
                    for (int i = 0; i <= grid.shape.nu; ++i) box.extendBy(grid.vertex(i, j, time));
                for (const auto& [node, child] : way.steps)
                    for (int k = 0; k < 3; ++k) {
                        float low = tree.nodes()[node].low[k][child],
                              high = tree.nodes()[node].high[k][child];
                        if (tree.moves()) {
                            const WideNodeMotion& motion = tree.node_motions()[node];
                            low += time * from_bfloat16(motion.low[k][child]);
                            high += time * from_bfloat16(motion.high[k][child]);
                        }
                        ASSERT_LE(low, box.min[k]) << "grid " << index << ", node " << node;
                        ASSERT_GE(high, box.max[k]) << "grid " << index << ", node " << node;
                    }
            }
        });
        for (const int times : times_met) ASSERT_EQ(times, 1);
        EXPECT_GE(deepest, 3u);
    }
}

/// What grids of 16 x 16 and of 6 x 6 micropolygons take, ribbons of 16, and what turns in many segments.
TEST(WideTree, TakesFewBytesAMicropolygon) {
    const auto bytes = [](int nu, int nv, int keys, int grids) {
        GridMaker maker;
        for (int n = 0; n < grids; ++n)
            maker.add(nu, nv, keys, [n](int i, int j, float t) {
                const auto x = static_cast<float>(n % 64 * 16 + i), y = static_cast<float>(n / 64 * 16 + j);
                return V3f(x, y, 50 + std::sin(x * 0.1f) + t);
            });
        return static_cast<double>(WideTree(maker.grids(), {}).stats().tree_bytes) /
               static_cast<double>(maker.grids().micropolygon_count());
    };
    EXPECT_LT(bytes(16, 16, 1, 4096), 0.8);
    EXPECT_LT(bytes(16, 16, 2, 4096), 1.3);
    EXPECT_LT(bytes(16, 16, 33, 1024), 15.0);
    EXPECT_LT(bytes(6, 6, 2, 4096), 5.0);
    EXPECT_LT(bytes(16, 1, 1, 16384), 7.0);
    EXPECT_LT(bytes(16, 1, 2, 16384), 9.0);
}

TEST(WideTree, IsTheSameFromAnyNumberOfThreads) {
    Noise noise{std::mt19937(19)};
    GridMaker maker;
    add_waves(maker, 3000, 2, noise);
    std::vector<std::vector<WideNode>> built;
    for (const size_t threads : {1, 2, 7}) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        const WideTree tree(maker.grids(), {});
        built.emplace_back(tree.nodes(), tree.nodes() + tree.node_count());
    }
    for (const auto& nodes : built) {
        ASSERT_EQ(nodes.size(), built[0].size());
        EXPECT_EQ(std::memcmp(nodes.data(), built[0].data(), nodes.size() * sizeof(WideNode)), 0);
    }
}

}  // namespace
}  // namespace trapeze
