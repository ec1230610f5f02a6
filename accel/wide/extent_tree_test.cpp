/// Visits of a tree over extents, next to testing all of them.
#include "accel/wide/extent_tree.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <set>

#include "core/simd/targets_harness.h"

namespace trapeze {
namespace {

using testing::for_each_target;

GridExtent box(const V3f& middle, float half, float largest_micropolygon) {
    GridExtent extent{};
    extent.absolute_max = 0;
    for (KeyBounds& bounds : extent.box.at)
        for (int k = 0; k < 3; ++k) {
            bounds.low[k] = middle[k] - half, bounds.high[k] = middle[k] + half;
            extent.absolute_max = std::max(extent.absolute_max, std::abs(middle[k]) + half);
        }
    extent.largest_micropolygon = largest_micropolygon;
    return extent;
}

TraceRay ray_of(const V3f& origin, const V3f& direction, DepthRange range) {
    return TraceRay::turned(axis_ray({origin, direction, 0}), range);
}

std::set<uint32_t> visited(const ExtentTree& tree, TraceRay ray) {
    std::set<uint32_t> numbers;
    tree.visit(ray, [&](uint32_t number, float) { EXPECT_TRUE(numbers.insert(number).second); });
    return numbers;
}

/// Whether a ray comes within a box, in doubles.
bool meets(const V3f& middle, float half, const V3f& origin, const V3f& direction, float max) {
    double from = 0, to = max;
    for (int k = 0; k < 3; ++k) {
        const double a = (double(middle[k]) - half - origin[k]) / direction[k];
        const double b = (double(middle[k]) + half - origin[k]) / direction[k];
        from = std::max(from, std::min(a, b)), to = std::min(to, std::max(a, b));
    }
    return from <= to;
}

TEST(ExtentTree, VisitsAllThatARayMeetsAndLittleElse) {
    std::minstd_rand bits;
    const auto number = [&](float low, float high) {
        return std::uniform_real_distribution<float>(low, high)(bits);
    };
    std::vector<V3f> middles;
    std::vector<float> halves;
    std::vector<GridExtent> extents;
    for (int i = 0; i < 1000; ++i) {
        middles.emplace_back(number(-10, 10), number(-10, 10), number(-10, 10));
        halves.push_back(number(.1f, 1.5f));
        extents.push_back(box(middles.back(), halves.back(), .01f));
    }
    const ExtentTree tree(extents);
    size_t met = 0, seen = 0;
    for (int i = 0; i < 2000; ++i) {
        const V3f origin(number(-12, 12), number(-12, 12), number(-12, 12));
        const V3f direction = V3f(number(-1, 1), number(-1, 1), number(-1, 1)).normalized();
        const float axis = std::max({std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)});
        const float max = number(0, 30);
        const std::set<uint32_t> found = visited(tree, ray_of(origin, direction, {0, max * axis}));
        for (uint32_t b = 0; b < extents.size(); ++b)
            if (meets(middles[b], halves[b], origin, direction, max)) {
                ++met;
                ASSERT_TRUE(found.contains(b)) << i;
            }
        seen += found.size();
    }
    EXPECT_GT(met, 2000u);
    EXPECT_LT(seen, met * 11 / 10) << "boxes grow by a micropolygon";
}

/// A sky has micropolygons as large as all that is near.
TEST(ExtentTree, WhatIsFarAwayDoesNotWidenWhatIsNear) {
    std::vector<GridExtent> extents;
    for (int i = 0; i < 100; ++i) extents.push_back(box(V3f(1.0f + i, 0, 0), .1f, .01f));
    for (int i = 0; i < 100; ++i) extents.push_back(box(V3f(-1000, 40.0f * i, 1e6f), 20, 20));
    const ExtentTree tree(extents);
    const std::set<uint32_t> found = visited(tree, ray_of(V3f(0, 0, 0), V3f(1, 0, 0), {0, 5.5f}));
    EXPECT_EQ(found, (std::set<uint32_t>{0, 1, 2, 3, 4}));
}

/// Next to clip() and meets(), child by child, on every instruction set: where things move, where rays are
/// parallel to axes, and in nodes of any number of children.
TEST(ExtentTree, ChildrenAreMetAsOneByOne) {
    std::minstd_rand bits;
    const auto number = [&](float low, float high) {
        return std::uniform_real_distribution<float>(low, high)(bits);
    };
    int met = 0, missed = 0;
    for (int round = 0; round < 3000; ++round) {
        ExtentNode node;
        node.count = static_cast<uint32_t>(round % (ExtentNode::kChildren + 1));
        const bool moves = round % 2 == 0;
        std::array<KeyBox, ExtentNode::kChildren> from, to;
        for (size_t i = 0; i < node.count; ++i) {
            node.coordinate[i] = number(0, 20), node.extent[i] = number(0, .1f), node.link[i] = kGridLink;
            for (int k = 0; k < 3; ++k) {
                from[i].low[k] = number(-10, 9), from[i].high[k] = from[i].low[k] + number(0, 8);
                node.low[k][i] = from[i].low[k], node.high[k][i] = from[i].high[k];
                to[i].low[k] = from[i].low[k] + (moves ? number(-2, 2) : 0);
                to[i].high[k] = to[i].low[k] + from[i].high[k] - from[i].low[k];
                if (!moves) to[i].high[k] = from[i].high[k];
                node.low_delta[k][i] = to[i].low[k] - from[i].low[k];
                node.high_delta[k][i] = to[i].high[k] - from[i].high[k];
            }
        }
        const V3f origin(number(-12, 12), number(-12, 12), number(-12, 12));
        V3f direction = V3f(number(-5, 5), number(-5, 5), number(-5, 5)) - origin;
        if (round % 5 == 0) direction[round % 3] = 0;
        const float min = round % 3 == 0 ? 0.0f : number(0, 5);
        const TraceRay ray = TraceRay::turned(
            axis_ray({origin, direction, number(0, 1)}),
            {min, round % 4 == 0 ? std::numeric_limits<float>::infinity() : min + number(0, 15)});
        const RayInAxes ray_in_axes(ray);
        std::array<float, ExtentNode::kChildren> depth;
        std::array<bool, ExtentNode::kChildren> expected;
        for (size_t i = 0; i < node.count; ++i) {
            const float pad = ray.rounding(node.coordinate[i]);
            expected[i] = clip(ray_in_axes, from[i], to[i], ray.axis.time, pad)
                              .meets(ray, node.extent[i] + pad, depth[i]);
            ++(expected[i] ? met : missed);
        }
        for_each_target([&] {
            alignas(64) float depths[ExtentNode::kChildren];
            const uint32_t found = children_met(node, moves, ray_in_axes, ray, depths);
            ASSERT_EQ(found >> node.count, 0u);
            for (size_t i = 0; i < node.count; ++i) {
                ASSERT_EQ((found >> i & 1) != 0, expected[i]) << round;
                ASSERT_EQ(expected[i] ? depths[i] : depth[i], depth[i]) << round;
            }
        });
    }
    EXPECT_GT(met, 800);
    EXPECT_GT(missed, 9000);
}

TEST(ExtentTree, DepthsAreBoundsAndRangesMayBeDrawnIn) {
    std::vector<GridExtent> extents;
    for (int i = 0; i < 50; ++i) extents.push_back(box(V3f(0, 0, 2.0f + 2 * i), .5f, .01f));
    extents.push_back(box(V3f(0, 0, 0), 1, 1));
    extents.back().absolute_max = std::numeric_limits<float>::infinity();
    const ExtentTree tree(extents);
    TraceRay ray = ray_of(V3f(0, 0, 0), V3f(0, 0, 1), {0, 1000});
    std::vector<uint32_t> order;
    tree.visit(ray, [&](uint32_t number, float depth) {
        order.push_back(number);
        if (number == 50) return;
        EXPECT_LE(depth, 1.5f + 2 * static_cast<float>(number));
        EXPECT_GE(depth, 1.4f + 2 * static_cast<float>(number));
        if (number == 2) ray.t_max = 6;
    });
    EXPECT_EQ(order, (std::vector<uint32_t>{50, 0, 1, 2})) << "what has no bounds first";
}

}  // namespace
}  // namespace trapeze
