/// The program from outside: pictures in tiles that several runs make, and the command that joins them.
#include <map>

#include "tests/command_line/command_line_harness.h"

namespace trapeze::testing {
namespace {

/// Two runs give the same bytes, which also have the same date.
class Tiles : public ::testing::Test {
  protected:
    void SetUp() override { setenv("SOURCE_DATE_EPOCH", "0", 1); }
    void TearDown() override { unsetenv("SOURCE_DATE_EPOCH"); }

    Outcome run(const std::string& arguments) { return run_program(folder_, arguments); }
    void expect_ok(const std::string& arguments) {
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.exit_code, 0) << arguments << "\n" << outcome.err;
        EXPECT_EQ(outcome.err, "") << arguments;
    }
    /// Renders all tiles of a grid.
    void render_tiles(const std::string& arguments, int columns, int rows) {
        for (int number = 1; number <= columns * rows; ++number)
            expect_ok("render " + arguments + " --tiles " + std::to_string(columns) + "x" +
                      std::to_string(rows) + " --tile " + std::to_string(number));
    }
    /// Renders a scene at once and in 3x2 tiles: joined, each of its pictures must be the same file.
    void expect_same(const std::string& scene, const std::vector<std::string>& pictures) {
        SCOPED_TRACE(scene);
        expect_ok("render -q '" + scene + "'");
        std::map<std::string, std::string> whole;
        for (const std::string& picture : pictures) {
            whole[picture] = file_text(folder_ / (picture + ".exr"));
            EXPECT_FALSE(whole[picture].empty()) << picture;
            fs::remove(folder_ / (picture + ".exr"));
        }
        render_tiles("-q '" + scene + "'", 3, 2);
        for (const std::string& picture : pictures) {
            expect_ok("merge " + picture + ".tile[1-6].exr -o " + picture + ".exr");
            EXPECT_TRUE(file_text(folder_ / (picture + ".exr")) == whole[picture]) << picture;
        }
    }
    bool has(const std::string& name) const { return fs::exists(folder_ / name); }

