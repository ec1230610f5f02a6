/// Rounding to bfloat16 goes outward, and by less than a step.
#include "accel/wide/bfloat16.h"

#include <gtest/gtest.h>

#include <random>

namespace trapeze {
namespace {

TEST(BFloat16, IsRoundedOutwardByLessThanAStep) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> unit(-1, 1);
    for (int i = 0; i < 200000; ++i) {
        const float value = std::ldexp(unit(random), static_cast<int>(random() % 200) - 100);
        const float above = from_bfloat16(bfloat16_above(value)),
                    below = from_bfloat16(bfloat16_below(value));
        ASSERT_GE(above, value);
        ASSERT_LE(below, value);
        ASSERT_LE(above - below, std::abs(value) * 0x1p-7f) << value;
    }
}

TEST(BFloat16, WhatFitsIsKept) {
    for (const float value : {0.0f, 1.0f, -1.0f, 0.5f, -384.0f}) {
        EXPECT_EQ(from_bfloat16(bfloat16_above(value)), value);
        EXPECT_EQ(from_bfloat16(bfloat16_below(value)), value);
    }
}

}  // namespace
}  // namespace trapeze
