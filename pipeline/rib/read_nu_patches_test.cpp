/// NuPatch, valid and not.
#include "pipeline/rib/reading_harness.h"

namespace trapeze::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::string kU = "3 3 [0 0 0 1 1 1] 0 1 ", kV = "2 2 [0 0 1 1] 0 1 ";
const std::string kP = "\"P\" [0 0 0 1 0 0 2 0 0 0 1 0 1 1 0 2 1 0] ";
const std::string kPw = "\"Pw\" [0 0 0 1 1 0 0 .5 2 0 0 1 0 1 0 1 1 1 0 .5 2 1 0 1] ";

TEST(ReadNuPatches, TakePointsAndVariables) {
    const ReadOutcome r =
        read_world("NuPatch " + kU + kV + kP + "\"Cs\" [1 0 0 0 1 0 0 0 1 1 1 1] NuPatch " + kU + kV + kPw +
                   "\"vertex float k\" [1 2 3 4 5 6] \"uniform float m\" 3 "
                   "NuPatch 4 2 [0 0 1 1 2 2] 0 2 2 2 [0 0 1 1] .25 .5 \"P\" "
                   "[0 0 0 1 0 0 2 0 0 3 0 0 0 1 0 1 1 0 2 1 0 3 1 0] "
                   "\"varying float k\" [1 2 3 4 5 6 7 8]");
    EXPECT_THAT(r.messages, IsEmpty());
    ASSERT_EQ(r.count(), 3u);
    const auto& first = std::get<NuPatch>(r.primitive(0).shape().topology);
    EXPECT_EQ(first.nu, 3);
    EXPECT_EQ(first.v_order, 2);
    EXPECT_THAT(first.v_knots, ElementsAre(0, 0, 1, 1));
    EXPECT_NE(r.primitive(1).shape().variables.find("Pw"), nullptr);  // weights are kept
    const auto& third = std::get<NuPatch>(r.primitive(2).shape().topology);
    EXPECT_EQ(third.segments_u(), 3);  // one of them is empty
    EXPECT_EQ(third.v_begin, .25f);
    EXPECT_EQ(third.v_end, .5f);
    EXPECT_EQ(r.summary.faces, 5u);
}

TEST(ReadNuPatches, WhatIsWrongIsSaidWithItsPlace) {
    const std::pair<std::string, const char*> wrong[] = {
        {"3 4 [0 0 0 0 1 1 1] 0 1 " + kV + kP, "3 points along u are fewer than the order 4"},
        {"3 3 [0 0 0 1 1] 0 1 " + kV + kP, "the knots along u are 5, needs 6"},
        {kU + "2 2 [0 1 0 1] 0 1 " + kP, "the knots along v fall"},
        {kU + "2 2 [0 0 1 1] 1 1 " + kP, "the range of v is empty"},
        {"3 33 [0 0 0 1 1 1] 0 1 " + kV + kP, "the order along u"},
        {"3 1 [0 0 0 1] 0 1 " + kV + kP, "the order along u"},
        {"2000000 3 [0 0 0 1 1 1] 0 1 " + kV + kP, "the number of points along u"},
        {kU + kV + "\"P\" [0 0 0 1 1 1]", "\"P\" has 2 points, needs 6"},
        {kU + kV + "\"Cs\" [0 0 0 1 1 1]", "\"P\" is missing"},
        {kU + kV + "\"Pz\" [0 0 0 1 1 1]", "\"Pz\" is not for this primitive"},
        {kU + kV + "\"Pw\" [0 0 0 0 1 0 0 .5 2 0 0 1 0 1 0 1 1 1 0 .5 2 1 0 1]", "the weight 0"},
        {"3 3 [0 0 0 nan 1 1] 0 1 " + kV + kP, ""},
    };
    for (const auto& [text, message] : wrong) {
        const ReadOutcome r = read_world("NuPatch " + text + "\nSphere 1 -1 1 360");
        ASSERT_GE(r.messages.size(), 1u) << text;
        EXPECT_THAT(r.messages[0], HasSubstr(message)) << text;
        EXPECT_THAT(r.messages[0], HasSubstr("a.rib:2:")) << text;
        EXPECT_EQ(r.count(), 1u) << text;  // the sphere
    }
}

TEST(ReadNuPatches, RangesEndWithTheKnots) {
    const ReadOutcome r = read_world("NuPatch 3 3 [0 1 2 3 4 5] 0 9 " + kV + kP);
    ASSERT_EQ(r.messages.size(), 1u);
    EXPECT_THAT(r.messages[0], HasSubstr("warning: NuPatch: the range of u reaches beyond the knots"));
    const auto& patch = std::get<NuPatch>(r.primitive().shape().topology);
    EXPECT_EQ(patch.u_begin, 2);
    EXPECT_EQ(patch.u_end, 3);
}

