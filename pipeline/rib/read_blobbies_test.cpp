/// Blobby and Points, valid and not.
#include "pipeline/rib/reading_harness.h"

namespace trapeze::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::string kUnit = "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 ";

TEST(ReadBlobbies, TakeCodeFloatsAndVariables) {
    const ReadOutcome r =
        read_world("Blobby 2 [1001 0 1001 16 0 2 0 1] [" + kUnit + kUnit +
                   "] [] \"Cs\" [1 0 0 0 1 0] \"constant float k\" 2 "
                   "Blobby 2 [1001 0 1003 0 16 0 2 0 1] [" +
                   kUnit + "-.1 1 .4 .01] [\"flat.zfile\"] Blobby 1 [1000 0] [3] \"vertex float k\" [1]");
    EXPECT_THAT(r.messages, IsEmpty());
    ASSERT_EQ(r.count(), 3u);
    const auto& first = std::get<Blobby>(r.primitive(0).shape().topology);
    EXPECT_EQ(first.leaf_count, 2);
    EXPECT_EQ(first.floats.size(), 32u);
    EXPECT_EQ(r.primitive(0).shape().variables.find("Cs")->floats.size(), 6u);
    EXPECT_THAT(std::get<Blobby>(r.primitive(1).shape().topology).strings, ElementsAre("flat.zfile"));
    EXPECT_NE(r.primitive(2).shape().variables.find("k"), nullptr);
}

TEST(ReadBlobbies, WhatIsWrongIsSaidWithItsPlace) {
    const std::pair<std::string, const char*> wrong[] = {
        {"1 [1001 1] [" + kUnit + "]", "leaf 0 wants 16 floats from 1 on, of 16"},
        {"1 [1001 -1] [" + kUnit + "]", "from -1 on"},
        {"1 [1001 2147483647] [" + kUnit + "]", "from 2147483647 on"},
        {"1 [1001 0 0 2 0 1] [" + kUnit + "]", "operand 1 is not among the 1 results before it"},
        {"1 [1001 0 0 2 0] [" + kUnit + "]", "the code ends within an operation"},
        {"1 [1001 0 0 0] [" + kUnit + "]", "an operation of 0 operands"},
        {"1 [1001 0 8 0] [" + kUnit + "]", "no operation 8"},
        {"1 [1005 0] [" + kUnit + "]", "no operation 1005"},
        {"1 [1004 0 0 0 0 0] [" + kUnit + "] []", "leaf 0 wants string 0 of 0"},
        {"1 [1004 0 2 15 0 0] [" + kUnit + "] [\"a.so\"]", "leaf 0 wants 2 floats from 15 on, of 16"},
        {"1 [1004 0 0 0 2147483647 1] [" + kUnit + "] [\"a.so\" \"x\"]", "wants string 2147483647 of 2"},
        {"1 [1004 0 0 0 0] [" + kUnit + "] [\"a.so\"]", "the code ends within an operation"},
        {"1 [1003 0 0] [1 2 3 4] []", "leaf 0 wants string 0 of 0"},
        {"0 [] []", "the code is empty"},
    };
    for (const auto& [text, message] : wrong) {
        const ReadOutcome r = read_world("Blobby " + text + "\nSphere 1 -1 1 360");
        ASSERT_EQ(r.messages.size(), 1u) << text;
        EXPECT_THAT(r.messages[0], HasSubstr(message)) << text;
        EXPECT_THAT(r.messages[0], HasSubstr("a.rib:2:1: error: Blobby")) << text;
        EXPECT_EQ(r.count(), 1u) << text;  // the sphere
    }
}

TEST(ReadBlobbies, TheCodeSaysHowManyLeavesThereAre) {
    const ReadOutcome r =
        read_world("Blobby 3 [1001 0 1001 0 0 2 0 1] [" + kUnit + "] \"varying float k\" [1 2]");
    ASSERT_EQ(r.messages.size(), 1u);
    EXPECT_THAT(r.messages[0], HasSubstr("warning: Blobby: the code has 2 leaves, not 3"));
    EXPECT_EQ(std::get<Blobby>(r.primitive().shape().topology).leaf_count, 2);
    EXPECT_EQ(r.primitive().shape().variables.find("k")->floats.size(), 2u);
}

TEST(ReadBlobbies, FieldsOfCompiledCodeAreNothing) {
    const ReadOutcome r = read_world("Blobby 2 [1001 0 1004 0 2 14 1 1 0 2 0 1] [" + kUnit +
                                     "] [\"field.so\" \"its argument\"]");
    ASSERT_EQ(r.messages.size(), 1u);
    EXPECT_THAT(r.messages[0], HasSubstr("warning: Blobby: fields of compiled code (1004)"));
    EXPECT_EQ(std::get<Blobby>(r.primitive().shape().topology).leaf_count, 2);
}

TEST(ReadBlobbies, Deform) {
    const ReadOutcome r = read_text(
        "Shutter 0 1 WorldBegin MotionBegin [-1 1] Blobby 1 [1000 0] [3] "
        "Blobby 1 [1000 0] [5] MotionEnd WorldEnd");
    EXPECT_THAT(r.messages, IsEmpty());
    ASSERT_EQ(r.primitive().shape_keys.size(), 2u);
    const auto value = [&](size_t key) {
        return std::get<Blobby>(r.primitive().shape_keys[key]->topology).floats[0];
    };
    EXPECT_EQ(value(0), 4);  // half-way when the shutter opens
    EXPECT_EQ(value(1), 5);
}

TEST(ReadPoints, TakePlacesAndWidths) {
    const ReadOutcome r = read_world(
        "Points \"P\" [0 0 0 1 1 1] \"width\" [1 2] \"Cs\" [1 0 0 0 1 0] "
        "Points \"P\" [0 0 0] \"constantwidth\" [.1]");
    EXPECT_THAT(r.messages, IsEmpty());
    ASSERT_EQ(r.count(), 2u);
    EXPECT_EQ(std::get<Points>(r.primitive(0).shape().topology).count, 2);
    EXPECT_EQ(r.summary.points, 3u);
    const ReadOutcome bad = read_world("Points \"width\" [1 2]\nPoints \"P\" [0 0 0] \"width\" [1 2]");
    ASSERT_EQ(bad.messages.size(), 2u);
    EXPECT_THAT(bad.messages[0], HasSubstr("a.rib:2:1: error: Points: \"P\" is missing"));
    EXPECT_THAT(bad.messages[1], HasSubstr("\"width\" has 2 values, needs 1"));
    EXPECT_EQ(bad.count(), 1u);
}

}  // namespace
}  // namespace trapeze::testing
