/// IfBegin and its kin, blocks skipped whole, variables in texts.
#include "pipeline/rib/reading_harness.h"

namespace trapeze::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// The names of the primitives' surfaces, in their order.
std::string surfaces(const ReadOutcome& outcome) {
    std::string names;
    for (size_t i = 0; i < outcome.count(); ++i) names += outcome.attributes(i).surface->name;
    return names;
}

std::string ball(const std::string& name) {
    return "Surface \"" + name + "\" " + kSphere + "\n";
}

std::string branches(const std::string& pass) {
    const ReadOutcome outcome = read_text(
        "Option \"user\" \"string pass\" [\"" + pass + "\"]\nWorldBegin\n" + ball("a") +
        "IfBegin \"$user:pass == 'one'\"\n" + ball("b") + "ElseIf \"$Option:user:pass == 'two'\"\n" +
        ball("c") + "ElseIf \"$user:pass == 'one' || $user:pass == 'three'\"\n" + ball("d") + "Else\n" +
        ball("e") + "IfEnd\n" + ball("f") + "WorldEnd");
    EXPECT_THAT(outcome.messages, IsEmpty());
    return surfaces(outcome);
}

TEST(ReadConditionals, OneBranchIsExecuted) {
    EXPECT_EQ(branches("one"), "abf");
    EXPECT_EQ(branches("two"), "acf");
    EXPECT_EQ(branches("three"), "adf");
    EXPECT_EQ(branches("four"), "aef");
}

TEST(ReadConditionals, Nest) {
    const ReadOutcome outcome = read_world("IfBegin \"0\" IfBegin \"1\" " + ball("a") + "Else " + ball("b") +
                                           "IfEnd " + ball("c") + "Else IfBegin \"0\" " + ball("d") +
                                           "Else " + ball("e") + "IfEnd " + ball("f") + "IfEnd " + ball("g"));
    EXPECT_THAT(outcome.messages, IsEmpty());
    EXPECT_EQ(surfaces(outcome), "efg");
}

TEST(ReadConditionals, AttributesComeBeforeOptionsAndFollowBlocks) {
    const std::string test = "IfBegin \"$user:x == 1\" " + ball("y") + "Else " + ball("n") + "IfEnd ";
    const ReadOutcome outcome =
        read_text("FrameBegin 7 Option \"user\" \"float x\" [1] WorldBegin " + test +
                  "AttributeBegin Attribute \"user\" \"float x\" [2] " + test + "AttributeEnd " + test +
                  "IfBegin \"$Frame == 7 && $Option:Frame == 7\" " + ball("7") + "IfEnd WorldEnd FrameEnd");
    EXPECT_THAT(outcome.messages, IsEmpty());
    EXPECT_EQ(surfaces(outcome), "yny7");
}

TEST(ReadConditionals, WorkInArchivesAndAroundOptions) {
    const ReadOutcome outcome = read_text(
        "ArchiveBegin \"ball\" IfBegin \"$Attribute:user:big\" " + ball("b") + "Else " + ball("s") +
        "IfEnd ArchiveEnd IfBegin \"defined(Option:user:none)\" Format 10 20 1 Else Format 30 40 1 IfEnd "
        "WorldBegin Attribute \"user\" \"int big\" [1] ReadArchive \"ball\" "
        "Attribute \"user\" \"int big\" [0] ReadArchive \"ball\" WorldEnd");
    EXPECT_THAT(outcome.messages, IsEmpty());
    EXPECT_EQ(surfaces(outcome), "bs");
    EXPECT_EQ(outcome.scene().options.width, 30);
}

TEST(ReadConditionals, SkippedBranchesAreNotValidated) {
    const ReadOutcome outcome = read_world(
        "IfBegin \"0\" Sphere 1 Spere 2 Polygon \"P\" [1 nonsense] ReadArchive \"none.rib\" WorldEnd\n"
        "ArchiveBegin \"z\" ArchiveEnd IfEnd " +
        ball("a") + "ReadArchive \"z\"");
    EXPECT_EQ(surfaces(outcome), "a");
    EXPECT_THAT(outcome.messages, ElementsAre(HasSubstr("\"z\" is not found")));
}

TEST(ReadConditionals, UnbalancedOnesAreSaid) {
    const ReadOutcome outcome = read_world("IfEnd\nElse\nIfBegin \"1\"\nElse\nElse\nIfEnd\nElseIf \"1\"\n" +
                                           ball("a") + "IfBegin \"1\"\n" + ball("b"));
    EXPECT_EQ(surfaces(outcome), "ab");
    EXPECT_THAT(outcome.messages,
                ElementsAre("a.rib:2:1: error: IfEnd: no IfBegin is open here; request skipped",
                            "a.rib:3:1: error: Else: no IfBegin is open here; request skipped",
                            "a.rib:6:1: error: Else: stands after Else; request skipped",
                            "a.rib:8:1: error: ElseIf: no IfBegin is open here; request skipped",
                            "a.rib:10:1: error: IfBegin: never closed; closed at the end of the stream"));
}

