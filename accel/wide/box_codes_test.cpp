/// Codes of planes: conservative, by less than a step, for all magnitudes and for what is no number.
#include "accel/wide/box_codes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace trapeze {
namespace {

/// Ends and places within them, of every magnitude, near 0 and far from it.
TEST(BoxCodes, PlanesLieOutsideOfWhatTheyBoundByLessThanAStep) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> unit(0, 1);
    for (int i = 0; i < 200000; ++i) {
        const float middle = std::ldexp(unit(random) - 0.5f, static_cast<int>(random() % 40) - 20);
        const float extent = std::ldexp(unit(random) + 0.01f, static_cast<int>(random() % 40) - 20);
        const float low = middle - extent, high = middle + extent;
        if (high - low < 0x1p-14f * std::abs(middle)) continue;  // floats there are as coarse as steps
        const CodeScale scale(low, high);
        const float rounding = kCodeRounding * std::max(std::abs(low), std::abs(high));
        const float at = low + rounding + unit(random) * (high - low - 2 * rounding),
                    per_step = 1 / scale.step;
        const float below = scale.plane(code_below(scale, per_step, at)),
                    above = scale.plane(code_above(scale, per_step, at));
        ASSERT_LE(below, at) << low << " " << high;
        ASSERT_GE(above, at) << low << " " << high;
        ASSERT_LE(at - below, scale.step * 1.01f + rounding) << low << " " << high;
        ASSERT_LE(above - at, scale.step * 1.01f + rounding) << low << " " << high;
    }
}

TEST(BoxCodes, EndsAreTheFirstAndTheLast) {
    const CodeScale scale(-3, 5);
    EXPECT_EQ(code_below(scale, 1 / scale.step, -3), 0);
    EXPECT_EQ(code_above(scale, 1 / scale.step, -3), 0);
    EXPECT_EQ(code_above(scale, 1 / scale.step, 4.99f), 255);
    EXPECT_EQ(code_below(scale, 1 / scale.step, 4.99f), 254);
}

TEST(BoxCodes, BoundsAtAKeyHoldWhatTheyAreOf) {
    std::mt19937 random(2);
    std::uniform_real_distribution<float> unit(0, 1);
    const KeyBounds all{{-3, 0, 100}, {5, 0.25f, 107}};
    const KeyBoundsScale scale(all);
    for (int i = 0; i < 10000; ++i) {
        KeyBounds at;
        for (int k = 0; k < 3; ++k) {
            const float size = all.high[k] - all.low[k], rounding = kCodeRounding * 107;
            at.low[k] = all.low[k] + rounding + unit(random) * (size - 2 * rounding);
            at.high[k] = at.low[k] + unit(random) * (all.high[k] - rounding - at.low[k]);
        }
        uint8_t codes[6];
        scale.write(at, codes);
        const KeyBounds decoded = scale.bounds(codes);
        for (int k = 0; k < 3; ++k) {
            const float step = (all.high[k] - all.low[k]) / 255 * 1.01f;
            ASSERT_LE(decoded.low[k], at.low[k]);
            ASSERT_GE(decoded.high[k], at.high[k]);
            ASSERT_LE(at.low[k] - decoded.low[k], step);
            ASSERT_LE(decoded.high[k] - at.high[k], step);
        }
    }
}

TEST(BoxCodes, WhatIsNoNumberHasACode) {
    for (const float wrong : {NAN, HUGE_VALF, -HUGE_VALF}) {
        const CodeScale scale(0, wrong);
        for (const float at : {0.0f, 1.0f, wrong}) {
            EXPECT_LE(code_below(scale, 1 / scale.step, at), 255);
            EXPECT_LE(code_above(scale, 1 / scale.step, at), 255);
        }
    }
}

}  // namespace
}  // namespace trapeze
