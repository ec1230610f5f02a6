/// Curves, valid and not.
#include "pipeline/rib/reading_harness.h"

namespace trapeze::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string points(int count) {
    std::string text = "\"P\" [";
    for (int i = 0; i < count; ++i) text += std::to_string(i) + " 0 0 ";
    return text + "] ";
}

TEST(ReadCurves, LinearAndCubicOfEveryWrap) {
    const ReadOutcome r = read_world(
        "Curves \"linear\" [2 3] \"nonperiodic\" " + points(5) +
        "\"width\" [1 2 3 4 5] \"uniform color Cs\" [1 0 0 0 1 0] "
        "Basis \"b-spline\" 1 \"catmull-rom\" 1 Curves \"cubic\" [4 6] \"periodic\" " +
        points(10) +
        "\"constantwidth\" .1 \"varying float k\" [0 1 2 3 4 5 6 7 8 9] Basis \"bezier\" 3 \"bezier\" 3 "
        "Curves \"cubic\" [7 4] \"nonperiodic\" " +
        points(11) + "\"width\" [1 2 3 4 5] \"vertex float k\" [0 1 2 3 4 5 6 7 8 9 10]");
    EXPECT_THAT(r.messages, IsEmpty());
    ASSERT_EQ(r.count(), 3u);
    const auto& linear = std::get<Curves>(r.primitive(0).shape().topology);
    EXPECT_FALSE(linear.cubic);
    EXPECT_THAT(linear.vertices_per_curve, ElementsAre(2, 3));
    const auto& cubic = std::get<Curves>(r.primitive(1).shape().topology);
    EXPECT_TRUE(cubic.cubic && cubic.periodic);
    EXPECT_EQ(cubic.step, 1);
    EXPECT_FLOAT_EQ(cubic.basis[1][0], 1.0f);
    EXPECT_EQ(r.primitive(1).shape().variables.find("constantwidth")->floats, std::vector<float>{.1f});
    EXPECT_EQ(r.summary.faces, 6u);
    EXPECT_EQ(r.summary.points, 26u);
}

/// There and back again.
TEST(ReadCurves, TwoPointsMayClose) {
    const ReadOutcome r = read_world("Curves \"linear\" [2] \"periodic\" " + points(2));
    EXPECT_THAT(r.messages, IsEmpty());
    EXPECT_EQ(r.count(), 1u);
}

TEST(ReadCurves, WhatIsWrongIsSaidWithItsPlace) {
    const std::pair<std::string, const char*> wrong[] = {
        {"\"cubic\" [3] \"nonperiodic\" " + points(3), "curve 0 has 3 points, needs at least 4"},
        {"\"cubic\" [4] \"periodic\" " + points(4), "do not fit the basis' step of 3"},
        {"\"linear\" [1] \"nonperiodic\" " + points(1), "needs at least 2"},
        {"\"linear\" [-4] \"nonperiodic\" " + points(1), "curve 0 has -4 points"},
        {"\"linear\" [3] \"nonperiodic\" " + points(2), "\"P\" has 2 points, needs 3"},
        {"\"linear\" [2] \"nonperiodic\" \"constantwidth\" 1", "\"P\" is missing"},
        {"\"linear\" [] \"nonperiodic\" " + points(2), "has no curves"},
        {"\"quadratic\" [2] \"nonperiodic\" " + points(2), "neither linear nor cubic"},
        {"\"linear\" [2000000000 2000000000] \"nonperiodic\" " + points(2), "more than 268435456 points"},
    };
    for (const auto& [text, message] : wrong) {
        const ReadOutcome r = read_world("Curves " + text + "\nSphere 1 -1 1 360");
        ASSERT_EQ(r.messages.size(), 1u) << text;
        EXPECT_THAT(r.messages[0], HasSubstr(message)) << text;
        EXPECT_THAT(r.messages[0], HasSubstr("a.rib:2:1: error: Curves")) << text;
        EXPECT_EQ(r.count(), 1u) << text;  // the sphere
    }
}

TEST(ReadCurves, UnknownWrapsLeaveThemOpen) {
    const ReadOutcome r = read_world("Curves \"linear\" [2] \"closed\" " + points(2));
    EXPECT_THAT(r.messages, ElementsAre(HasSubstr("a.rib:2:1: warning: Curves: \"closed\" is neither "
                                                  "periodic nor nonperiodic; taken as nonperiodic")));
    ASSERT_EQ(r.count(), 1u);
    EXPECT_FALSE(std::get<Curves>(r.primitive().shape().topology).periodic);
}

