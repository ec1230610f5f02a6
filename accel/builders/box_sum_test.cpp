#include "accel/builders/box_sum.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/hyper_trapezoid.h"
#include "core/noise_harness.h"

namespace trapeze {
namespace {

using testing::Noise;

bool same(const Box3f& a, const Box3f& b) {
    return a.min == b.min && a.max == b.max;
}

TEST(BoxSum, IsWhatExtendBySays) {
    Noise noise;
    for (int turn = 0; turn < 200; ++turn) {
        BoxSum sum, half;
        Box3f box;
        EXPECT_TRUE(same(sum.box(), box));
        for (int n = 0; n < 6; ++n) {
            Box3f one(noise.point(3, -5, 5));
            if (n % 3 == 0) one.makeEmpty();
            if (n % 3 == 1) one.extendBy(noise.point(3, -5, 5));
            if (turn % 7 == n) one.min.x = std::numeric_limits<float>::quiet_NaN();
            if (turn % 11 == n) one.max.z = std::numeric_limits<float>::quiet_NaN();
            if (turn % 13 == n) one.max.y = std::numeric_limits<float>::infinity();
            (n % 2 ? sum : half).add(one);
            box.extendBy(one);
            const V3f point = noise.point(4, -6, 6);
            sum.add(point), box.extendBy(point);
        }
        sum.add(half);
        EXPECT_TRUE(same(sum.box(), box)) << turn;
    }
}

TEST(BoxSum, HasTheLargestCoordinate) {
    Noise noise;
    for (int turn = 0; turn < 200; ++turn) {
        BoxSum sum;
        LongestSide longest;
        float side = 0;
        EXPECT_EQ(longest.get(), 0);
        for (int n = 0; n < 1 + turn % 4; ++n) {
            Box3f box(noise.point(3, -9, turn % 5 ? 5 : 12));
            box.extendBy(noise.point(3, -9, 5));
            sum.add(box), longest.add(BoxLanes(box));
            for (int k = 0; k < 3; ++k) side = std::max(side, box.max[k] - box.min[k]);
        }
        EXPECT_EQ(sum.largest_coordinate(), largest_coordinate(sum.box()));
        EXPECT_EQ(longest.get(), side);
    }
}

TEST(BoxSum, IsCutByPlanes) {
    for (int axis = 0; axis < 3; ++axis) {
        BoxSum sum;
        sum.cut_below(axis, -1), sum.cut_above(axis, 1);
        EXPECT_TRUE(sum.box().isEmpty());
        sum.add(Box3f(V3f(-2, -3, -4), V3f(5, 6, 7)));
        Box3f box = sum.box();
        sum.cut_below(axis, -1.5f), sum.cut_below(axis, -9);
        sum.cut_above(axis, 2.5f), sum.cut_above(axis, 9);
        box.min[axis] = -1.5f, box.max[axis] = 2.5f;
        EXPECT_TRUE(same(sum.box(), box)) << axis;
    }
}

}  // namespace
}  // namespace trapeze
