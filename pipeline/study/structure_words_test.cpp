#include "pipeline/study/structure_words.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace trapeze {
namespace {

StructureCosts costs(const char* tree, double build, double trace, double bytes = 10, double tests = 5) {
    return {tree, build, trace, bytes, tests, 20};
}

TEST(StructureWords, ATreeThatIsBuiltFasterIsWorthItForFewRays) {
    const StructureRun run{"a", "still", 8, {}};
    const StructureCosts own = costs("wide", 3, 2);
    const Worth fewer =
        worth_of(run, costs("lbvh", 1, 6), own);  // 2 s saved, 4 s lost with 8 rays: even with 4
    EXPECT_EQ(fewer.when, Worth::When::Fewer);
    EXPECT_DOUBLE_EQ(fewer.rays, 4);
    const Worth more = worth_of(run, costs("msbvh", 4, 1.5), own);  // 1 s lost, .5 s saved with 8 rays
    EXPECT_EQ(more.when, Worth::When::More);
    EXPECT_DOUBLE_EQ(more.rays, 16);
}

TEST(StructureWords, ATreeThatIsLessInBothIsWorthItAlways) {
    const StructureRun run{"a", "still", 8, {}};
    const StructureCosts own = costs("wide", 3, 2);
    EXPECT_EQ(worth_of(run, costs("x", 2, 2), own).when, Worth::When::Always);
    EXPECT_EQ(worth_of(run, costs("x", 3, 1), own).when, Worth::When::Always);
    EXPECT_EQ(worth_of(run, costs("x", 4, 2), own).when, Worth::When::Never);
    EXPECT_EQ(worth_of(run, costs("x", 3, 3), own).when, Worth::When::Never);
    EXPECT_EQ(worth_of(run, own, own).when, Worth::When::Never);
}

TEST(StructureWords, SayWhoWinsAndHowOthersStand) {
    const std::vector<StructureRun> runs = {
        {"a", "still", 8, {costs("wide", 3, 2, 10), costs("lbvh", 1, 6, 20), costs("mbkd", 30, 4, 100, 4)}},
        {"a", "moving", 8, {costs("wide", 3, 2, 10), costs("lbvh", 1.5, 3, 5)}}};
    const std::vector<std::string> words = words_on_structures(runs);
    EXPECT_THAT(
        words,
        ::testing::ElementsAre(
            "Least for building and rays together: lbvh in 1, wide in 1 (of 2).",
            "Least for rays, once it is built: wide in 2 (of 2).",
            "Built in the least time: lbvh in 2 (of 2).", "Fewest bytes: lbvh in 1, wide in 1 (of 2).",
            "Fewest micropolygons tested: mbkd in 1, wide in 1 (of 2).",
            "lbvh beside wide: built in 0.333 to 0.500 times the time, rays take 1.50 to 3.00 times, bytes 0.500 to "
            "2.00 times; it pays with fewer than 4.00 to 12.0 rays a micropolygon in 2 of 2.",
            "mbkd beside wide: built in 10.0 times the time, rays take 2.00 times, bytes 10.0 times; it pays never "
            "in 1 of 1."));
}

TEST(StructureWords, TreesThatARunLacksHaveNoPartInIt) {
    const std::vector<StructureRun> runs = {{"a", "still", 8, {costs("lbvh", 1, 6)}}, {"b", "still", 8, {}}};
    const std::vector<std::string> words = words_on_structures(runs);
    EXPECT_THAT(words, ::testing::Contains("Built in the least time: lbvh in 1 (of 1)."));
    EXPECT_THAT(words, ::testing::Not(::testing::Contains(::testing::HasSubstr("beside"))));
}

}  // namespace
}  // namespace trapeze
