/// Archives that are read again: parsed once, and still read as if their text was read anew.
#include "pipeline/rib/reading_harness.h"
#include "pipeline/rib/state/ready_archive.h"

namespace trapeze::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr const char* kOnePatch = "Patch \"bilinear\" \"P\" [0 0 0 1 0 0 0 1 0 1 1 0] ";

struct ArchiveFolder {
    Folder folder;

    explicit ArchiveFolder(const std::string& archive) { folder.write("part.rib", archive); }
    ReadOutcome read(const std::string& scene, const ReadOptions& options = {}) const {
        return read_files(folder, {folder.write("a.rib", scene)}, options);
    }
};

const std::string kRead = "ReadArchive \"part.rib\" ";

TEST(RereadArchives, TheSameShapesAreThereOnce) {
    const ArchiveFolder files(std::string("AttributeBegin Color 1 0 0 Geometry \"teapot\" AttributeEnd ") +
                              kOnePatch);
    const ReadOutcome r =
        files.read("WorldBegin " + kRead + "Color 0 0 1 Translate 0 0 5 " + kRead + "WorldEnd");
    EXPECT_THAT(r.messages, IsEmpty());
    const size_t half = r.count() / 2;
    ASSERT_EQ(r.count(), 2 * 33u);
    for (size_t i = 0; i < half; ++i)
        EXPECT_EQ(r.primitive(i).shape_keys, r.primitive(half + i).shape_keys) << i;
    EXPECT_EQ(r.attributes(65).color, V3f(0, 0, 1));
    EXPECT_EQ(r.attributes(33).color, V3f(1, 0, 0));
    EXPECT_EQ(r.primitive(65).camera_from_object[0].translation().z, 5);
    const ReadOutcome again = read_world(std::string("ArchiveBegin \"a\" ") + kOnePatch +
                                         "ArchiveEnd ReadArchive \"a\" ReadArchive \"a\" ");
    EXPECT_EQ(again.primitive(0).shape_keys, again.primitive(1).shape_keys);
}

TEST(RereadArchives, PosesOfAMotionAreSharedToo) {
    const ArchiveFolder files(std::string("MotionBegin [0 1] ") + kOnePatch +
                              "Patch \"bilinear\" \"P\" [0 0 1 1 0 1 0 1 1 1 1 1] MotionEnd");
    const ReadOutcome r = files.read("Shutter 0 1 WorldBegin " + kRead + kRead + "WorldEnd");
    ASSERT_EQ(r.count(), 2u);
    EXPECT_EQ(r.primitive(0).shape_keys.size(), 2u);
    EXPECT_EQ(r.primitive(0).shape_keys, r.primitive(1).shape_keys);
}

TEST(RereadArchives, WhatTheStateChangesIsAnotherShape) {
    const ArchiveFolder files(
        "Patch \"bicubic\" \"P\" [0 0 0 1 0 0 2 0 0 3 0 0 0 1 0 1 1 0 2 1 0 3 1 0 "
        "0 2 0 1 2 0 2 2 0 3 2 0 0 3 0 1 3 0 2 3 0 3 3 0] \"k\" [1]");
    const ReadOutcome r = files.read("Declare \"k\" \"constant float\" WorldBegin " + kRead +
                                     "Basis \"b-spline\" 1 \"b-spline\" 1 " + kRead + kRead +
                                     "Declare \"k\" \"uniform float\" " + kRead + "WorldEnd");
    EXPECT_THAT(r.messages, IsEmpty());
    ASSERT_EQ(r.count(), 4u);
    EXPECT_NE(r.primitive(0).shape_keys, r.primitive(1).shape_keys);
    EXPECT_EQ(std::get<PatchMesh>(r.primitive(1).shape().topology).u_step, 1);
    EXPECT_EQ(r.primitive(1).shape_keys, r.primitive(2).shape_keys);
    EXPECT_EQ(r.primitive(3).shape().variables.find("k")->declaration.storage, StorageClass::Uniform);
}

TEST(RereadArchives, ConditionsAreLookedAtEachTime) {
    const ArchiveFolder files(
        "IfBegin \"$user:big == 1\" Sphere 2 -1 1 360 Else Sphere 1 -1 1 360 IfEnd "
        "Attribute \"user\" \"float big\" 1");
    const ReadOutcome r =
        files.read("Attribute \"user\" \"float big\" 0 WorldBegin " + kRead + kRead + kRead + "WorldEnd");
    ASSERT_EQ(r.count(), 3u);
    for (const size_t i : {0, 1, 2})
        EXPECT_EQ(std::get<Quadric>(r.primitive(i).shape().topology).values[0], i == 0 ? 1 : 2) << i;
    EXPECT_EQ(r.primitive(1).shape_keys, r.primitive(2).shape_keys);
}

