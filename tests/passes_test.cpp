/// Files of several passes, whose last frame looks up what the others made: shadows and reflections where
/// geometry says they are.
#include <OpenImageIO/imagebuf.h>

#include <algorithm>

#include "tests/program_harness.h"

namespace trapeze::testing {
namespace {

/// What is to be seen over -2..2 of x and y by an orthographic camera that looks along +z.
class Picture {
  public:
    explicit Picture(const std::filesystem::path& path) : image_(path.string()) {
        EXPECT_TRUE(image_.read(0, 0, true, OIIO::TypeDesc::FLOAT)) << image_.geterror();
    }
    float at(float x, float y, int channel) const {
        const auto& spec = image_.spec();
        const int px = static_cast<int>((x + 2) / 4 * static_cast<float>(spec.width));
        const int py = static_cast<int>((2 - y) / 4 * static_cast<float>(spec.height));
        return image_.getchannel(px, py, 0, channel);
    }

  private:
    OIIO::ImageBuf image_;
};

constexpr const char* kCamera = R"(Format 64 64 1
Projection "orthographic"
ScreenWindow -2 2 -2 2
PixelSamples 2 2
PixelFilter "box" 1 1
)";

/// A wall at z = 10, and before it at z = 6 a square from (-1, 0) to (0, 1).
constexpr const char* kWallAndSquare = R"(
Polygon "P" [-3 -3 10  3 -3 10  3 3 10  -3 3 10]
Polygon "P" [-1 0 6  0 0 6  0 1 6  -1 1 6]
)";

TEST(Passes, MakeTheFoldersOfTheirMaps) {
    WorkFolder folder;
    folder.write("a.rib", std::string(kCamera) + R"(
Display "./cache/light.z" "zfile" "z"
WorldBegin
)" + kWallAndSquare + R"(
WorldEnd
MakeShadow "./cache/light.z" "./maps/light.shd"
MakeShadow "missing.z" "./none/light.shd"
)");
    const Outcome outcome = run_program(folder, "render a.rib");
    EXPECT_TRUE(std::filesystem::is_regular_file(folder / "maps/light.shd")) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "none"));
}

TEST(Passes, OfAnotherMachineFindTheirMapsInTheWorkingFolder) {
    WorkFolder folder;
    folder.write("a.rib", std::string(kCamera) + R"(
FrameBegin 1
Display "/trapeze-none/maps/light.z" "zfile" "z"
WorldBegin
)" + kWallAndSquare + R"(
WorldEnd
MakeShadow "/trapeze-none/maps/light.z" "/trapeze-none/maps/light.shd"
FrameEnd
FrameBegin 2
Display "/trapeze-none/seen.exr" "openexr" "rgba"
WorldBegin
Surface "trapeze_map"
)" + kWallAndSquare + R"(
WorldEnd
FrameEnd
)");
    folder.write("trapeze_map.sl",
                 "surface trapeze_map() { Ci = 1 - shadow(\"/trapeze-none/maps/light.shd\", "
                 "P + vector(0, 0, -.1)); }");
    const Outcome outcome = run_program(folder, "render a.rib");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_TRUE(std::filesystem::is_regular_file(folder / "light.shd")) << outcome.err;
    const Picture picture(folder / "seen.exr");
    EXPECT_EQ(picture.at(-.5f, .5f, 0), 1);
}

TEST(Passes, AnEmptyWorldWithoutADisplayIsNoPicture) {
    WorkFolder folder;
    folder.write("a.rib", "WorldBegin WorldEnd\n" + std::string(kCamera) + R"(
Display "seen.exr" "openexr" "rgba"
WorldBegin
)" + kWallAndSquare + R"(
WorldEnd
)");
    const Outcome outcome = run_program(folder, "render a.rib -o out.exr");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "out.2.exr"));
    EXPECT_EQ(Picture(folder / "out.exr").at(1.5f, 1.5f, 3), 1) << "the wall covers all";
}

/// Light along (1/2, 0, 1): the square's shadow lies two units to the right of it.
class ShadowPasses : public ::testing::TestWithParam<std::string> {};

