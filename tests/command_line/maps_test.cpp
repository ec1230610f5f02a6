/// The program from outside: passes, maps made of them, variables of shaders.

#include "core/files/temporary_folder_harness.h"
#include "core/random.h"
#include "tests/command_line/command_line_harness.h"

namespace trapeze::testing {
namespace {

TEST(CommandLine, TexturesThatPathTracersMissAreErrors) {
    WorkFolder folder;
    folder.write("a.rib", R"(Format 32 32 1
Translate 0 0 3
WorldBegin
Pattern "PxrTexture" "map" "string filename" ["none.tex"]
Bxdf "PxrDisney" "skin" "reference color baseColor" ["map:resultRGB"]
Sphere 1 -1 1 360
WorldEnd
)");
    const Outcome outcome = run_program(folder, "render a.rib");
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_NE(outcome.err.find("error: texture \"none.tex\": is not found"), std::string::npos)
        << outcome.err;
    EXPECT_TRUE(std::filesystem::exists(folder / "a.exr"));
}

/// A depth pass and a picture that the last frame looks up.
constexpr const char* kPasses = R"(Format 32 32 1
PixelSamples 1 1
Projection "perspective" "fov" 40
Translate 0 0 5
FrameBegin 1
  Display "light.z" "zfile" "z"
  WorldBegin
    Sphere 1 -1 1 360
  WorldEnd
  MakeShadow "light.z" "light.shd"
FrameEnd
FrameBegin 2
  Display "painting.tif" "tiff" "rgb"
  WorldBegin
    Surface "constant"
    Sphere 1 -1 1 360
  WorldEnd
FrameEnd
MakeTexture "painting.tif" "painting.tex" "clamp" "clamp" "gaussian" 2 2
FrameBegin 3
  Display "beauty.exr" "openexr" "rgba"
  WorldBegin
    LightSource "ambientlight" 1
    Surface "paintedplastic" "texturename" "painting.tex"
    Sphere 1 -1 1 360
  WorldEnd
FrameEnd
)";

TEST(CommandLine, MapsAreMadeBetweenFrames) {
    WorkFolder folder;
    folder.write("a.rib", kPasses);
    const Outcome outcome = run_program(folder, "render a.rib");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(files_in(folder).find(".part"), std::string::npos) << files_in(folder);
    for (const char* file : {"light.z", "light.shd", "painting.tex", "beauty.exr"})
        EXPECT_TRUE(fs::exists(folder / file)) << file;
}

TEST(CommandLine, CheckFindsWhatIsMissing) {
    WorkFolder folder;
    const std::string scene = R"(ShadingRate 4
MakeTexture "lost.tif" "made.tex" "clamp" "clamp" "box" 1 1
WorldBegin
LightSource "shadowspot" 1 "shadowname" "lost.shd"
LightSource "lostlight" 2
Surface "paintedplastic" "texturename" "lost.tex"
Displacement "lostbumps"
Sphere 1 -1 1 360
Surface "paintedplastic" "texturename" "made.tex"
Sphere 1 -1 1 360
Surface "never"
Surface "paintedplastic"
Sphere 1 -1 1 360
ReadArchive "lost.rib"
Procedural "RunProgram" ["lost-program" ""] [-1 1 -1 1 -1 1]
WorldEnd
)";
    folder.write("a.rib", scene);
    const Outcome checked = run_program(folder, "check a.rib");
    EXPECT_EQ(checked.exit_code, 1);
    for (const char* text : {"a.rib:2:1: error: cannot make \"made.tex\" from \"lost.tif\"",
                             "texture \"lost.shd\": is not found",
                             "a.rib:5:1: error: LightSource: there is no shader \"lostlight\"",
                             "texture \"lost.tex\": is not found",
                             "a.rib:7:1: error: Displacement: there is no shader \"lostbumps\"",
                             "a.rib:14:1: error: ReadArchive: \"lost.rib\" is not found",
                             "the program \"lost-program\" is not found"})
        EXPECT_NE(checked.err.find(text), std::string::npos) << text << "\n" << checked.err;
    EXPECT_EQ(files_in(folder), "a.rib ");

    folder.write("passes.rib", kPasses);
    EXPECT_EQ(run_program(folder, "check --strict passes.rib").exit_code, 0) << "maps are made on the way";
}

