#include "pipeline/rib/syntax/conditions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace trapeze::rib {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

ConditionValue variable(const std::string& name) {
    if (name == "user:pass") return {{}, "beauty"};
    if (name == "Option:user:mode") return {{}, "bake"};
    if (name == "Frame") return {{12}, {}};
    if (name == "user:zero") return {{0}, {}};
    if (name == "user:bg") return {{0.5, 0.25, 0}, {}};
    if (name == "user:digits") return {{}, "12"};
    return {};
}

bool holds(const std::string& text) {
    const ConditionResult result = evaluate_condition(text, variable);
    EXPECT_EQ(result.problem, "") << text;
    return result.holds;
}

std::string problem(const std::string& text) {
    const ConditionResult result = evaluate_condition(text, variable);
    EXPECT_FALSE(result.holds) << text;
    return result.problem;
}

TEST(Conditions, TextsCompare) {
    EXPECT_TRUE(holds("$user:pass == 'beauty'"));
    EXPECT_FALSE(holds("$user:pass == 'shadow'"));
    EXPECT_TRUE(holds("'shadow'!=$user:pass"));
    EXPECT_TRUE(holds("${Option:user:mode} == \"bake\""));
    EXPECT_TRUE(holds("$user:pass == beauty"));
    EXPECT_TRUE(holds("'a' < 'b'"));
    EXPECT_TRUE(holds(R"('it\'s' == "it's")"));
    EXPECT_TRUE(holds(R"('c:\maps' < 'd')"));
}

TEST(Conditions, NumbersCompareAndAreReckonedWith) {
    EXPECT_TRUE(holds("$Frame > 11 && $Frame <= 12"));
    EXPECT_FALSE(holds("$Frame < 12"));
    EXPECT_TRUE(holds("$Frame * 2 + 1 == 25"));
    EXPECT_TRUE(holds("1 + 2 * 3 == 7 && (1 + 2) * 3 == 9"));
    EXPECT_TRUE(holds("-$Frame == 0 - 12 && 7 / 2 == 3.5 && 8-4-2 == 2"));
    EXPECT_TRUE(holds("$user:bg == [0.5 .25 0]"));
    EXPECT_FALSE(holds("$user:bg == [0.5 .25 -1]"));
    EXPECT_TRUE(holds("$user:digits == 12 && $user:digits >= 11.5"));
    EXPECT_FALSE(holds("$user:pass == 0"));
}

TEST(Conditions, LogicBindsAsInC) {
    EXPECT_TRUE(holds("1 || 0 && 0"));
    EXPECT_FALSE(holds("(1 || 0) && 0"));
    EXPECT_TRUE(holds("!0 && !!1"));
    EXPECT_FALSE(holds("! $Frame"));
    EXPECT_FALSE(holds("$user:zero"));
    EXPECT_TRUE(holds("true && !false"));
}

TEST(Conditions, VariablesMayBeMissing) {
    EXPECT_TRUE(holds("defined(user:pass) && !defined(user:nothing)"));
    EXPECT_TRUE(holds("defined($Option:user:mode)"));
    EXPECT_FALSE(holds("$user:nothing == 'x'"));
    EXPECT_TRUE(holds("$user:nothing != 'x'"));
    EXPECT_FALSE(holds("$user:nothing == $user:nothing2"));
    EXPECT_THAT(evaluate_condition("$a:b || defined(c:d)", variable).undefined, ElementsAre("a:b"));
}

TEST(Conditions, NamesAndTextsAreBuilt) {
    EXPECT_TRUE(holds("concat('beau', 'ty') == $user:pass"));
    EXPECT_TRUE(holds("$(concat('user:', 'pass')) == 'beauty'"));
    EXPECT_TRUE(holds("concat('f', $Frame, 0.5) == 'f120.5'"));
}

TEST(Conditions, PatternsMatchAPart) {
    EXPECT_TRUE(holds("$user:pass =~ '^b.*y$'"));
    EXPECT_TRUE(holds("$user:pass =~ 'aut'"));
    EXPECT_FALSE(holds("$user:pass =~ '^aut'"));
    EXPECT_TRUE(holds("$user:pass =~ 'shadow|beauty'"));
    EXPECT_FALSE(holds("$user:pass =~ '['"));
}

TEST(Conditions, WrongOnesSayWhy) {
    EXPECT_THAT(problem(""), HasSubstr("ends too early"));
    EXPECT_THAT(problem("$Frame =="), HasSubstr("ends too early"));
    EXPECT_THAT(problem("(1 || 2"), HasSubstr("')' is expected at character 8"));
    EXPECT_THAT(problem("'abc"), HasSubstr("never closed"));
    EXPECT_THAT(problem("1 2"), HasSubstr("what follows character 3"));
    EXPECT_THAT(problem("round(2)"), HasSubstr("no function round()"));
    EXPECT_THAT(problem("1 / 0"), HasSubstr("division by 0"));
    EXPECT_THAT(problem("'a' + 1"), HasSubstr("wants a number"));
    EXPECT_THAT(problem("$ == 1"), HasSubstr("a name is expected"));
    EXPECT_THAT(problem("[1 2"), HasSubstr("never closed"));
    EXPECT_THAT(problem("[x]"), HasSubstr("a number is expected"));
    EXPECT_THAT(problem(std::string(100000, '(')), HasSubstr("nested too deep, more than 100 times"));
    EXPECT_THAT(problem(std::string(100000, '!')), HasSubstr("nested too deep"));
}

TEST(Substitution, ReplacesWhatIsKnown) {
    EXPECT_EQ(substitute_variables("a_$user:pass.tif", "$", variable), "a_beauty.tif");
    EXPECT_EQ(substitute_variables("f${Frame}x$Frame", "$", variable), "f12x12");
    EXPECT_EQ(substitute_variables("$NONE/${x}$", "$", variable), "$NONE/${x}$");
    EXPECT_EQ(substitute_variables("@Frame$Frame", "@", variable), "12$Frame");
    EXPECT_EQ(substitute_variables("${Frame", "$", variable), "12");
    EXPECT_EQ(substitute_variables("$Frame", "", variable), "$Frame");
}

}  // namespace
}  // namespace trapeze::rib
