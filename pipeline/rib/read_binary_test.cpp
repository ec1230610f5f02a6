/// Requests in the binary encoding, mixed with text.
#include "pipeline/rib/reading_harness.h"

#include <bit>

namespace trapeze::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string bytes(std::initializer_list<int> values) {
    std::string text;
    for (const int value : values) text += static_cast<char>(value);
    return text;
}

/// An array of floats with a length of one byte.
std::string floats(const std::vector<float>& values) {
    std::string text = bytes({0310, static_cast<int>(values.size())});
    for (const float value : values)
        for (int shift = 24; shift >= 0; shift -= 8)
            text += static_cast<char>(std::bit_cast<uint32_t>(value) >> shift);
    return text;
}

std::string string(const std::string& text) {
    return bytes({0240, static_cast<int>(text.size())}) + text;
}

const std::string kDefineSphere = bytes({0314, 5, 0226}) + "Sphere";
const std::string kEncodedSphere = bytes({0246, 5, 0200, 1, 0200, 0377, 0200, 1, 0201, 1, 0150});

TEST(ReadBinary, RequestsAreDefinedAndUsed) {
    const ReadOutcome outcome =
        read_world(kDefineSphere + kEncodedSphere + " Color 1 0.5 0 " + kEncodedSphere + kEncodedSphere);
    EXPECT_THAT(outcome.messages, IsEmpty());
    ASSERT_EQ(outcome.count(), 3u);
    const Quadric& sphere = std::get<Quadric>(outcome.primitive(1).shape().topology);
    EXPECT_THAT(std::vector<float>(sphere.values.begin(), sphere.values.begin() + 4),
                ElementsAre(1, -1, 1, 360));
    EXPECT_EQ(outcome.attributes(1).color, V3f(1, 0.5f, 0));
}

TEST(ReadBinary, ValuesMixWithText) {
    const ReadOutcome outcome = read_world(
        "Color [" + bytes({0244, 0077, 0200, 0, 0}) + bytes({0204, 0200}) + "] " /* two numbers: an error */ +
        "Color" + bytes({0245, 0077, 0320, 0, 0, 0, 0, 0, 0}) + " 0.5" + bytes({0205, 2, 0200}) + "Surface" +
        string("plastic") + "\"Kd\"" + floats({0.25f}) + bytes({0315, 3}) + "\"P\"" + "Polygon" +
        bytes({0317, 3}) + floats({0, 0, 1, 1, 0, 1, 0, 1, 1}) + "Polygon \"P\" [" +
        floats({0, 0, 1, 1, 0, 1}) + " 0 1 1]");
    EXPECT_THAT(outcome.messages, ElementsAre(HasSubstr("Color: the colour has 2 numbers")));
    ASSERT_EQ(outcome.count(), 2u);
    EXPECT_EQ(outcome.attributes().color, V3f(0.25f, 0.5f, 2.5f));
    EXPECT_EQ(outcome.attributes().surface->name, "plastic");
    EXPECT_EQ(outcome.attributes().surface->parameters.find("Kd")->floats[0], 0.25f);
    for (const size_t i : {0, 1})
        EXPECT_THAT(outcome.primitive(i).shape().variables.find("P")->floats,
                    ElementsAre(0, 0, 1, 1, 0, 1, 0, 1, 1));
}

TEST(ReadBinary, IntegersMayBeArraysOfFloats) {
    const ReadOutcome outcome = read_world("PointsPolygons" + floats({3}) + floats({0, 1, 2}) + " \"P\"" +
                                           floats({0, 0, 1, 1, 0, 1, 0, 1, 1}));
    EXPECT_THAT(outcome.messages, IsEmpty());
    EXPECT_EQ(outcome.count(), 1u);
}

TEST(ReadBinary, ArchivesKnowWhatWasDefinedBefore) {
    const Folder folder;
    folder.write("b.rib", kEncodedSphere);
    const ReadOutcome outcome = read_files(
        folder, {folder.write("a.rib", "WorldBegin " + kDefineSphere + "ArchiveBegin \"x\" " +
                                           kEncodedSphere + " ArchiveEnd " + bytes({0314, 5}) + "\"Cone\" " +
                                           "ReadArchive \"x\" ReadArchive \"b.rib\" WorldEnd")});
    EXPECT_EQ(outcome.count(), 1u);
    EXPECT_THAT(outcome.messages,
                ElementsAre(HasSubstr("b.rib:1:1: error: an encoded request that is not defined")));
}

TEST(ReadBinary, SkippedBranchesDefineToo) {
    EXPECT_EQ(
        read_world("IfBegin \"0\" " + kDefineSphere + kEncodedSphere + " IfEnd " + kEncodedSphere).count(),
        1u);
}

TEST(ReadBinary, WhatIsWrongTakesItsRequestOnly) {
    const ReadOutcome outcome =
        read_world("Color " + bytes({0246, 9, 0200, 1}) + " Surface " + bytes({0317, 9}) + "\n" +
                   "Translate " + bytes({0377}) + "1 0 0\n" + bytes({0314, 1, 0200, 1}) + kSphere +
                   "Polygon \"P\" " + floats({0, std::numeric_limits<float>::infinity(), 0}) + " " + kSphere);
    EXPECT_EQ(outcome.count(), 2u);
    ASSERT_EQ(outcome.messages.size(), 5u);
    EXPECT_THAT(outcome.messages[0], HasSubstr("Color: the colour is missing"));
    EXPECT_THAT(outcome.messages[1], HasSubstr("an encoded request that is not defined: no such request"));
    EXPECT_THAT(outcome.messages[2], HasSubstr("Surface: an encoded string that is not defined"));
    EXPECT_THAT(outcome.messages[3], HasSubstr("Translate: a byte that RIB's encoding does not have"));
    EXPECT_THAT(outcome.messages[4], HasSubstr("Polygon: a value is not a finite number"));
}

TEST(ReadBinary, CutOffFilesAreReadAsFarAsTheyGo) {
    const ReadOutcome outcome =
        read_text("WorldBegin " + kSphere + "Polygon \"P\" " + bytes({0313, 0377, 0377, 0377, 0377, 1, 2}));
    EXPECT_EQ(outcome.count(), 1u);
    EXPECT_THAT(outcome.messages[0], HasSubstr("Polygon: an encoded value that reaches beyond the end"));
}

TEST(ReadBinary, ShortCodesDoNotMakeEndlessTexts) {
    std::string text =
        "Attribute \"user\" \"string x\" [" + bytes({0315, 1}) + '"' + std::string(4096, 'x') + '"';
    for (int i = 0; i < 17000; ++i) text += bytes({0317, 1});
    const ReadOutcome outcome = read_world(text + "]\nAttribute \"user\" \"string y\" [" + bytes({0315, 2}) +
                                           '"' + std::string(4097, 'y') + "\"]\n" + kSphere);
    ASSERT_EQ(outcome.messages.size(), 2u);
    EXPECT_THAT(outcome.messages[0], HasSubstr("an array of strings that are too long in all"));
    EXPECT_THAT(outcome.messages[1], HasSubstr("by more than 4096 bytes"));
}

}  // namespace
}  // namespace trapeze::testing