TEST_P(ShadowPasses, FallWhereTheLightIsHeldOff) {
    WorkFolder folder;
    folder.write("a.rib", std::string(kCamera) + R"(
FrameBegin 1
Format 256 256 1
ScreenWindow -6 6 -6 6
Display "light.z" ")" + GetParam() +
                              R"(" "z"
ConcatTransform [.894427 0 .447214 0  0 1 0 0  -.447214 0 .894427 0  4 0 5 1]
WorldBegin
)" + kWallAndSquare + R"(
WorldEnd
FrameEnd
MakeShadow "light.z" "light.shd"
FrameBegin 2
Display "seen.exr" "openexr" "rgb"
WorldBegin
LightSource "shadowdistant" 1 "from" [0 0 0] "to" [.5 0 1] "string shadowname" ["light.shd"]
Surface "matte"
)" + kWallAndSquare + R"(
WorldEnd
FrameEnd
)");
    const Outcome outcome = run_program(folder, "render a.rib");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const Picture seen(folder / "seen.exr");
    const float lit = 0.894427f;  // the cosine of the light's angle
    EXPECT_NEAR(seen.at(1.5f, 0.5f, 0), 0, 1e-3f) << "in the middle of the shadow";
    for (const auto& [x, y] : {std::pair(1.1f, 0.1f), {1.1f, 0.9f}, {1.9f, 0.1f}})
        EXPECT_NEAR(seen.at(x, y, 0), 0, 1e-3f) << "in a corner of it";
    for (const auto& [x, y] : {std::pair(0.85f, 0.5f), {1.5f, -0.15f}, {1.5f, 1.15f}, {-1.5f, -1.5f}})
        EXPECT_NEAR(seen.at(x, y, 0), lit, 1e-3f) << "beside it " << x << " " << y;
    for (const float x : {-0.9f, -0.5f, -0.1f})
        EXPECT_NEAR(seen.at(x, 0.5f, 0), lit, 1e-3f) << "on the square itself";
}

INSTANTIATE_TEST_SUITE_P(Drivers, ShadowPasses, ::testing::Values("zfile", "shadow", "openexr"));

/// A ball that reaches through a table, whose depth the first pass sees from above: without the table its
/// lowest point is at y = -0.4; a repelling plane lifts it off, and it ends in a flat foot.
TEST(BlobbyPasses, RepellingPlanesKeepBlobbiesOffWhatADepthFileSaw) {
    WorkFolder folder;
    const auto rib = [](const char* leaves) {
        return std::string(kCamera) + R"(
FrameBegin 1
Display "table.z" "zfile" "z"
Translate 0 0 5
Rotate -90 1 0 0
WorldBegin
Polygon "P" [-2 0 -2  -2 0 2  2 0 2  2 0 -2]
WorldEnd
FrameEnd
FrameBegin 2
Display "seen.exr" "openexr" "rgba"
Translate 0 0 5
WorldBegin
Surface "constant"
Translate 0 .6 0
Blobby )" + leaves +
               R"(
WorldEnd
FrameEnd
)";
    };
    folder.write("plain.rib", rib("1 [1001 0] [2 0 0 0  0 2 0 0  0 0 2 0  0 0 0 1]"));
    folder.write("lifted.rib", rib("2 [1001 0 1003 0 16 0 2 0 1] [2 0 0 0  0 2 0 0  0 0 2 0  0 0 0 1  "
                                   ".4 .01 .3 .08] [\"table.z\"]"));
    for (const bool lifted : {false, true}) {
        const Outcome outcome = run_program(folder, lifted ? "render lifted.rib" : "render plain.rib");
        ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
        EXPECT_EQ(outcome.err, "");
        const Picture seen(folder / "seen.exr");
        EXPECT_EQ(seen.at(0, 1, 3), 1);
        EXPECT_EQ(seen.at(0, 0.2f, 3), 1);
        for (const float y : {-0.1f, -0.3f}) EXPECT_EQ(seen.at(0, y, 3), lifted ? 0 : 1) << y;
        EXPECT_EQ(seen.at(0, -0.5f, 3), 0);
    }
    // One warning where the file is missing; the ball is whole.
    folder.write("missing.rib", rib("3 [1001 0 1003 0 16 1003 0 16 0 3 0 1 2] [2 0 0 0  0 2 0 0  0 0 2 0  "
                                    "0 0 0 1  .4 .01 .3 .08] [\"none.z\"]"));
    const Outcome outcome = run_program(folder, "render missing.rib");
    EXPECT_NE(outcome.err.find("none.z"), std::string::npos) << outcome.err;
    EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
    EXPECT_EQ(Picture(folder / "seen.exr").at(0, -0.3f, 3), 1);
}