TEST(CommandLine, TheOutputIsNotThatOfADepthPass) {
    WorkFolder folder;
    folder.write("a.rib", kPasses);
    const Outcome outcome = run_program(folder, "render a.rib -o x.tif");
    EXPECT_TRUE(fs::exists(folder / "light.z"));
    EXPECT_TRUE(fs::exists(folder / "light.shd"));
    EXPECT_TRUE(fs::exists(folder / "x.tif"));
    EXPECT_FALSE(fs::exists(folder / "x.2.tif"));  // the painting is a pass too
}

TEST(CommandLine, ADepthPassAloneIsSeenAsAPictureToo) {
    WorkFolder folder;
    const std::string world = "Format 8 8 1 WorldBegin Translate 0 0 2 Sphere 1 -1 1 360 WorldEnd\n";
    folder.write("pass.rib", "Display \"z.shd\" \"shadow\" \"z\" " + world);
    EXPECT_EQ(run_program(folder, "render pass.rib -o a.png").exit_code, 0);
    EXPECT_TRUE(fs::exists(folder / "z.shd"));
    EXPECT_TRUE(fs::exists(folder / "a.png"));
    folder.write("depth.rib", "Display \"null\" \"null\" \"z\" " + world);
    EXPECT_EQ(run_program(folder, "render depth.rib -o b.png").exit_code, 0);
    EXPECT_TRUE(fs::exists(folder / "b.png"));
}

TEST(CommandLine, AMapThatCannotBeMadeIsAnError) {
    WorkFolder folder;
    folder.write("a.rib", std::string("MakeShadow \"nowhere.z\" \"a.shd\"\n") + kSphereScene);
    const Outcome outcome = run_program(folder, "render a.rib");
    EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
    EXPECT_NE(outcome.err.find("a.rib:1:1: error: cannot make \"a.shd\" from \"nowhere.z\""),
              std::string::npos)
        << outcome.err;
    EXPECT_TRUE(fs::exists(folder / "sphere.exr"));
}

TEST(CommandLine, MapsThatADiskDoesNotHoldEndWithSix) {
    WorkFolder folder;
    std::string noise = "P3 64 64 255";
    for (uint32_t i = 0; i < 3 * 64 * 64; ++i) noise += " " + std::to_string(hash(i) % 256);
    folder.write("noise.ppm", noise);
    folder.write("a.rib", "MakeTexture \"noise.ppm\" \"noise.tex\" \"periodic\" \"periodic\" \"box\" 1 1\n" +
                              std::string(kSphereScene));
    const std::string before = files_in(folder);
    Outcome outcome;
    {
        const FileSizeLimit full(8000);
        outcome = run_program(folder, "render -d null a.rib");
    }
    EXPECT_EQ(outcome.exit_code, 6) << outcome.err;
    EXPECT_NE(outcome.err.find("a.rib:1:1: error: cannot make \"noise.tex\" from \"noise.ppm\""),
              std::string::npos)
        << outcome.err;
    EXPECT_EQ(files_in(folder), before);
}

/// A sphere by a shader of its own, whose variables are shown, too.
constexpr const char* kVariables = R"(Format 64 48 1
PixelSamples 2 2
Projection "perspective" "fov" 40
Display "sphere.exr" "openexr" "rgba"
Display "+height.tif" "tiff" "varying float height" "quantize" [0 0 0 0]
Display "+nosuch.exr" "openexr" "color nosuch"
Imager "lost"
Translate 0 0 5
WorldBegin
Surface "tall"
Sphere 1 -1 1 360
WorldEnd
)";

TEST(CommandLine, VariablesOfShadersAreWrittenAndMissingOnesWarnedOf) {
    WorkFolder folder;
    folder.write("a.rib", kVariables);
    folder.write("tall.sl",
                 "surface tall(output varying float height = 0;) { height = 2 + t; Ci = Oi = 1; }");
    const Outcome outcome = run_program(folder, "render a.rib");
    EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
    for (const char* file : {"sphere.exr", "height.tif", "nosuch.exr"})
        EXPECT_TRUE(fs::exists(folder / file)) << file;
    const auto warned = [&](const std::string& text) {
        const size_t first = outcome.err.find(text);
        return first != std::string::npos && outcome.err.find(text, first + 1) == std::string::npos;
    };
    EXPECT_TRUE(warned(
        "a.rib:6:1: warning: Display \"nosuch.exr\": no surface or displacement shader of the scene has a variable \"nosuch\""))
        << outcome.err;
    EXPECT_TRUE(warned("a.rib:7:1: error: Imager: there is no shader \"lost\"")) << outcome.err;
    EXPECT_EQ(outcome.err.find("height"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace trapeze::testing
