#include "pipeline/rib/reading_harness.h"

namespace trapeze::testing {
namespace {

using Kind = MapRequest::Kind;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

struct Read {
    std::vector<MapRequest> maps;
    std::vector<std::string> order;  ///< what was handed over, in order
    std::vector<std::string> messages;
};

Read read_maps(const std::string& text, ReadOptions options = {}) {
    const Folder folder;
    Read read;
    options.on_map = [&](const MapRequest& request) {
        read.maps.push_back(request);
        read.order.push_back(request.map);
    };
    Diagnostics diagnostics([&](const Diagnostic& d) { read.messages.push_back(to_string(d)); });
    const std::string file = folder.write("a.rib", text);
    read_rib(std::vector<std::string>{file}, options, diagnostics,
             [&](Scene&& scene) { read.order.push_back("world " + std::to_string(scene.options.frame)); });
    return read;
}

TEST(ReadMaps, RequestsAreReadWhole) {
    const Read read = read_maps(
        "Option \"searchpath\" \"texture\" [\"/pictures\"]\n"
        "MakeTexture \"a.tif\" \"a.tex\" \"clamp\" \"black\" \"gaussian\" 2 3 \"string note\" [\"x\"]\n"
        "MakeBump \"b.tif\" \"b.tex\" \"periodic\" \"periodic\" \"box\" 1 1\n"
        "MakeLatLongEnvironment \"c.tif\" \"c.env\" \"catmull-rom\" 3 3\n"
        "MakeCubeFaceEnvironment \"px\" \"nx\" \"py\" \"ny\" \"pz\" \"nz\" \"d.env\" 95 \"box\" 1 1\n"
        "MakeShadow \"e.z\" \"e.shd\"\n");
    EXPECT_THAT(read.messages, ::testing::IsEmpty());
    ASSERT_EQ(read.maps.size(), 5u);
    const MapRequest& texture = read.maps[0];
    EXPECT_EQ(texture.kind, Kind::Texture);
    EXPECT_THAT(texture.pictures, ElementsAre("a.tif"));
    EXPECT_EQ(texture.map, "a.tex");
    EXPECT_EQ(texture.swrap, "clamp");
    EXPECT_EQ(texture.twrap, "black");
    EXPECT_EQ(texture.filter, "gaussian");
    EXPECT_EQ(texture.folders.front(), "/pictures");
    EXPECT_EQ(texture.location.line, 2u);
    EXPECT_EQ(read.maps[1].kind, Kind::Bump);
    EXPECT_EQ(read.maps[2].kind, Kind::LatLongEnvironment);
    EXPECT_EQ(read.maps[2].filter, "catmull-rom");
    EXPECT_EQ(read.maps[3].kind, Kind::CubeFaceEnvironment);
    EXPECT_THAT(read.maps[3].pictures, ElementsAre("px", "nx", "py", "ny", "pz", "nz"));
    EXPECT_EQ(read.maps[3].fov, 95);
    EXPECT_EQ(read.maps[3].map, "d.env");
    EXPECT_EQ(read.maps[4].kind, Kind::Shadow);
    EXPECT_THAT(read.maps[4].pictures, ElementsAre("e.z"));
    EXPECT_EQ(read.maps[4].map, "e.shd");
}

/// As for textures: some exporters write them.
TEST(ReadMaps, ACubeMayHaveWrapModes) {
    const Read read = read_maps(
        "MakeCubeFaceEnvironment \"px\" \"nx\" \"py\" \"ny\" \"pz\" \"nz\" \"d.env\" 90 \"black\" \"clamp\" "
        "\"sinc\" 2 2\n");
    EXPECT_THAT(read.messages, ::testing::IsEmpty());
    ASSERT_EQ(read.maps.size(), 1u);
    EXPECT_EQ(read.maps[0].filter, "sinc");
}

const std::string kFrames =
    "FrameBegin 1 WorldBegin WorldEnd MakeShadow \"a.z\" \"in 1\" FrameEnd MakeShadow \"a.z\" \"after 1\"\n"
    "FrameBegin 2 WorldBegin WorldEnd FrameEnd\n";

TEST(ReadMaps, ComeBetweenWorldsInTheOrderOfTheFile) {
    EXPECT_THAT(read_maps(kFrames).order, ElementsAre("world 1", "in 1", "after 1", "world 2"));
}

TEST(ReadMaps, AreNotMadeInFramesThatAreNotWanted) {
    ReadOptions options;
    options.wants_frame = [](int frame) { return frame == 2; };
    EXPECT_THAT(read_maps(kFrames, options).order, ElementsAre("after 1", "world 2"));
}

TEST(ReadMaps, WrongOnesAreReportedAndSkipped) {
    const Read read = read_maps(
        "MakeShadow \"only one name\"\n"
        "MakeTexture \"a\" \"b\" \"clamp\"\n"
        "MakeCubeFaceEnvironment \"px\" \"nx\" \"py\" \"ny\" \"pz\" \"nz\" \"d.env\" 20 \"box\" 1 1\n"
        "WorldBegin MakeShadow \"a.z\" \"a.shd\" WorldEnd\n"
        "MakeShadow \"b.z\" \"b.shd\"\n");
    ASSERT_EQ(read.messages.size(), 4u);
    EXPECT_THAT(read.messages[2], HasSubstr("field of view"));
    EXPECT_THAT(read.messages[3], HasSubstr("inside a world"));
    EXPECT_THAT(read.order, ElementsAre("world 0", "b.shd"));
}

TEST(ReadMaps, AreOnlyCheckedWhereNobodyMakesThem) {
    const ReadOutcome outcome = read_text("MakeShadow \"a.z\" \"a.shd\"\nMakeShadow 1\n");
    EXPECT_EQ(outcome.messages.size(), 1u);
    EXPECT_EQ(outcome.summary.requests.at("MakeShadow"), 2u);
}

TEST(ReadMaps, TakeNumbersAsTheOptionOrTheirOwnColorspaceSays) {
    const Read read = read_maps(
        "MakeTexture \"a.tif\" \"a.tex\" \"clamp\" \"black\" \"box\" 1 1\n"
        "Option \"color\" \"transfer\" [\"auto\"]\n"
        "MakeTexture \"b.tif\" \"b.tex\" \"clamp\" \"black\" \"box\" 1 1 \"colorspace\" \"srgb\"\n"
        "MakeBump \"c.tif\" \"c.tex\" \"clamp\" \"black\" \"box\" 1 1 \"string colorspace\" [\"gamma\"]\n");
    ASSERT_EQ(read.maps.size(), 3u);
    EXPECT_EQ(read.maps[0].transfer, Transfer::Linear);
    EXPECT_FALSE(read.maps[0].colorspace);
    EXPECT_EQ(read.maps[1].transfer, Transfer::Auto);
    EXPECT_EQ(read.maps[1].colorspace, Transfer::Srgb);
    EXPECT_FALSE(read.maps[2].colorspace);
    EXPECT_THAT(read.messages,
                ElementsAre(HasSubstr("a.rib:4:1: error: MakeBump: \"colorspace\" is \"linear\", \"srgb\" "
                                      "or \"auto\", not \"gamma\"")));
}

}  // namespace
}  // namespace trapeze::testing
