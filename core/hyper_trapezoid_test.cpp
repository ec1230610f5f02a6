#include "core/hyper_trapezoid.h"

#include <gtest/gtest.h>

#include <random>

#include "core/noise_harness.h"

namespace trapeze {
namespace {

using testing::Noise;

/// A point that moves linearly between keys, by the arithmetic of grids.
struct MovingPoint {
    std::vector<V3f> keys;

    V3f at(float time) const {
        if (keys.size() == 1) return keys[0];
        const MotionSegment s = segment_at(time, static_cast<int>(keys.size()));
        const V3f delta = keys[s.index + 1] - keys[s.index];
        return keys[s.index] + delta * s.local;
    }
};

struct Swarm {
    std::vector<MovingPoint> points;

    Swarm(Noise& noise, int keys, float reach) : points(8) {
        for (MovingPoint& p : points)
            for (int k = 0; k < keys; ++k) p.keys.push_back(noise.point(reach));
    }
    HyperTrapezoid bound(const Axes& axes) const {
        HyperTrapezoid result{axes, {}};
        for (size_t k = 0; k < points[0].keys.size(); ++k) {
            Box3f box;
            for (const MovingPoint& p : points) box.extendBy(axes.from_space(p.keys[k]));
            result.keys.push_back(grown_for_rounding(box));
        }
        return result;
    }
};

Axes random_axes(Noise& noise) {
    return axes_of(V3d(noise.point(1)), V3d(noise.point(1)));
}

TEST(LargestCoordinate, IsThatOfAnyCornerOnAnyAxis) {
    const Box3f box({-1, -2, -3}, {1.5f, 2, 0});
    EXPECT_EQ(largest_coordinate(box), 3);
    EXPECT_EQ(largest_coordinate({box.min, {1, 7, 2}}), 7);
    EXPECT_EQ(largest_coordinate({{4, 5, 6}, {8, 5, 6}}), 8);
}

TEST(HyperTrapezoid, BoundsLinearMotionWhenItBoundsTheKeys) {
    Noise noise{std::mt19937(5)};
    for (const int keys : {1, 2, 5}) {
        for (int round = 0; round < 200; ++round) {
            const Swarm swarm(noise, keys, std::pow(10.0f, noise(-3, 4)));
            const HyperTrapezoid bound = swarm.bound(random_axes(noise));
            for (int i = 0; i < 20; ++i) {
                const float time = noise(0, 1);
                for (const MovingPoint& p : swarm.points) ASSERT_TRUE(bound.contains(p.at(time), time));
            }
        }
    }
}

TEST(HyperTrapezoid, TellsWhatIsOutside) {
    const HyperTrapezoid bound{Axes{}, {Box3f(V3f(0), V3f(1)), Box3f(V3f(10), V3f(11))}};
    EXPECT_TRUE(bound.contains(V3f(5.5f), 0.5f));
    EXPECT_FALSE(bound.contains(V3f(0.5f), 0.5f));
    EXPECT_FALSE(bound.contains(V3f(5.5f), 0));
}

TEST(HyperTrapezoid, MergingHoldsBothInAnyAxesAndKeyCounts) {
    Noise noise{std::mt19937(5)};
    for (int round = 0; round < 300; ++round) {
        const int counts[] = {1, 2, 3, 5};
        const Swarm a(noise, counts[noise.engine() % 4], 3), b(noise, counts[noise.engine() % 4], 50);
        HyperTrapezoid merged = a.bound(random_axes(noise));
        const Axes axes = merged.axes;
        merged.merge(b.bound(random_axes(noise)));
        EXPECT_EQ(merged.axes, axes);
        for (int i = 0; i < 20; ++i) {
            const float time = noise(0, 1);
            for (const Swarm* swarm : {&a, &b})
                for (const MovingPoint& p : swarm->points) ASSERT_TRUE(merged.contains(p.at(time), time));
        }
    }
}

TEST(HyperTrapezoid, AreaIsTheMeanOverKeys) {
    const HyperTrapezoid bound{Axes{}, {Box3f(V3f(0), V3f(1, 2, 3)), Box3f(V3f(5), V3f(5))}};
    EXPECT_DOUBLE_EQ(bound.expected_half_area(), 11 / 2.0);
}

TEST(Axes, IsOrthonormalAndKeepsTheLongerDirection) {
    Noise noise{std::mt19937(5)};
    for (int round = 0; round < 300; ++round) {
        const V3d first(noise.point(std::pow(10.0f, noise(-12, 12)))), second(noise.point(1));
        const Axes axes = axes_of(first, second);
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) ASSERT_NEAR(axes.axis[i].dot(axes.axis[j]), i == j ? 1 : 0, 1e-6);
        const V3d longer = first.length2() >= second.length2() ? first : second;
        ASSERT_NEAR(V3d(axes.axis[0]).dot(longer.normalized()), 1, 1e-6);
    }
}

TEST(Axes, OfDirectionsThatVanishOrAreParallelIsStillOne) {
    const double infinite = std::numeric_limits<double>::infinity();
    for (const auto& [first, second] :
         std::vector<std::pair<V3d, V3d>>{{V3d(0), V3d(0)},
                                          {V3d(1, 2, 3), V3d(0)},
                                          {V3d(1, 2, 3), V3d(2, 4, 6)},
                                          {V3d(0, 0, 1e-300), V3d(1e-300, 0, 0)},
                                          {V3d(1e300), V3d(-1e300, 1e299, 0)},
                                          {V3d(infinite), V3d(1)}}) {
        const Axes axes = axes_of(first, second);
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) ASSERT_NEAR(axes.axis[i].dot(axes.axis[j]), i == j ? 1 : 0, 1e-6);
    }
}

}  // namespace
}  // namespace trapeze
