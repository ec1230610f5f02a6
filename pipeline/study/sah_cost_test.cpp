/// Costs of sheets for which they can be counted by hand, and what must not change them.
#include "pipeline/study/sah_cost.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/grids_harness.h"
#include "core/hyper_trapezoid.h"

namespace trapeze {
namespace {

using testing::GridMaker;

/// A flat sheet of which vertex (i, j) is at (x(i), j).
template <class X>
SahCosts costs_of_sheet(int nu, int nv, int leaf_below, X&& x) {
    GridMaker maker;
    return sah_costs(maker.add(nu, nv, 1,
                               [&](int i, int j, float) {
                                   return V3f(x(static_cast<float>(i)), static_cast<float>(j), 3);
                               }),
                     leaf_below);
}

TEST(SahCost, IsWhatNodesCostByTheirArea) {
    const auto even = [](float i) { return i; };
    const SahCosts leaf = costs_of_sheet(3, 2, 8, even);
    EXPECT_NEAR(leaf.parametric, 6, 1e-5);
    EXPECT_NEAR(leaf.greedy, 6, 1e-5);
    // The root, and two halves of four micropolygons each.
    const SahCosts split = costs_of_sheet(4, 2, 8, even);
    EXPECT_NEAR(split.parametric, 1 + 2 * 0.5 * 4, 1e-5);
    EXPECT_NEAR(split.greedy, split.parametric, 1e-5);
}

TEST(SahCost, OfAnEvenSheetIsTheSame) {
    for (const int leaf_below : {4, 8, 32}) {
        const SahCosts costs = costs_of_sheet(16, 16, leaf_below, [](float i) { return i; });
        EXPECT_NEAR(costs.relative_difference(), 0, 1e-4) << leaf_below;
        EXPECT_GT(costs.greedy, 1);
    }
}

TEST(SahCost, OfAnUnevenSheetIsLessWhenGreedy) {
    const SahCosts costs = costs_of_sheet(16, 16, 8, [](float i) { return std::exp(0.5f * i); });
    EXPECT_GT(costs.relative_difference(), 0.02);
}

TEST(SahCost, DoesNotDependOnWhereASheetIsTurnedAndIsTakenAtMidShutter) {
    GridMaker maker;
    const auto surface = [](int i, int j) {
        return V3f(static_cast<float>(i), static_cast<float>(j),
                   std::sin(0.4f * static_cast<float>(i)) + 0.1f * static_cast<float>(j * j));
    };
    const Axes turn = axes_of(V3d(1, 2, 0.5), V3d(-2, 1, 1));
    const SahCosts still =
        sah_costs(maker.add(16, 12, 1, [&](int i, int j, float) { return surface(i, j); }));
    const SahCosts turned = sah_costs(maker.add(16, 12, 2, [&](int i, int j, float t) {
        // At mid-shutter it is the same sheet; before and after it is stretched and sheared.
        V3f p = surface(i, j);
        p.x += (t - 0.5f) * p.y, p.z *= 2 * t;
        return turn.to_space(p);
    }));
    EXPECT_NEAR(turned.parametric, still.parametric, 1e-2 * still.parametric);
    EXPECT_NEAR(turned.greedy, still.greedy, 1e-2 * still.greedy);
}

TEST(SahCost, OfNoAreaIsNothing) {
    GridMaker maker;
    const SahCosts costs = sah_costs(maker.add(8, 8, 1, [](int, int, float) { return V3f(1, 2, 3); }));
    EXPECT_EQ(costs.parametric, 0);
    EXPECT_EQ(costs.greedy, 0);
    EXPECT_EQ(costs.relative_difference(), 0);
}

}  // namespace
}  // namespace trapeze
