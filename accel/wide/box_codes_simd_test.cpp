/// The SIMD forms that read a grid's segment and its boxes against their scalar meaning, on every target of
/// the machine: planes to kCodeRounding, by which boxes are larger than what they hold, for some targets fuse
/// a multiplication with an addition; all else to the bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "accel/wide/wide_tree.h"
#include "core/grids_harness.h"
#include "core/simd/targets_harness.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "accel/wide/box_codes_simd_test.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target

#include "accel/wide/box_codes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {

void read_in_vectors(const WideTree& tree, const WideGrid& grid, int segment, OrientedSegment& oriented,
                     BoxPlanes& boxes) {
    read_moving_segment(tree, grid, segment, oriented);
    decode_boxes<true>(tree, grid, segment, oriented, boxes);
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trapeze {
namespace {

using testing::for_each_target;

HWY_EXPORT(read_in_vectors);

/// Grids of every shape, ribbons among them, that turn, move and swell; some far from the origin.
void add_moving(testing::GridMaker& maker, int count, int keys) {
    std::mt19937 engine(7);
    const auto noise = [&](float reach) {
        return std::uniform_real_distribution<float>(-reach, reach)(engine);
    };
    for (int n = 0; n < count; ++n) {
        const float far = std::ldexp(1.0f, n % 12);
        const V3f origin(noise(far), noise(far), 3 * far), way(noise(2), noise(2), noise(1));
        const float turn = noise(3), size = 0.2f + std::abs(noise(1));
        const int nu = 1 + static_cast<int>(engine() % 16),
                  nv = n % 4 ? 1 + static_cast<int>(engine() % 16) : 1;
        maker.add(nu, nv, keys, [=](int i, int j, float t) {
            const float u = size * static_cast<float>(i) / static_cast<float>(nu),
                        v = size * static_cast<float>(j) / static_cast<float>(nv), angle = turn * t;
            return origin + way * t +
                   V3f(u * std::cos(angle) - v * std::sin(angle), u * std::sin(angle) + v * std::cos(angle),
                       std::sin(5 * u) * (1 + t));
        });
    }
}

/// What the two ways to compute planes between two ends may differ by.
float rounding_between(float low, float high) {
    return kCodeRounding * std::max(std::abs(low), std::abs(high));
}

void expect_same_bounds(const KeyBounds& read, const KeyBounds& expected) {
    for (int k = 0; k < 3; ++k) {
        const float rounding = rounding_between(expected.low[k], expected.high[k]);
        EXPECT_NEAR(read.low[k], expected.low[k], rounding) << k;
        EXPECT_NEAR(read.high[k], expected.high[k], rounding) << k;
    }
}

void expect_same_segment(const OrientedSegment& read, const OrientedSegment& expected) {
    for (int axis = 0; axis < 3; ++axis)
        for (int k = 0; k < 3; ++k) EXPECT_EQ(read.axes.axis[axis][k], expected.axes.axis[axis][k]);
    for (int end = 0; end < 2; ++end) expect_same_bounds(read.at[end], expected.at[end]);
    for (int k = 0; k < 3; ++k) {  // the box is of the planes that were read, to the bit
        EXPECT_EQ(read.box.low[k], read.at[0].low[k]);
        EXPECT_EQ(read.box.high[k], read.at[0].high[k]);
        EXPECT_EQ(read.box.low_delta[k], read.at[1].low[k] - read.at[0].low[k]);
        EXPECT_EQ(read.box.high_delta[k], read.at[1].high[k] - read.at[0].high[k]);
    }
}

/// Planes of all boxes equal what their codes say between the planes of `oriented`.
void expect_same_boxes(const BoxPlanes& read, const WideTree& tree, const WideGrid& grid, int segment,
                       const OrientedSegment& oriented) {
    const GridKeys keys(grid, tree.keys_of(grid));
    const auto boxes = static_cast<size_t>(grid.box_count());
    for (size_t k = 0; k < 6; ++k) {
        const size_t axis = k % 3;
        const auto plane = [&](int end, size_t b) {
            const KeyBounds& whole = oriented.at[end];
            return CodeScale(whole.low[axis], whole.high[axis])
                .plane(keys.box_codes(segment + end)[k * boxes + b]);
        };
        const auto rounding = [&](int end) {
            return rounding_between(oriented.at[end].low[axis], oriented.at[end].high[axis]);
        };
        for (size_t b = 0; b < boxes; ++b) {
            EXPECT_NEAR(read.row(k)[b], plane(0, b), rounding(0)) << k << ' ' << b;
            EXPECT_NEAR(read.row(6 + k)[b], plane(1, b) - plane(0, b), rounding(0) + rounding(1))
                << k << ' ' << b;
        }
    }
}

void compare(const WideTree& tree, size_t grids) {
    for (uint32_t index = 0; index < grids && !::testing::Test::HasFailure(); ++index) {
        const WideGrid& grid = tree.grid(index);
        for (int segment = 0; segment + 1 < grid.key_count; ++segment) {
            SCOPED_TRACE(::testing::Message() << "grid " << index << " segment " << segment);
            OrientedSegment read, expected;
            BoxPlanes boxes;
            HWY_DYNAMIC_DISPATCH(read_in_vectors)(tree, grid, segment, read, boxes);
            tree.read_segment(grid, segment, expected);
            expect_same_segment(read, expected);
            expect_same_boxes(boxes, tree, grid, segment, read);
        }
    }
}

TEST(BoxCodesSimd, SegmentsAndBoxesEqualTheScalarFormOnEveryTarget) {
    for (const int keys : {2, 3, 5}) {
        testing::GridMaker maker;
        add_moving(maker, 200, keys);
        const WideTree tree(maker.grids(), {});
        ASSERT_TRUE(tree.unbounded_grids().empty());
        for_each_target([&] { compare(tree, maker.grids().grids.size()); });
    }
}

}  // namespace
}  // namespace trapeze
#endif  // HWY_ONCE
