#include "accel/moving/cut_planes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "accel/moving/micropolygon_parts.h"
#include "accel/moving/spatial_topology.h"
#include "core/noise_harness.h"

namespace trapeze {
namespace {

using testing::Noise;

/// chop() in plain code.
Chopped chop_by_points(const QuadPose& pose, const Box3f& box, int axis, float at) {
    Chopped parts;
    const auto extend = [](Box3f& part, const V3f& point) {
        for (int k = 0; k < 3; ++k) {
            part.min[k] = std::min(part.min[k], point[k]);
            part.max[k] = std::max(part.max[k], point[k]);
        }
    };
    for (const V3f& corner : pose) {
        if (corner[axis] <= at) extend(parts.low, corner);
        if (corner[axis] >= at) extend(parts.high, corner);
    }
    constexpr std::array<std::array<size_t, 2>, 5> kEdges{{{0, 1}, {1, 3}, {3, 2}, {2, 0}, {0, 3}}};
    for (const auto& [i, j] : kEdges) {
        const V3f &a = pose[i], &b = pose[j];
        if ((a[axis] < at) == (b[axis] < at) || a[axis] == at || b[axis] == at) continue;
        V3f crossing = a + (b - a) * ((at - a[axis]) / (b[axis] - a[axis]));
        crossing[axis] = at;
        extend(parts.low, crossing), extend(parts.high, crossing);
    }
    for (Box3f* part : {&parts.low, &parts.high})
        for (int k = 0; k < 3; ++k)
            part->min[k] = std::max(part->min[k], box.min[k]),
            part->max[k] = std::min(part->max[k], box.max[k]);
    return parts;
}

QuadPose pose_about(Noise& noise, float extent) {
    const V3f at = noise.point(3);
    QuadPose pose;
    for (V3f& corner : pose) corner = at + noise.point(extent);
    return pose;
}

void expect_same(const Box3f& a, const Box3f& b, int round) {
    ASSERT_EQ(a.isEmpty(), b.isEmpty()) << round;
    if (a.isEmpty()) return;
    EXPECT_EQ(a.min, b.min) << round;
    EXPECT_EQ(a.max, b.max) << round;
}

/// Whole and cut before; planes through corners and beside all; lines and points.
TEST(CutPlanes, ChopsInVectorsAsInPlainCode) {
    Noise noise;
    for (int round = 0; round < 20000; ++round) {
        QuadPose pose = pose_about(noise, 2.0f);
        if (round % 4 == 1) pose[2] = pose[0], pose[3] = pose[1];
        if (round % 5 == 2) pose.fill(pose[0]);
        const int axis = round % 3;
        if (round % 6 == 3) pose[3][axis] = pose[1][axis];
        Box3f box = box_of(pose);
        if (round % 2) box.min.y += .3f, box.max.x -= .2f;
        const float at = round % 7 == 0 ? pose[static_cast<size_t>(round / 7 % 4)][axis] : noise(-6, 6);
        const Chopped vectors = chop(pose, box, axis, at), plain = chop_by_points(pose, box, axis, at);
        expect_same(vectors.low, plain.low, round);
        expect_same(vectors.high, plain.high, round);
    }
}

/// What a plane costs by its definition; infinite if it leaves nothing on a side.
double cost_of_plane(std::span<const SahItem> references, const std::vector<QuadPose>& poses, bool tight,
                     const Box3f& node, int axis, float at) {
    Box3f low, high;
    double low_count = 0, high_count = 0;
    for (const SahItem& item : references) {
        Box3f below = item.box, above = item.box;
        below.max[axis] = std::min(below.max[axis], at), above.min[axis] = std::max(above.min[axis], at);
        if (tight) {
            const Chopped parts = chop(poses[item.id], item.box, axis, at);
            below = parts.low, above = parts.high;
        }
        if (item.box.min[axis] < at) low.extendBy(below), ++low_count;
        if (item.box.max[axis] >= at) high.extendBy(above), ++high_count;
    }
    if (low_count == 0 || high_count == 0) return std::numeric_limits<double>::infinity();
    return half_area(node) * kTraversalCost + half_area(low) * low_count + half_area(high) * high_count;
}

/// By numbers of references: small nodes have four slabs, large ones up to sixteen.
class CutPlanesOfNodes : public ::testing::TestWithParam<size_t> {};

TEST_P(CutPlanesOfNodes, CostLeast) {
    const size_t count = GetParam(), slabs = std::clamp(count / 4, size_t{4}, size_t{16});
    Noise noise;
    for (int round = 0; round < 40; ++round) {
        std::vector<QuadPose> poses;
        std::vector<LanePose> lanes;
        std::vector<SahItem> items;
        Box3f node;
        for (uint32_t i = 0; i < count; ++i) {
            poses.push_back(pose_about(noise, round % 2 ? 2.0f : .4f));
            lanes.emplace_back(poses.back());
            items.push_back({box_of(poses.back()), 1, i});
            node.extendBy(items.back().box);
        }
        const auto best_along = [&](int axis, bool tight) {
            double least = std::numeric_limits<double>::infinity();
            for (size_t i = 1; i < slabs; ++i) {
                const float at = node.min[axis] + (node.max[axis] - node.min[axis]) *
                                                      (static_cast<float>(i) / static_cast<float>(slabs));
                least = std::min(least, cost_of_plane(items, poses, tight, node, axis, at));
            }
            return least;
        };
        const Cut rough = CutPlanes({}, false).best(items, node, 0);
        double least = std::numeric_limits<double>::infinity();
        for (int axis = 0; axis < 3; ++axis) least = std::min(least, best_along(axis, false));
        ASSERT_NEAR(rough.cost, least, 1e-5 * least) << round;
        EXPECT_LE(rough.least, rough.cost);
        const Cut tight = CutPlanes(lanes, true).best(items, node, std::numeric_limits<double>::infinity());
        const double least_tight = best_along(rough.axis, true);
        ASSERT_NEAR(tight.cost, least_tight, 1e-5 * least_tight) << round;
        EXPECT_EQ(tight.axis, rough.axis);
        EXPECT_LE(rough.least, tight.cost);
        EXPECT_NEAR(cost_of_plane(items, poses, true, node, tight.axis, tight.at), tight.cost,
                    1e-5 * tight.cost);
        // Nothing is looked for where no plane can pay.
        EXPECT_FALSE(std::isfinite(CutPlanes(lanes, true).best(items, node, rough.least).cost));
    }
}

INSTANTIATE_TEST_SUITE_P(References, CutPlanesOfNodes, ::testing::Values(3, 8, 19, 20, 50, 300));

}  // namespace
}  // namespace trapeze
