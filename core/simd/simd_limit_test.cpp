#include "core/simd/simd_limit.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

namespace trapeze {
namespace {

class SimdLimit : public ::testing::Test {
  protected:
    void TearDown() override { limit_simd("best", &error_); }
    std::string error_;
};

TEST_F(SimdLimit, LeavesTheNamedSetAndLesserOnes) {
    const int64_t all = hwy::SupportedTargets();
    int usable = 0;
    for (const std::string_view name : simd_names()) {
        if (name == "best" || !limit_simd(name, &error_)) continue;
        ++usable;
        EXPECT_EQ(simd_limit(), name);
        const int64_t now = hwy::SupportedTargets();
        const int64_t best_now = now & -now;
        EXPECT_EQ(now, all & ~(best_now - 1)) << name;  // all but the better ones
    }
    EXPECT_GT(usable, 0);
    ASSERT_TRUE(limit_simd("best", &error_));
    EXPECT_EQ(hwy::SupportedTargets(), all);
}

TEST_F(SimdLimit, ALaterLimitMayBeWider) {
    std::vector<std::string_view> usable;
    for (const std::string_view name : simd_names())
        if (name != "best" && limit_simd(name, &error_)) usable.push_back(name);
    for (const std::string_view narrow : usable)
        for (const std::string_view other : usable) {
            ASSERT_TRUE(limit_simd(narrow, &error_));
            ASSERT_TRUE(limit_simd(other, &error_));
            EXPECT_EQ(simd_limit(), other);
        }
}

TEST_F(SimdLimit, WhatTheMachineLacksOrNobodyKnowsIsRefusedAndChangesNothing) {
    const int64_t before = hwy::SupportedTargets();
    EXPECT_FALSE(limit_simd("mmx", &error_));
    EXPECT_NE(error_.find("no instruction set \"mmx\""), std::string::npos) << error_;
    EXPECT_EQ(hwy::SupportedTargets(), before);

    // A machine with nothing but what the named sets build upon.
    hwy::SetSupportedTargetsForTest(HWY_STATIC_TARGET);
    EXPECT_EQ(lacking_simd(), "") << "plain code, or what the compiler itself may use, is always there";
    int lacking = 0;
    for (const std::string_view name : simd_names()) {
        const std::string_view limit = simd_limit();
        if (limit_simd(name, &error_)) continue;
        ++lacking;
        // Builds under sanitizers have one set, and say so first.
        const bool built = error_.find("this build has no " + std::string(name)) == std::string::npos;
        EXPECT_TRUE(!built || error_.find("this machine has no " + std::string(name)) != std::string::npos)
            << error_;
#if !defined(HWY_COMPILE_ONLY_STATIC)
        EXPECT_TRUE(built) << error_;
#endif
        EXPECT_EQ(simd_limit(), limit);
    }
    hwy::SetSupportedTargetsForTest(0);
#if HWY_ARCH_X86
    EXPECT_GE(lacking, 2);  // all three, unless the compiler itself may use one
#endif
}

/// One an instruction set that kernels are compiled for. On a machine without it, nothing is tested on it:
/// tests/run reads what this test says then, and repeats it in its last lines.
class InstructionSet : public ::testing::TestWithParam<std::string_view> {};

TEST_P(InstructionSet, IsTestedOnThisMachine) {
    std::string error;
    const bool is_there = limit_simd(GetParam(), &error);
    ASSERT_TRUE(limit_simd("best", &error));
    if (!is_there) GTEST_SKIP() << "this machine has no " << GetParam() << ": no test has run on it";
}

INSTANTIATE_TEST_SUITE_P(Names, InstructionSet, ::testing::ValuesIn([] {
                             std::vector<std::string_view> names = simd_names();
                             std::erase(names, "best");
                             return names;
                         }()),
                         [](const auto& tested) { return std::string(tested.param); });

}  // namespace
}  // namespace trapeze
