#include "shade/vm/text_format.h"

#include <gtest/gtest.h>

#include <limits>

namespace trapeze::vm {
namespace {

TextValue number(float x) {
    return {{}, false, {x}};
}
TextValue text(std::string_view s) {
    return {s, true, {}};
}

std::string formatted(std::string_view format, std::vector<TextValue> values) {
    return format_text(format, values);
}

TEST(TextFormat, WritesWhatLettersAskFor) {
    EXPECT_EQ(formatted("%f|%g|%e|%d", {number(1.5f), number(.25f), number(1000), number(-7.9f)}),
              "1.500000|0.25|1.000000e+03|-7");
    EXPECT_EQ(formatted("P = %p, C = %c", {{{}, false, {1, 2, 3}}, {{}, false, {.5f, 0, 1}}}),
              "P = 1.000000 2.000000 3.000000, C = 0.500000 0.000000 1.000000");
    EXPECT_EQ(formatted("%s and %s", {text("a"), text("b")}), "a and b");
    EXPECT_EQ(formatted("[%5s][%-5s][%.1s][%1s]", {text("ab"), text("ab"), text("ab"), text("ab")}),
              "[   ab][ab   ][a][ab]");
    EXPECT_EQ(formatted("100%% %d%%", {number(3)}), "100% 3%");
}

TEST(TextFormat, TakesFlagsWidthsAndPrecisions) {
    EXPECT_EQ(formatted("[%6.2f][%-6d][%06d][%+.1e][%.3d]",
                        {number(3.14159f), number(42), number(42), number(1.5f), number(5)}),
              "[  3.14][42    ][000042][+1.5e+00][005]");
}

/// Values that a letter does not ask for are written as what they are.
TEST(TextFormat, WritesOtherValuesAsWhatTheyAre) {
    EXPECT_EQ(formatted("%f %s", {text("name"), number(2)}), "name 2.000000");
    EXPECT_EQ(formatted("%q", {number(2)}), "2.000000");
    EXPECT_EQ(formatted("%d", {number(1e30f)}), formatted("%f", {number(1e30f)}));
    EXPECT_EQ(formatted("%d", {number(std::numeric_limits<float>::infinity())}), "inf");
}

TEST(TextFormat, LeavesFieldsWithoutValuesEmpty) {
    EXPECT_EQ(formatted("a%fb%fc", {number(1)}), "a1.000000bc");
    EXPECT_EQ(formatted("none", {number(1)}), "none");
    EXPECT_EQ(formatted("ends in %", {number(1)}), "ends in ");
    EXPECT_EQ(formatted("ends in %-12.5", {number(1)}), "ends in ");
}

/// What a stranger's shader may ask of printf.
TEST(TextFormat, IsBounded) {
    EXPECT_EQ(formatted("%999999999d", {number(1)}).size(), 200u);
    EXPECT_LE(formatted("%.999999999f", {number(-3e38f)}).size(), 200u + 42u);
    EXPECT_EQ(formatted("%n%*d", {number(1), number(2)}), "1.0000002.000000d");
    EXPECT_EQ(formatted("%-+ #0-+ #0-+ #0d", {number(1)}), "+1");
}

TEST(TextFormat, MatchesExtendedExpressions) {
    EXPECT_TRUE(matches("^(red|blue)_[0-9]+$", "blue_12"));
    EXPECT_FALSE(matches("^(red|blue)_[0-9]+$", "green_12"));
    EXPECT_TRUE(matches("b", "abc"));
    EXPECT_FALSE(matches("(", "("));
    EXPECT_FALSE(matches(std::string(kMaxPattern + 1, 'a'), std::string(600, 'a')));
    EXPECT_FALSE(matches("b", std::string(kMaxSubject, 'a') + "b"));
    EXPECT_TRUE(matches("b", std::string(kMaxSubject - 1, 'a') + "b"));
}

}  // namespace
}  // namespace trapeze::vm