    WorkFolder folder_;
};

std::string tiny(const std::string& name) {
    return TRAPEZE_SOURCE_DIR "/scenes/tiny/" + name + ".rib";
}

TEST_F(Tiles, JoinedAreTheFileOfTheWholePicture) {
    expect_same(tiny("aov"), {"aov", "aov_N", "aov_diffuse", "aov_facing", "aov_s", "aov_specular", "aov_z"});
    expect_same(tiny("display_outputs"), {"display_outputs", "display_outputs_z"});
}

TEST_F(Tiles, OfBlurWideFiltersAndDisplacementAreTheSame) {
    for (const char* name : {"motion_both", "filter_box_wide", "displacement_dented", "imager_glow", "crop"})
        expect_same(tiny(name), {name});
    folder_.write("all.rib", R"(Format 61 47 1 PixelSamples 3 3 PixelFilter "gaussian" 5 5 Shutter 0 1
Projection "perspective" "fov" 40 DepthOfField 4 .5 5 Translate 0 0 5 CropWindow .1 .93 .05 1
Display "all.exr" "openexr" "rgbaz" "exrcompression" "piz"
Display "+all_id.exr" "openexr" "id" "string storage" "tiled" "int tilesize" [16]
Display "+all.exr" "openexr" "id"
Display "+all.exr" "openexr" "point P"
Display "+all_id.exr" "openexr" "normal N"
WorldBegin LightSource "distantlight" 1 Surface "plastic"
Attribute "displacementbound" "sphere" [.3] Displacement "dented" "Km" [.3]
MotionBegin [0 1] Rotate 0 0 1 0 Rotate 40 1 1 0 MotionEnd Sphere 1.3 -1 1.3 360 WorldEnd
)");
    expect_same("all.rib", {"all", "all_id"});
    const std::string whole = file_text(folder_ / "all.exr");
    render_tiles("-q all.rib -o x.exr", 2, 2);
    expect_ok("merge x.tile?.exr -o x.exr");
    EXPECT_TRUE(file_text(folder_ / "x.exr") == whole) << "-o names the file of all layers";
}

TEST_F(Tiles, HaveTheirNumberInTheNamesOfFiles) {
    folder_.write("a.rib", kSphereScene);
    expect_ok("render a.rib --tiles 4x3 --tile 7");
    EXPECT_EQ(run("render a.rib --tiles 2x2 --tile 3 -o x.png").exit_code, 0);
    expect_ok("render a.rib --tiles 4x3 --tile 7 -o 'y.<tile>.exr'");
    expect_ok("render a.rib --tiles 4x3 --tile 7 -o 'made/<tile>.<frame>.exr'");
    EXPECT_EQ(files_in(folder_).size(),
              std::string("a.rib made sphere.tile07.exr x.tile3.png y.07.exr ").size())
        << files_in(folder_);
    for (const char* name : {"sphere.tile07.exr", "x.tile3.png", "y.07.exr", "made/07.0.exr"})
        EXPECT_TRUE(has(name)) << name;
}

TEST_F(Tiles, OfSeveralFramesHaveNamesOfTheirOwn) {
    const std::string world = "Format 8 8 1 WorldBegin Translate 0 0 2 Sphere 1 -1 1 360 WorldEnd FrameEnd\n";
    const std::string empty = "Format 8 8 1 WorldBegin Translate 9 9 2 Sphere 1 -1 1 360 WorldEnd FrameEnd\n";
    folder_.write("a.rib", "FrameBegin 1 " + empty + "FrameBegin 2 " + world + "FrameBegin 3 " + world);
    expect_ok("render a.rib -o 'x.##.exr' -f 2-3 -r 9x7 --crop 0 1 0 .5 --tiles 2x2 --tile 1");
    EXPECT_EQ(files_in(folder_).size(), std::string("a.rib x.02.tile1.exr x.03.tile1.exr ").size());
    EXPECT_TRUE(has("x.02.tile1.exr") && has("x.03.tile1.exr")) << files_in(folder_);
    // In no tile may a frame's name depend on whether it shows something there.
    expect_ok("render a.rib -o y.exr --tiles 2x2 --tile 1");
    EXPECT_TRUE(has("y.tile1.exr") && has("y.2.tile1.exr") && has("y.3.tile1.exr")) << files_in(folder_);
    const Outcome merged = run("merge x.02.tile1.exr x.03.tile1.exr -o z.exr --allow-missing");
    EXPECT_EQ(merged.exit_code, 4) << merged.err;
    EXPECT_NE(merged.err.find("\"x.02.tile1.exr\" and \"x.03.tile1.exr\" are not of one picture"),
              std::string::npos)
        << merged.err;
    EXPECT_FALSE(has("z.exr"));
}

TEST_F(Tiles, AreChosenByTwoOptions) {
    folder_.write("a.rib", kSphereScene);
    const std::pair<const char*, const char*> cases[] = {
        {"--tiles 2x2", "--tiles needs --tile"},
        {"--tile 1", "--tile needs --tiles"},
        {"--tiles 4x3 --tile 13", "--tile: 13 is not a tile of 4x3, which are 12"},
        {"--tiles 4x3 --tile 0", "--tile: \\\"0\\\" is not a whole number from 1 to"},
        {"--tiles 4 --tile 1", "--tiles: \\\"4\\\" is not NxM like 4x3, each from 1 to 4096"},
        {"--tiles 4x0 --tile 1", "--tiles: \\\"4x0\\\" is not NxM like 4x3, each from 1 to 4096"},
        {"--tiles 5000x1 --tile 1", "each from 1 to 4096"}};
    for (const auto& [options, message] : cases) {
        const Outcome outcome = run(std::string("render a.rib ") + options);
        EXPECT_EQ(outcome.exit_code, 2) << options;
        std::string expected = message;
        for (size_t at; (at = expected.find('\\')) != std::string::npos;) expected.erase(at, 1);
        EXPECT_NE(outcome.err.find(expected), std::string::npos) << options << "\n" << outcome.err;
    }
    const Outcome many = run("render a.rib --tiles 65x2 --tile 1");
    EXPECT_EQ(many.exit_code, 4);
    EXPECT_NE(many.err.find("64x48 pixels can be divided into 64x48 tiles at most, not into 65x2"),
              std::string::npos)
        << many.err;
    EXPECT_EQ(files_in(folder_), "a.rib ");
}

/// A depth pass and a picture, of which maps are made, and a picture that looks them up.
constexpr const char* kPassesOfTiles = R"(Format 32 32 1 PixelSamples 1 1
Projection "perspective" "fov" 40 Translate 0 0 5
FrameBegin 1
  Display "light.z" "zfile" "z"
  WorldBegin Sphere 1 -1 1 360 WorldEnd
  MakeShadow "light.z" "light.shd"
FrameEnd
FrameBegin 2
  Display "painting.tif" "tiff" "rgb"
  WorldBegin Color [1 .5 .2] Surface "constant" Sphere 1 -1 1 360 WorldEnd
FrameEnd
MakeTexture "painting.tif" "painting.tex" "clamp" "clamp" "gaussian" 2 2
FrameBegin 3
  Display "beauty.exr" "openexr" "rgba"
  WorldBegin
    LightSource "shadowspot" 1 "shadowname" "light.shd" "from" [0 0 -5] "to" [0 0 0] "intensity" [20]
    LightSource "ambientlight" 2
    Surface "paintedplastic" "texturename" "painting.tex"
    Sphere 1 -1 1 360
  WorldEnd
FrameEnd
)";