TEST(ReadCurves, PointsBeyondTheLastSegmentAreLeftOver) {
    const ReadOutcome r =
        read_world("Curves \"cubic\" [6 7] \"nonperiodic\" " + points(13) + "\"width\" [1 2 3 4 5]");
    EXPECT_THAT(
        r.messages,
        ElementsAre(HasSubstr("warning: Curves: curve 0 has 6 points, which do not fit the basis' step")));
    ASSERT_EQ(r.count(), 1u);
    EXPECT_EQ(r.primitive().shape().variables.find("P")->floats.size(), 39u);
    // A varying variable has a value for each end of the one segment and of the two.
    EXPECT_EQ(r.primitive().shape().variables.find("width")->floats.size(), 5u);
}

TEST(ReadCurves, CurvesOfTooFewPointsAreLeftOut) {
    const ReadOutcome r = read_world(
        "Basis \"b-spline\" 1 \"b-spline\" 1 Curves \"cubic\" [3 5 0 1 2 4] \"nonperiodic\" " + points(15) +
        "\"width\" [1 2 3 4 5 6] \"uniform float f\" [1 2 3 4 5 6] "
        "\"vertex float g\" [1 2 3 4 5 6 7 8 9 10 11 12 13 14 15]");
    EXPECT_THAT(r.messages,
                ElementsAre(HasSubstr("warning: Curves: curve 0 has 3 points, needs at least 4; curves of")));
    ASSERT_EQ(r.count(), 1u);
    const Shape& shape = r.primitive().shape();
    EXPECT_THAT(std::get<Curves>(shape.topology).vertices_per_curve, ElementsAre(5, 4));
    EXPECT_THAT(shape.variables.find("width")->floats, ElementsAre(2, 3, 4, 5, 6));
    EXPECT_THAT(shape.variables.find("f")->floats, ElementsAre(2, 6));
    EXPECT_THAT(shape.variables.find("g")->floats, ElementsAre(4, 5, 6, 7, 8, 12, 13, 14, 15));
    EXPECT_EQ(shape.variables.find("P")->floats.size(), 27u);

    const ReadOutcome lines =
        read_world("Curves \"linear\" [1 2 0] \"nonperiodic\" " + points(3) + "\"width\" [1 2 3]");
    ASSERT_EQ(lines.count(), 1u);
    EXPECT_THAT(lines.primitive().shape().variables.find("width")->floats, ElementsAre(2, 3));
}

TEST(ReadCurves, WidthsOfAWrongNumberAreLeftOut) {
    const std::string curve = "Curves \"linear\" [3] \"nonperiodic\" " + points(3);
    const ReadOutcome r = read_world(curve + "\"width\" [1 2]");
    EXPECT_THAT(r.messages, ElementsAre(HasSubstr("error: Curves: \"width\" has 2 values, needs 3")));
    ASSERT_EQ(r.count(), 1u);
    EXPECT_EQ(r.primitive().shape().variables.find("width"), nullptr);
    const ReadOutcome one = read_world(curve + "\"width\" [.5]");
    EXPECT_THAT(one.messages, ElementsAre(HasSubstr("has 1 values, needs 3; it is taken as constant")));
    EXPECT_EQ(one.primitive().shape().variables.find("width")->declaration.storage, StorageClass::Constant);
}

TEST(ReadCurves, Deform) {
    const std::string curve = "Curves \"linear\" [2] \"nonperiodic\" \"constantwidth\" .1 ";
    const ReadOutcome r =
        read_text("Shutter 0 1 WorldBegin MotionBegin [0 1] " + curve + "\"P\" [0 0 0 1 0 0] " + curve +
                  "\"P\" [0 0 0 1 5 0] MotionEnd WorldEnd");
    EXPECT_THAT(r.messages, IsEmpty());
    ASSERT_EQ(r.primitive().shape_keys.size(), 2u);
    EXPECT_EQ(r.primitive().shape_keys[1]->variables.find("P")->floats[4], 5);
}

}  // namespace
}  // namespace trapeze::testing
