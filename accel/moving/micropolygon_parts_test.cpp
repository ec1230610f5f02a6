#include "accel/moving/micropolygon_parts.h"

#include <gtest/gtest.h>

#include "accel/moving/key_boxes.h"
#include "core/hyper_trapezoid.h"
#include "core/noise_harness.h"

namespace trapeze {
namespace {

using testing::Noise;

/// Random corners; every fourth pose is a line, every fifth a point.
QuadPose noisy_pose(Noise& noise, int round) {
    QuadPose pose;
    for (V3f& corner : pose) corner = noise.point(3);
    if (round % 4 == 1) pose[2] = pose[0], pose[3] = pose[1];
    if (round % 5 == 2) pose.fill(pose[0]);
    return pose;
}

/// Weights on the corners of a point of one of the two triangles.
std::array<float, 4> weights_of_point(Noise& noise, bool lower) {
    float a = noise(0, 1), b = noise(0, 1);
    if (a + b > 1) a = 1 - a, b = 1 - b;
    return lower ? std::array<float, 4>{1 - a - b, a, 0, b} : std::array<float, 4>{1 - a - b, 0, a, b};
}

V3f point_of(const QuadPose& pose, const std::array<float, 4>& weights) {
    V3f at(0);
    for (size_t c = 0; c < 4; ++c) at += pose[c] * weights[c];
    return at;
}

Box3f grown_by(const Box3f& box, float slack) {
    return {box.min - V3f(slack), box.max + V3f(slack)};
}

TEST(MicropolygonParts, OfAPlaneHoldAllPointsOfTheirSides) {
    Noise noise;
    for (int round = 0; round < 2000; ++round) {
        const QuadPose pose = noisy_pose(noise, round);
        const int axis = round % 3;
        const Box3f whole = box_of(pose);
        const float at = round % 7 == 0 ? pose[1][axis] : noise(whole.min[axis], whole.max[axis]);
        const Chopped parts = chop(pose, whole, axis, at);
        for (int n = 0; n < 20; ++n) {
            const V3f point = point_of(pose, weights_of_point(noise, n % 2));
            const Box3f& side = point[axis] < at ? parts.low : parts.high;
            ASSERT_TRUE(grown_by(side, part_slack(pose)).intersects(point)) << round;
        }
        EXPECT_TRUE(parts.low.isEmpty() || parts.low.max[axis] <= at);
        EXPECT_TRUE(parts.high.isEmpty() || parts.high.min[axis] >= at);
    }
}

TEST(MicropolygonParts, AreSmallerThanBoxesThatAreCut) {
    const QuadPose needle{V3f(0, 0, 0), V3f(.1f, 0, 0), V3f(8, 8, 8), V3f(8.1f, 8, 8)};
    const Chopped parts = chop(needle, box_of(needle), 0, 4);
    EXPECT_NEAR(parts.low.max.y, 4, .1f);
    EXPECT_NEAR(parts.high.min.z, 3.9f, .1f);
}

TEST(MicropolygonParts, GoWithTheCornersWhereverTheyAre) {
    Noise noise;
    size_t inside = 0;
    for (int round = 0; round < 6000; ++round) {
        const QuadPose middle = noisy_pose(noise, round), then = noisy_pose(noise, round / 2);
        Box3f box;
        box.extendBy(noise.point(3)), box.extendBy(noise.point(3));
        const MicropolygonPart part(middle, box);
        const Box3f moved = part.box_when(then);
        for (int n = 0; n < 20; ++n) {
            const auto weights = weights_of_point(noise, n % 2);
            if (!box.intersects(point_of(middle, weights))) continue;
            ++inside;
            ASSERT_TRUE(grown_by(moved, part_slack(then)).intersects(point_of(then, weights))) << round;
        }
    }
    EXPECT_GT(inside, 5000u);
}

TEST(MicropolygonParts, ThatAreNotThereAreEmpty) {
    const QuadPose pose{V3f(0, 0, 0), V3f(1, 0, 0), V3f(0, 1, 0), V3f(1, 1, 0)};
    EXPECT_TRUE(MicropolygonPart(pose, {V3f(2, 0, 0), V3f(3, 1, 1)}).is_empty());
    EXPECT_FALSE(MicropolygonPart(pose, {V3f(1, 0, 0), V3f(3, 1, 1)}).is_empty());
}

Box3f box_at(const std::vector<Box3f>& keys, float time) {
    const MotionSegment s = segment_at(time, static_cast<int>(keys.size()));
    if (keys.size() == 1) return keys[0];
    const Box3f &a = keys[static_cast<size_t>(s.index)], &b = keys[static_cast<size_t>(s.index) + 1];
    return {a.min + (b.min - a.min) * s.local, a.max + (b.max - a.max) * s.local};
}

TEST(KeyBoxes, OfAnyNumberOfKeysHoldTheOthersAtAllTimes) {
    Noise noise;
    for (const size_t from_count : {1, 2, 3, 5, 17})
        for (const size_t to_count : {1, 2, 3, 5, 9, 65})
            for (int round = 0; round < 20; ++round) {
                std::vector<Box3f> from(from_count), to(to_count);
                for (Box3f& box : from) box.extendBy(noise.point(2)), box.extendBy(noise.point(2));
                std::vector<BoxSum> sums(to_count);
                add_at_keys(from, sums);
                for (size_t key = 0; key < to_count; ++key) to[key] = grown_for_rounding(sums[key].box());
                for (int n = 0; n <= 64; ++n) {
                    const float time = static_cast<float>(n) / 64;
                    const Box3f small = box_at(from, time), large = grown_for_rounding(box_at(to, time));
                    ASSERT_TRUE(large.intersects(small.min) && large.intersects(small.max))
                        << from_count << " keys to " << to_count << " at " << time;
                }
            }
}

}  // namespace
}  // namespace trapeze
