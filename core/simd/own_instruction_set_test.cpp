/// A build for the machine that makes it: simd_limit.cpp is compiled here as if that machine had nothing
/// better than SSE4, with the options that cmake/InstructionSets.cmake gives then.
#include <gtest/gtest.h>
#include <hwy/highway.h>

#include "core/simd/simd_limit.h"

namespace trapeze {
namespace {

TEST(OwnInstructionSet, IsTheOnlyOneInTheBuild) {
    EXPECT_EQ(compiled_simd_names(), std::vector<std::string_view>{"sse4"});
}

TEST(OwnInstructionSet, OthersAreRefusedAsNotInTheBuild) {
    std::string error;
    for (const char* name : {"avx2", "avx512"}) {
        EXPECT_FALSE(limit_simd(name, &error));
        EXPECT_EQ(error, "this build has no " + std::string(name) + " (`trapeze --version` says what is in)");
    }
    EXPECT_TRUE(limit_simd("best", &error)) << error;
}

TEST(OwnInstructionSet, IsWhatIsUsedOnABetterMachine) {
    hwy::SetSupportedTargetsForTest(HWY_AVX3 | HWY_AVX2 | HWY_SSE4 | HWY_STATIC_TARGET);
    EXPECT_EQ(simd_limit(), "sse4");
    std::string error;
    EXPECT_TRUE(limit_simd("sse4", &error)) << error;
    EXPECT_EQ(simd_limit(), "sse4");
    hwy::SetSupportedTargetsForTest(0);
    EXPECT_TRUE(limit_simd("best", &error)) << error;
}

TEST(OwnInstructionSet, IsNotUsedOnALesserMachine) {
    hwy::SetSupportedTargetsForTest(HWY_STATIC_TARGET);
    EXPECT_EQ(simd_limit(), "best");
    std::string error;
    EXPECT_FALSE(limit_simd("sse4", &error));
    EXPECT_EQ(error, "this machine has no sse4");
    hwy::SetSupportedTargetsForTest(0);
    EXPECT_TRUE(limit_simd("best", &error)) << error;
}

}  // namespace
}  // namespace trapeze
