#include "shade/vm/kernels/masks.h"

#include <gtest/gtest.h>

#include <bit>

#include "shade/vm/kernels/kernel_harness.h"

namespace trapeze::vm {
namespace {

const float kTrue = std::bit_cast<float>(~0u);
constexpr size_t kCount = 304;

bool is_set(const Register& mask, size_t i) {
    return std::bit_cast<uint32_t>(mask.at(i, 0)) != 0;
}

Register random_mask(Numbers& numbers, bool uniform) {
    Register mask(1, uniform, kCount);
    mask.fill([&] { return numbers.below(3) ? kTrue : 0; });
    return mask;
}

TEST(Masks, Combine) {
    Numbers numbers;
    for (bool uniform : {false, true})
        for_each_target([&] {
            Register a = random_mask(numbers, false), b = random_mask(numbers, uniform),
                     out(1, false, kCount);
            mask_and(kCount, a.operand(), b.operand(), out.operand());
            for (size_t i = 0; i < kCount; ++i) EXPECT_EQ(is_set(out, i), is_set(a, i) && is_set(b, i));
            mask_or(kCount, a.operand(), b.operand(), out.operand());
            for (size_t i = 0; i < kCount; ++i) EXPECT_EQ(is_set(out, i), is_set(a, i) || is_set(b, i));
            mask_and_not(kCount, a.operand(), b.operand(), out.operand());
            for (size_t i = 0; i < kCount; ++i) EXPECT_EQ(is_set(out, i), is_set(a, i) && !is_set(b, i));
            mask_not(kCount, b.operand(), out.operand());
            for (size_t i = 0; i < kCount; ++i) EXPECT_EQ(is_set(out, i), !is_set(b, i));
        });
}

TEST(Masks, AreCounted) {
    for_each_target([] {
        Register mask(1, false, kCount);
        EXPECT_FALSE(any_lane(kCount, mask.operand()));
        EXPECT_EQ(count_lanes(kCount, mask.operand()), 0u);
        for (size_t i : {5u, 6u, 100u, 303u}) mask.set(i, 0, kTrue);
        EXPECT_TRUE(any_lane(kCount, mask.operand()));
        EXPECT_FALSE(all_lanes(kCount, mask.operand()));
        EXPECT_EQ(count_lanes(kCount, mask.operand()), 4u);
        EXPECT_EQ(count_lanes(101, mask.operand()), 3u);
        EXPECT_EQ(count_lanes(100, mask.operand()), 2u);
        EXPECT_EQ(count_lanes(6, mask.operand()), 1u);
        fill_mask(kCount, true, mask.operand());
        EXPECT_TRUE(all_lanes(kCount, mask.operand()));
        EXPECT_EQ(count_lanes(289, mask.operand()), 289u);
        mask.set(303, 0, 0);
        EXPECT_FALSE(all_lanes(kCount, mask.operand()));
        fill_mask(kCount, false, mask.operand());
        EXPECT_FALSE(any_lane(kCount, mask.operand()));
    });
}

TEST(Masks, Move) {
    Numbers numbers;
    for (int width : {1, 3, 16})
        for (bool uniform : {false, true})
            for_each_target([&] {
                Register mask = random_mask(numbers, false), from(width, uniform, kCount),
                         to(width, false, kCount);
                from.fill([&] { return numbers.any(); });
                to.fill([&] { return numbers.any(); });
                const Register before = to;
                masked_move(kCount, width, mask.operand(), from.operand(), to.operand());
                for (size_t i = 0; i < kCount; ++i)
                    for (int k = 0; k < width; ++k)
                        ASSERT_TRUE(
                            same_float(to.at(i, k), is_set(mask, i) ? from.at(i, k) : before.at(i, k)));
            });
}

}  // namespace
}  // namespace trapeze::vm