TEST_F(Tiles, PassesThatMapsAreMadeOfAreWhole) {
    folder_.write("a.rib", kPassesOfTiles);
    expect_ok("render a.rib");
    const std::string whole = file_text(folder_ / "beauty.exr");
    for (const char* name : {"light.z", "light.shd", "painting.tif", "painting.tex"})
        fs::remove(folder_ / name);
    render_tiles("a.rib -o x.exr", 2, 2);
    expect_ok("merge x.tile1.exr x.tile2.exr x.tile3.exr x.tile4.exr -o x.exr");
    EXPECT_FALSE(whole.empty());
    EXPECT_TRUE(file_text(folder_ / "x.exr") == whole);
    for (const char* name : {"light.z", "light.shd", "painting.tif", "painting.tex"})
        EXPECT_TRUE(has(name)) << name;
    EXPECT_EQ(files_in(folder_).find("x.tile1.1.exr"), std::string::npos);
    EXPECT_FALSE(has("painting.tile1.tif"));

    // What is read once cannot be looked at before.
    const Outcome piped = run("render - --tiles 2x2 --tile 1 < a.rib");
    EXPECT_EQ(piped.exit_code, 1);
    EXPECT_NE(piped.err.find("cannot make \"painting.tex\": of \"painting.tif\" there is only a tile"),
              std::string::npos)
        << piped.err;
}

TEST_F(Tiles, HaveNoDepthMapsAndNoBakedPoints) {
    folder_.write("bakes.sl",
                  "surface bakes() { bake3d(\"a.ptc\", \"\", P, N, \"color\", Cs); Ci = Cs; Oi = 1; }");
    folder_.write("a.rib",
                  "Format 16 16 1 Display \"a.exr\" \"openexr\" \"rgba\" Display \"+a.z\" \"zfile\" \"z\" "
                  "WorldBegin Translate 0 0 2 Surface \"bakes\" Sphere 1 -1 1 360 WorldEnd\n");
    const Outcome outcome = run("render a.rib --tiles 2x2 --tile 1");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_NE(outcome.err.find("warning: depth map \"a.z\" is not written"), std::string::npos)
        << outcome.err;
    EXPECT_NE(outcome.err.find("warning: bake3d: \"a.ptc\" is not written"), std::string::npos)
        << outcome.err;
    EXPECT_TRUE(has("a.tile1.exr"));
    EXPECT_FALSE(has("a.z") || has("a.tile1.z") || has("a.ptc")) << files_in(folder_);
}

TEST_F(Tiles, ThatAreMissingAreNamed) {
    folder_.write("a.rib", kSphereScene);
    for (const char* number : {"1", "2", "4"})
        expect_ok(std::string("render a.rib --tiles 2x2 --tile ") + number);
    const Outcome refused = run("merge sphere.tile*.exr -o whole.exr");
    EXPECT_EQ(refused.exit_code, 4);
    EXPECT_NE(refused.err.find("error: tile 3 of 2x2 is missing; --allow-missing"), std::string::npos)
        << refused.err;
    EXPECT_FALSE(has("whole.exr"));
    const Outcome allowed = run("merge sphere.tile*.exr -o whole.exr --allow-missing");
    EXPECT_EQ(allowed.exit_code, 0);
    EXPECT_NE(allowed.err.find("warning: tile 3 of 2x2 is missing"), std::string::npos) << allowed.err;
    EXPECT_TRUE(has("whole.exr"));
}

TEST_F(Tiles, ThatCannotBeJoinedAreTold) {
    folder_.write("a.rib", kSphereScene);
    render_tiles("a.rib", 2, 1);
    const std::string tiles = "merge sphere.tile1.exr sphere.tile2.exr ";
    EXPECT_EQ(run("merge sphere.tile1.exr a.rib -o x.exr").exit_code, 3);
    EXPECT_EQ(run("merge sphere.tile1.exr none.exr -o x.exr").exit_code, 3);
    EXPECT_EQ(run(tiles + "-o none/x.exr").exit_code, 6);
    for (const std::string& arguments :
         {std::string("merge"), std::string("merge -o x.exr"), std::string("merge sphere.tile1.exr"),
          tiles + "-o -", tiles + "-o sphere.tile2.exr"}) {
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.exit_code, 2) << arguments << "\n" << outcome.err;
        EXPECT_NE(outcome.err, "") << arguments;
    }
    EXPECT_EQ(files_in(folder_).find("x.exr"), std::string::npos) << files_in(folder_);
}

}  // namespace
}  // namespace trapeze::testing