TEST(ReadConditionals, EndWithTheArchiveThatOpenedThem) {
    const ReadOutcome outcome = read_world(
        "ArchiveBegin \"open\"\nIfBegin \"0\"\nArchiveEnd\n"
        "ArchiveBegin \"end\"\nIfEnd\nArchiveEnd\n"
        "ReadArchive \"open\"\n" +
        ball("a") + "IfBegin \"1\" ReadArchive \"end\"\n" + ball("b") + "IfEnd " + ball("c"));
    EXPECT_EQ(surfaces(outcome), "abc");
    ASSERT_EQ(outcome.messages.size(), 2u);
    EXPECT_THAT(outcome.messages[0], HasSubstr("a.rib:3:1: error: IfBegin: never closed"));
    EXPECT_THAT(outcome.messages[1], HasSubstr("a.rib:6:1: error: IfEnd: no IfBegin is open here"));
}

TEST(ReadConditionals, WrongConditionsAreFalse) {
    const ReadOutcome outcome =
        read_world("IfBegin \"1 +\" " + ball("a") + "Else " + ball("b") + "IfEnd IfBegin \"$user:none\" " +
                   ball("c") + "IfEnd IfBegin \"$user:none\" IfEnd IfBegin " + ball("d"));
    EXPECT_EQ(surfaces(outcome), "bd");
    EXPECT_THAT(outcome.messages,
                ElementsAre(HasSubstr("the condition \"1 +\" is wrong: it ends too early; taken as false"),
                            HasSubstr("warning: IfBegin: no option or attribute \"user:none\""),
                            HasSubstr("IfBegin: the condition is missing")));
}

TEST(ReadConditionals, EditBlocksAreSkippedWhole) {
    const ReadOutcome outcome =
        read_world("EditBegin \"attribute\" \"x\" " + ball("a") + "EditEnd " + ball("b") +
                   "EditBegin \"instance\" EditBegin \"x\" EditEnd " + ball("c") + "EditEnd EditEnd");
    EXPECT_EQ(surfaces(outcome), "b");
    EXPECT_THAT(outcome.messages, ElementsAre(HasSubstr("EditBegin: is not supported; skipped up to EditEnd"),
                                              HasSubstr("EditEnd: no EditBegin is open here")));
    EXPECT_EQ(outcome.summary.unsupported.at("EditBegin"), 2u);
}

TEST(ReadConditionals, DeepOnesEnd) {
    std::string text;
    for (int i = 0; i < 5000; ++i) text += "IfBegin \"1\"\n";
    const ReadOutcome outcome = read_world(text + ball("a"));
    EXPECT_EQ(surfaces(outcome), "a");
    EXPECT_THAT(outcome.messages[0], HasSubstr("nested more than 1000 deep"));
}

TEST(ReadConditionals, TheEnvironmentIsTheLastResort) {
    ASSERT_EQ(setenv("TRAPEZE_TEST_PASS", "shadow", 1), 0);
    const std::string test = "IfBegin \"$TRAPEZE_TEST_PASS == 'shadow'\" " + ball("s") + "IfEnd ";
    EXPECT_EQ(surfaces(read_world(test)), "s");
    EXPECT_EQ(surfaces(read_world("Attribute \"user\" \"string TRAPEZE_TEST_PASS\" [\"x\"] " + test)), "");
}

TEST(ReadConditionals, TextsNameVariablesOnceAskedTo) {
    const ReadOutcome outcome =
        read_text("Option \"user\" \"string who\" [\"bob\"] WorldBegin Surface \"$who\" " + kSphere +
                  "WorldEnd Option \"ribparse\" \"string varsubst\" [\"$\"] FrameBegin 3 WorldBegin "
                  "Surface \"$who\" Attribute \"identifier\" \"name\" [\"${user:who}_$Frame\"] " +
                  kSphere + "WorldEnd FrameEnd");
    EXPECT_THAT(outcome.messages, IsEmpty());
    EXPECT_EQ(surfaces(outcome), "$who");
    const Attributes& second = *outcome.worlds.at(1).primitives.at(0).attributes;
    EXPECT_EQ(second.surface->name, "bob");
    EXPECT_EQ(second.name, "bob_3");
}

}  // namespace
}  // namespace trapeze::testing