const std::string kPatch = "NuPatch " + kU + kV + kP;
const std::string kSquareTrim = "[1] [2] [0 0 1 2 3 4 4] [0] [4] [5] [0 1 1 0 0] [0 0 1 1 0] [1 1 1 1 1] ";

TEST(ReadTrimCurves, LastUntilTheirBlockEnds) {
    const ReadOutcome r =
        read_world(kPatch + "AttributeBegin TrimCurve " + kSquareTrim + kPatch +
                   "Attribute \"trimcurve\" \"string sense\" [\"outside\"] TrimCurve 1 " + kSquareTrim +
                   kPatch + "TrimCurve [] " + kPatch + "AttributeEnd " + kPatch);
    EXPECT_THAT(r.messages, IsEmpty());
    ASSERT_EQ(r.count(), 5u);
    const auto patch = [&](size_t i) { return std::get<NuPatch>(r.primitive(i).shape().topology); };
    for (const size_t i : {0, 3, 4}) EXPECT_TRUE(patch(i).trim_loops.empty());
    ASSERT_EQ(patch(1).trim_loops.size(), 1u);
    EXPECT_EQ(patch(1).trim_loops[0][0].points[2], V3f(1, 1, 1));
    EXPECT_EQ(patch(1).trim_loops[0][0].end, 4);
    EXPECT_FALSE(patch(1).trim_outside);
    EXPECT_TRUE(patch(2).trim_outside);
}

TEST(ReadTrimCurves, SeveralCurvesMakeALoop) {
    const ReadOutcome r = read_world(
        "TrimCurve [2 1] [2 2 3] [0 0 1 1 0 0 1 2 2 0 0 0 1 1 1] [0 0 0] [1 2 1] [2 3 3] "
        "[0 1 1 0 0 .2 .4 .2] [0 0 1 1 0 .2 .2 .4] [1 1 1 1 1 1 .5 1] " +
        kPatch);
    EXPECT_THAT(r.messages, IsEmpty());
    const auto& loops = std::get<NuPatch>(r.primitive().shape().topology).trim_loops;
    ASSERT_EQ(loops.size(), 2u);
    EXPECT_EQ(loops[0].size(), 2u);
    EXPECT_THAT(loops[0][1].knots, ElementsAre(0, 0, 1, 2, 2));
    EXPECT_EQ(loops[1][0].points[1], V3f(.4f, .2f, .5f));
}

TEST(ReadTrimCurves, WhatIsWrongIsSaid) {
    const std::pair<std::string, const char*> wrong[] = {
        {"[1] [2] [0 0 1 1] [0] [1] [3] [0 1 1] [0 0 1] [1 1 1]", "the knots are 4, needs 5"},
        {"[1] [2 2] [0 0 1 1] [0] [1] [2] [0 1] [0 0] [1 1]", "the orders are 2, needs 1"},
        {"[1] [4] [0 0 1 1] [0] [1] [2] [0 1] [0 0] [1 1]", "curve 0 has the order 4 and 2 points"},
        {"[1] [2] [0 1 0 1] [0] [1] [2] [0 1] [0 0] [1 1]", "the knots of curve 0 fall"},
        {"[1] [2] [0 0 1 1] [1] [1] [2] [0 1] [0 0] [1 1]", "the range of curve 0 is empty"},
        {"[1] [2] [0 0 1 1] [0] [1] [2] [0 1] [0 0] [1 0]", "a weight of curve 0 is not positive"},
        {"[1] [2] [0 0 1 1] [0] [1] [2] [0 1] [0 0 1] [1 1]", "the points' coordinates are 3, needs 2"},
        {"[-1]", "a loop of -1 curves"},
        {"[1] [2]", "the knots"},
    };
    for (const auto& [text, message] : wrong) {
        const ReadOutcome r = read_world("TrimCurve " + text + "\n" + kPatch);
        ASSERT_EQ(r.messages.size(), 1u) << text;
        EXPECT_THAT(r.messages[0], HasSubstr(message)) << text;
        EXPECT_THAT(r.messages[0], HasSubstr("a.rib:2:1: error: TrimCurve")) << text;
        EXPECT_EQ(r.count(), 1u) << text;
    }
}

}  // namespace
}  // namespace trapeze::testing
