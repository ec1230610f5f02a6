/// A build for the machine that makes it: simd_limit.cpp is compiled here as if that machine had nothing
/// better than SSE4, with the options that cmake/InstructionSets.cmake gives then.
#include <gtest/gtest.h>
#include <hwy/highway.h>

#include "core/simd/simd_limit.h"

namespace trapeze {
namespace {

TEST(OwnInstructionSet, IsTheOnlyOneInTheBuild) {
    EXPECT_EQ(compiled_simd_names(), std::vector<std::string_view>{"sse4"});
    EXPECT_EQ(HWY_TARGETS, HWY_SSE4) << "no plain code, either";
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
    hwy::SetSupportedTargetsForTest(HWY_AVX3 | HWY_AVX2 | HWY_SSE4);
    EXPECT_EQ(simd_limit(), "sse4");
    std::string error;
    EXPECT_TRUE(limit_simd("sse4", &error)) << error;
    EXPECT_EQ(simd_limit(), "sse4");
    hwy::SetSupportedTargetsForTest(0);
    EXPECT_TRUE(limit_simd("best", &error)) << error;
}

TEST(OwnInstructionSet, IsMissedOnALesserMachine) {
    EXPECT_EQ(lacking_simd(), "") << "any machine that runs the tests has it";
    hwy::SetSupportedTargetsForTest(HWY_EMU128);
    EXPECT_EQ(lacking_simd(), "sse4");
    EXPECT_EQ(simd_limit(), "best");
    std::string error;
    EXPECT_FALSE(limit_simd("sse4", &error));
    EXPECT_EQ(error, "this machine has no sse4");
    hwy::SetSupportedTargetsForTest(0);
    EXPECT_TRUE(limit_simd("best", &error)) << error;
}

}  // namespace
}  // namespace trapeze