TEST(RereadArchives, ErrorsHaveTheirPlacesEachTime) {
    const ArchiveFolder files("Color 1 0 0\n  Sphere 1 -1 1\nSphere 1 -1 1 360\n");
    ReadOptions options;
    const ReadOutcome r = files.read("WorldBegin\n" + kRead + "\n" + kRead + "\nWorldEnd", options);
    EXPECT_EQ(r.count(), 2u);
    ASSERT_EQ(r.messages.size(), 1u) << "of a kind the first is shown";
    EXPECT_EQ(r.messages[0],
              "part.rib:2:3: error: Sphere: has 3 numbers, needs 4; primitive skipped\n"
              "    included from a.rib:2:1");
    const ReadOutcome late = files.read("IfBegin \"0\" IfEnd WorldBegin Declare \"x\" \"float\"\n" + kRead +
                                        "\nColor [\nWorldEnd");
    EXPECT_THAT(late.messages[0], HasSubstr("part.rib:2:3: error"));
}

/// The second reading alone has an error.
TEST(RereadArchives, PlacesNameTheReadingThatTheyAreOf) {
    const ArchiveFolder files("Color 1 0 0\n ObjectInstance 7\n");
    const ReadOutcome r = files.read("WorldBegin ObjectBegin 7 " + kSphere + "ObjectEnd\n" + kRead +
                                     "\nWorldEnd WorldBegin\n" + kRead + "\nWorldEnd");
    EXPECT_THAT(r.messages,
                ElementsAre("part.rib:2:2: error: ObjectInstance: no object \"7\"; request skipped\n"
                            "    included from a.rib:4:1"));
}

TEST(RereadArchives, WhatStandsBetweenRequestsIsSaidEachTime) {
    const ArchiveFolder files("5 6 " + kSphere);
    ReadOptions options;
    Diagnostics diagnostics;
    int worlds = 0;
    const std::vector<std::string> scene{
        files.folder.write("a.rib", "WorldBegin " + kRead + kRead + "WorldEnd")};
    read_rib(scene, options, diagnostics, [&](Scene&&) { ++worlds; });
    EXPECT_EQ(diagnostics.count(Severity::Error), 2u);
    EXPECT_EQ(worlds, 1);
}

TEST(RereadArchives, FilesThatChangeAreReadAnew) {
    const ArchiveFolder files(kSphere);
    ReadOptions options;
    options.on_request = [&](const rib::RequestText& request) {
        if (request.name == "Declare") files.folder.write("part.rib", "Sphere 22 -1 1 360");
        return true;
    };
    const ReadOutcome r =
        files.read("WorldBegin " + kRead + "Declare \"x\" \"float\" " + kRead + kRead + "WorldEnd", options);
    ASSERT_EQ(r.count(), 3u);
    EXPECT_EQ(std::get<Quadric>(r.primitive(0).shape().topology).values[0], 1);
    EXPECT_EQ(std::get<Quadric>(r.primitive(1).shape().topology).values[0], 22);
    EXPECT_EQ(r.primitive(1).shape_keys, r.primitive(2).shape_keys);
}

TEST(RereadArchives, ArchivesInThemAreReadAsEver) {
    const ArchiveFolder files("ArchiveBegin \"in\" " + kSphere +
                              "ArchiveEnd ReadArchive \"in\" ReadArchive \"b.rib\"");
    files.folder.write("b.rib", kOnePatch);
    const ReadOutcome r = files.read("WorldBegin " + kRead + kRead + "WorldEnd");
    EXPECT_THAT(r.messages, IsEmpty());
    ASSERT_EQ(r.count(), 4u);
    EXPECT_EQ(r.primitive(1).shape_keys, r.primitive(3).shape_keys);
    EXPECT_EQ(r.summary.requests.at("ReadArchive"), 6u);
    EXPECT_EQ(r.summary.files, 5);
}

TEST(RereadArchives, TheSceneLimitCountsSharedShapesOnce) {
    std::string points = "Points \"P\" [";
    for (int i = 0; i < 10000; ++i) points += "0 0 0 ";
    const ArchiveFolder files(points + "]");
    ReadOptions options;
    options.most_scene_bytes = uint64_t{1} << 20;
    std::string scene = "WorldBegin ";
    for (int i = 0; i < 20; ++i) scene += kRead;
    const ReadOutcome r = files.read(scene + "WorldEnd", options);
    EXPECT_EQ(r.count(), 20u);
    EXPECT_THAT(r.messages, IsEmpty());
}

TEST(ReadyArchive, RequestsAreKeptWithinTheirBudget) {
    rib::RequestText request;
    request.name = "Color";
    request.at = {3, 4, 5};
    request.arguments.emplace_back().at = {3, 4, 11};
    request.arguments.back().floats.assign(1000, 1.0f);
    uint64_t left = 6000;
    rib::ReadyArchive archive(&left);
    archive.add(request);
    EXPECT_LT(left, 2000u);
    archive.complete(77);
    ASSERT_TRUE(archive.is_complete());
    EXPECT_EQ(archive.text_bytes(), 77u);
    rib::RequestText copy;
    archive.copy(0, 9, copy);
    EXPECT_EQ(copy.name, "Color");
    EXPECT_EQ(copy.at.source, 9u);
    EXPECT_EQ(copy.at.column, 5u);
    EXPECT_EQ(copy.arguments[0].at.source, 9u);
    EXPECT_EQ(copy.arguments[0].floats, request.arguments[0].floats);

    rib::ReadyArchive second(&left);
    second.add(request);
    second.complete(77);
    EXPECT_FALSE(second.is_complete()) << "no room";
    archive.give_up();
    EXPECT_EQ(left, 6000u);
}

}  // namespace
}  // namespace trapeze::testing