TEST(EnvironmentPasses, MirrorsShowTheFaceTheyAreTurnedTo) {
    WorkFolder folder;
    std::string rib = kCamera;
    const char* const colors[] = {"1 0 0", "0 1 1", "0 1 0", "1 0 1", "0 0 1", "1 1 0"};
    for (int face = 0; face < 6; ++face) {
        const std::string number = std::to_string(face);
        rib += "FrameBegin " + number + "\nDisplay \"face" + number +
               ".exr\" \"openexr\" \"rgb\"\nWorldBegin\n" + "Surface \"constant\" Color [" + colors[face] +
               "]\n" + "Polygon \"P\" [-3 -3 1  3 -3 1  3 3 1  -3 3 1]\nWorldEnd\nFrameEnd\n";
    }
    rib += R"(
MakeCubeFaceEnvironment "face0.exr" "face1.exr" "face2.exr" "face3.exr" "face4.exr" "face5.exr" "a.env" 90 "box" 1 1
FrameBegin 6
Display "seen.exr" "openexr" "rgb"
WorldBegin
Surface "shinymetal" "texturename" ["a.env"]
Polygon "P" [-1 .2 4  1 .2 4  1 1.2 5  -1 1.2 5]
Polygon "P" [-1 -.2 4  1 -.2 4  1 -1.2 5  -1 -1.2 5]
Polygon "P" [1.2 -1 4  1.2 1 4  1.9 1 4.7  1.9 -1 4.7]
Polygon "P" [-1.9 -.2 4  -1.2 -.2 4  -1.2 .2 4  -1.9 .2 4]
WorldEnd
FrameEnd
)";
    folder.write("a.rib", rib);
    const Outcome outcome = run_program(folder, "render a.rib");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const Picture seen(folder / "seen.exr");
    const auto expect = [&](float x, float y, float r, float g, float b) {
        EXPECT_NEAR(seen.at(x, y, 0), r, 0.02f) << x << " " << y;
        EXPECT_NEAR(seen.at(x, y, 1), g, 0.02f) << x << " " << y;
        EXPECT_NEAR(seen.at(x, y, 2), b, 0.02f) << x << " " << y;
    };
    expect(0, 0.7f, 0, 1, 0);       // leans back: shows +y
    expect(0, -0.7f, 1, 0, 1);      // shows -y
    expect(1.5f, 0, 1, 0, 0);       // shows +x
    expect(-1.5f, 0.05f, 1, 1, 0);  // faces the camera: shows -z
}

/// `-o` names the picture that is left when all maps have been made; passes are found whatever their name.
TEST(Passes, AreFoundWhenTheOutputIsNamed) {
    WorkFolder folder;
    folder.write("a.rib", std::string(kCamera) + R"(
FrameBegin 1
Display "glaze.exr" "file" "rgb"
WorldBegin
Surface "constant"
Color 0 1 0
Polygon "P" [-3 -3 5  3 -3 5  3 3 5  -3 3 5]
WorldEnd
FrameEnd
MakeTexture "glaze.exr" "glaze.tex" "clamp" "clamp" "box" 1 1
FrameBegin 2
Display "seen.exr" "file" "rgb"
WorldBegin
LightSource "ambientlight" 1
Surface "paintedplastic" "Ka" 1 "texturename" ["glaze.tex"]
Polygon "P" [-3 -3 5  3 -3 5  3 3 5  -3 3 5]
WorldEnd
FrameEnd
)");
    const Outcome outcome = run_program(folder, "render a.rib -o out.exr");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "out.2.exr"));
    const Picture seen(folder / "out.exr");
    EXPECT_NEAR(seen.at(0.5f, 0.5f, 0), 0, 1e-3f);
    EXPECT_NEAR(seen.at(0.5f, 0.5f, 1), 1, 1e-3f);
}

}  // namespace
}  // namespace trapeze::testing
