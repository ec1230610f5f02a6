/// The program from outside: exit codes, messages, outputs that appear whole or not at all, interruption.
#include <csignal>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "tests/program.h"

namespace trapeze::testing {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSphere = R"(Format 64 48 1
PixelSamples 2 2
Projection "perspective" "fov" 40
Display "sphere.exr" "openexr" "rgbaz"
Translate 0 0 5
WorldBegin
LightSource "distantlight" 1
Surface "plastic"
Sphere 1 -1 1 360
WorldEnd
)";

/// A scene that takes minutes, for interrupting.
constexpr const char* kSlow = R"(Format 1920 1080 1
PixelSamples 32 32
Projection "perspective" "fov" 40
Display "slow.exr" "openexr" "rgba"
Translate 0 0 3
WorldBegin
ShadingRate 0.05
Sphere 1 -1 1 360
WorldEnd
)";

std::string files_in(const WorkFolder& folder) {
    std::string names;
    for (const auto& entry : fs::directory_iterator(folder.path()))
        if (const std::string name = entry.path().filename(); name != ".stdout" && name != ".stderr")
            names += name + " ";
    return names;
}

TEST(CommandLine, RendersASceneAndWritesItsDisplay) {
    WorkFolder folder;
    folder.write("a.rib", kSphere);
    const Outcome outcome = run_program(folder, "render a.rib");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_TRUE(fs::exists(folder / "sphere.exr"));
}

TEST(CommandLine, ChecksShaders) {
    WorkFolder folder;
    folder.write("half.h", "#define HALF .5\n");
    fs::create_directories(folder / "more/yet");
    std::ofstream(folder / "more/yet/twice.h") << "float twice(float x) { return x * 2; }\n";
    folder.write("a.sl",
                 "#include \"half.h\"\n#include <twice.h>\n"
                 "surface a(float Ka = HALF; output varying color tint = color (1, AMOUNT, 0);\n"
                 "          string maps[2] = {\"x\", \"\"}; point from = point \"shader\" (0, 0, 1)) { Ci = "
                 "twice(Ka); }\n");
    const Outcome right = run_program(folder, "shader a.sl -I more/yet -D AMOUNT=2 --params");
    EXPECT_EQ(right.exit_code, 0) << right.err;
    EXPECT_EQ(right.out,
              "surface a\n"
              "    uniform         float      Ka    = 0.5\n"
              "    output varying  color      tint  = color (1, 2, 0)\n"
              "    uniform         string[2]  maps  = {\"x\", \"\"}\n"
              "    uniform         point      from  = point \"shader\" (0, 0, 1)\n");
    EXPECT_NE(right.err.find("0 errors, 0 warnings"), std::string::npos) << right.err;

    // twice() has been written out, and Ci is a colour.
    const Outcome code = run_program(folder, "shader a.sl -I more/yet -D AMOUNT=2 --ir");
    EXPECT_NE(code.out.find("uniform float Ka = Move 0.5"), std::string::npos) << code.out;
    EXPECT_NE(code.out.find("= Multiply Ka, 2"), std::string::npos) << code.out;
    EXPECT_NE(code.out.find("varying color Ci = Move"), std::string::npos) << code.out;

    const Outcome wrong = run_program(folder, "shader a.sl");
    EXPECT_EQ(wrong.exit_code, 1);
    EXPECT_NE(
        wrong.err.find("a.sl:2:2: error: file \"twice.h\" is not found\n    #include <twice.h>\n     ^\n"),
        std::string::npos)
        << wrong.err;
    EXPECT_EQ(run_program(folder, "shader b.sl").exit_code, 3);
    EXPECT_EQ(run_program(folder, "shader").exit_code, 2);
}

TEST(CommandLine, HeadersAreFoundInFoldersBeside) {
    WorkFolder folder;
    for (const char* name : {"kinds", "kinds/own", "arman", "empty"})
        std::filesystem::create_directory(folder / name);
    folder.write("arman/lights.h", "float lights() { return 1; }");
    folder.write("kinds/own/sums.h", "float sum() { return lights() + 1; }");
    folder.write("kinds/a.sl",
                 "#include \"lights.h\"\n#include \"up/sums.h\"\nsurface a() { Ci = sum(); }\n");
    const Outcome found = run_program(folder, "shader kinds/a.sl");
    EXPECT_EQ(found.exit_code, 0) << found.err;
    EXPECT_NE(
        found.err.find("kinds/a.sl:1:2: warning: file \"lights.h\" is in none of the folders to search; "
                       "\"kinds/../arman/lights.h\" is read"),
        std::string::npos)
        << found.err;
    std::filesystem::remove(folder / "arman/lights.h");
    EXPECT_EQ(run_program(folder, "shader kinds/a.sl").exit_code, 1);
}

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
    folder.write("a.rib", std::string("MakeShadow \"nowhere.z\" \"a.shd\"\n") + kSphere);
    const Outcome outcome = run_program(folder, "render a.rib");
    EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
    EXPECT_NE(outcome.err.find("a.rib:1:1: error: cannot make \"a.shd\" from \"nowhere.z\""),
              std::string::npos)
        << outcome.err;
    EXPECT_TRUE(fs::exists(folder / "sphere.exr"));
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
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    for (const char* file : {"sphere.exr", "height.tif", "nosuch.exr"})
        EXPECT_TRUE(fs::exists(folder / file)) << file;
    const auto warned = [&](const std::string& text) {
        const size_t first = outcome.err.find(text);
        return first != std::string::npos && outcome.err.find(text, first + 1) == std::string::npos;
    };
    EXPECT_TRUE(
        warned("a.rib:6:1: warning: Display: no surface shader of the scene has a variable \"nosuch\""))
        << outcome.err;
    EXPECT_TRUE(warned("a.rib:7:1: warning: Imager: there is no shader \"lost\"")) << outcome.err;
    EXPECT_EQ(outcome.err.find("height"), std::string::npos) << outcome.err;
}

TEST(CommandLine, TheCommandMayBeLeftOutAsWithPrman) {
    WorkFolder folder;
    folder.write("a.rib", kSphere);
    const Outcome outcome = run_program(folder, "-t:1 -res 32 32 -Progress a.rib -o x.exr");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_NE(outcome.err.find("R90000"), std::string::npos) << outcome.err;
    EXPECT_TRUE(fs::exists(folder / "x.exr"));
    EXPECT_FALSE(fs::exists(folder / "sphere.exr"));
}

TEST(CommandLine, ReadsStandardInputAndSeveralFilesAsOne) {
    WorkFolder folder;
    const std::string scene = kSphere;
    const size_t half = scene.find("WorldBegin");
    folder.write("head.rib", scene.substr(0, half));
    folder.write("tail.rib", scene.substr(half));
    EXPECT_EQ(run_program(folder, "render head.rib tail.rib -o a.exr").exit_code, 0);
    folder.write("a.rib", scene);
    EXPECT_EQ(run_program(folder, "render -o b.exr - < a.rib").exit_code, 0);
    EXPECT_TRUE(fs::exists(folder / "b.exr"));
    EXPECT_EQ(run_program(folder, "render <(gzip -c a.rib) -o c.exr").exit_code, 0);
    EXPECT_TRUE(fs::exists(folder / "c.exr"));
}

TEST(CommandLine, StatisticsHaveThePromisedKeys) {
    WorkFolder folder;
    folder.write("a.rib", kSphere);
    ASSERT_EQ(run_program(folder, "render a.rib --stats s.json").exit_code, 0);
    const auto stats = nlohmann::json::parse(text_of(folder / "s.json"));
    for (const char* stage : {"read", "tessellate", "shade", "build", "trace", "composite", "total"})
        EXPECT_TRUE(stats["stages"][stage]["seconds"].is_number()) << stage;
    for (const char* key : {"grids", "micropolygons", "samples", "rays_per_second", "predicate_tests",
                            "predicate_hits", "nodes_visited", "threads", "simd_target", "sampler"})
        EXPECT_TRUE(stats.contains(key)) << key;
    for (const char* key : {"grids", "tree", "peak_rss"})
        EXPECT_GT(stats["bytes"][key].get<double>(), 0) << key;
    EXPECT_GT(stats["micropolygons"].get<int>(), 500);
    EXPECT_GT(stats["predicate_hits"].get<int>(), 1000);
}

TEST(CommandLine, ExitCodesSayWhatWentWrong) {
    WorkFolder folder;
    folder.write("a.rib", kSphere);
    folder.write("empty.rib", "# nothing\n");
    folder.write("wrong.rib", std::string("Sphare 1\n") + kSphere);
    folder.write("shader.rib",
                 std::string(kSphere).replace(std::string(kSphere).find("plastic"), 7, "gloop"));
    EXPECT_EQ(run_program(folder, "render").exit_code, 2);
    EXPECT_EQ(run_program(folder, "render a.rib --sampler none").exit_code, 2);
    EXPECT_EQ(run_program(folder, "render missing.rib").exit_code, 3);
    EXPECT_EQ(run_program(folder, "render empty.rib").exit_code, 4);
    EXPECT_EQ(run_program(folder, "render wrong.rib").exit_code, 1);
    EXPECT_EQ(run_program(folder, "render shader.rib").exit_code, 0);
    EXPECT_EQ(run_program(folder, "render shader.rib --strict").exit_code, 5);
    EXPECT_EQ(run_program(folder, "render a.rib -o no/such/folder/x.exr").exit_code, 6);
    EXPECT_EQ(run_program(folder, "check a.rib").exit_code, 0);
    EXPECT_EQ(run_program(folder, "check wrong.rib").exit_code, 1);
    EXPECT_EQ(run_program(folder, "--version").exit_code, 0);
    EXPECT_EQ(run_program(folder, "--help").exit_code, 0);
}

TEST(CommandLine, CheckListsWhatIsNotHonoured) {
    WorkFolder folder;
    folder.write("a.rib",
                 "Option \"limits\" \"int eyesplits\" [5] PixelVariance 0.01 WorldBegin "
                 "Attribute \"trace\" \"float bias\" [0.1] Attribute \"trace\" \"float bias\" [0.2] "
                 "Attribute \"user\" \"float x\" [1] Sphere 1 -1 1 360 WorldEnd");
    const Outcome outcome = run_program(folder, "check a.rib");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(outcome.out,
              "no effect Attribute \"trace\" \"bias\" 2\n"
              "no effect Option \"limits\" \"eyesplits\" 1\n"
              "no effect PixelVariance 1\n");
    EXPECT_EQ(run_program(folder, "check --strict a.rib").exit_code, 1);
}

TEST(CommandLine, RibOfTheCommandLineAndOfTheUserComesFirst) {
    WorkFolder folder;
    folder.write("a.rib", "Format 20 20 1 WorldBegin Sphere 1 -1 1 360 WorldEnd");
    fs::create_directories(folder / ".config" / "trapeze");
    folder.write(".config/trapeze/trapeze.rib", "PixelSamples 3 3 PixelFilter \"box\" 5 5 Format 7 7 1");
    const std::string option = "--option 'PixelSamples 6 6' --option 'Color 1 0' ";
    const Outcome outcome = run_program(folder, "info " + option + "a.rib");
    EXPECT_NE(outcome.out.find("20x20 pixels, 6x6 samples, filter box 5x5"), std::string::npos)
        << outcome.out;
    EXPECT_NE(outcome.err.find("<--option>:1:7: error: Color"), std::string::npos) << outcome.err;
}

TEST(CommandLine, ProgramsOfScenesRunWhereAllowed) {
    WorkFolder folder;
    folder.write("generate.sh", "while read request; do printf 'Sphere 1 -1 1 360\\n\\377'; done");
    folder.write("a.rib",
                 "WorldBegin Procedural \"RunProgram\" [\"sh generate.sh\" \"\"] [-1 1 -1 1 -1 1] WorldEnd");
    const Outcome refused = run_program(folder, "check a.rib");
    EXPECT_NE(refused.err.find("--allow-programs"), std::string::npos) << refused.err;
    const Outcome allowed = run_program(folder, "info --allow-programs a.rib");
    EXPECT_EQ(allowed.exit_code, 0) << allowed.err;
    EXPECT_NE(allowed.out.find("1 Sphere"), std::string::npos) << allowed.out;
}

TEST(CommandLine, TheInstructionSetCanBeLimited) {
    WorkFolder folder;
    folder.write("a.rib", kSphere);
    std::set<std::string> targets;
    int usable = 0;
    for (const char* name : {"sse4", "avx2", "avx512", "neon"}) {
        const Outcome outcome =
            run_program(folder, std::string("render a.rib --stats s.json --simd ") + name);
        if (outcome.exit_code != 0) {  // another kind of machine, or an older one
            EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
            EXPECT_NE(outcome.err.find(name), std::string::npos) << outcome.err;
            continue;
        }
        ++usable;
        targets.insert(nlohmann::json::parse(text_of(folder / "s.json"))["simd_target"].get<std::string>());
    }
    EXPECT_GT(usable, 0);
    EXPECT_EQ(targets.size(), static_cast<size_t>(usable)) << "the limit limits nothing";
    EXPECT_EQ(run_program(folder, "render a.rib --simd best").exit_code, 0);
    const Outcome wrong = run_program(folder, "render a.rib --simd avx9");
    EXPECT_EQ(wrong.exit_code, 2);
    EXPECT_NE(wrong.err.find("no instruction set"), std::string::npos) << wrong.err;
}

TEST(CommandLine, AMissingShaderIsSaidOnce) {
    WorkFolder folder;
    const std::string scene = kSphere;
    const size_t sphere = scene.find("Sphere");
    folder.write("a.rib", scene.substr(0, scene.find("Surface")) + "Surface \"gloop\"\n" +
                              scene.substr(sphere, 20) + "Surface \"gloop\"\n" + scene.substr(sphere));
    const Outcome outcome = run_program(folder, "render a.rib");
    const size_t first = outcome.err.find("warning");
    ASSERT_NE(first, std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("a.rib:"), std::string::npos);
    EXPECT_NE(outcome.err.find("gloop"), std::string::npos);
    EXPECT_EQ(outcome.err.find("warning", first + 1), std::string::npos) << outcome.err;
}

TEST(CommandLine, InterruptionLeavesNothingHalfWritten) {
    for (const auto& [signal, code] : {std::pair{"INT", 130}, {"TERM", 143}}) {
        WorkFolder folder;
        folder.write("slow.rib", kSlow);
        // `timeout` sends the signal and, with --preserve-status, passes on the program's own exit code.
        const std::string command = "cd '" + folder.path().string() + "' && timeout --preserve-status -s " +
                                    signal + " 1 '" TRAPEZE_PROGRAM "' render slow.rib >.stdout 2>.stderr";
        const auto start = std::chrono::steady_clock::now();
        const int status = std::system(command.c_str());
        const double seconds =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        EXPECT_EQ(WEXITSTATUS(status), code);
        EXPECT_EQ(files_in(folder), "slow.rib ");
        RecordProperty("seconds", std::to_string(seconds));
    }
}

TEST(CommandLine, MemoryBoundsWhatEveryCommandReads) {
    WorkFolder folder;
    folder.write("a.rib", std::string(3 << 20, ' ') + kSphere);
    for (const char* command : {"check", "info", "cat", "render -d null"}) {
        EXPECT_EQ(run_program(folder, std::string(command) + " a.rib").exit_code, 0) << command;
        const Outcome bounded = run_program(folder, std::string(command) + " --memory 1M a.rib");
        EXPECT_NE(bounded.exit_code, 0) << command;
        EXPECT_NE(bounded.err.find("limit of 1 MiB"), std::string::npos) << command << ": " << bounded.err;
    }
}

/// A program that sleeps through the end of its input writes its number before.
TEST(CommandLine, InterruptionEndsTheProgramsOfScenes) {
    WorkFolder folder;
    folder.write("hang.sh", "read request; echo $$ >pid; exec sleep 60");
    folder.write("a.rib",
                 "WorldBegin Procedural \"RunProgram\" [\"sh hang.sh\" \"\"] [-1 1 -1 1 -1 1] WorldEnd");
    for (const char* name : {"render", "check"}) {
        const std::string command = "cd '" + folder.path().string() +
                                    "' && timeout --preserve-status -s TERM 1 '" TRAPEZE_PROGRAM "' " + name +
                                    " --allow-programs a.rib >.stdout 2>.stderr";
        EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 143);
        const std::string pid = text_of(folder / "pid");
        ASSERT_FALSE(pid.empty());
        // Whoever inherits it may take a moment to notice its end.
        bool runs = true;
        for (int i = 0; i < 200 && runs; ++i) {
            const std::string state = text_of("/proc/" + pid.substr(0, pid.find('\n')) + "/stat");
            runs = !state.empty() && state.find(") Z ") == std::string::npos;
            if (runs) std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        EXPECT_FALSE(runs) << name;
    }
}

TEST(CommandLine, AnOutputThatCannotBeWrittenLeavesTheOldOneAlone) {
    WorkFolder folder;
    folder.write("a.rib", kSphere);
    fs::create_directory(folder / "sphere.exr");  // a folder in the output's place
    EXPECT_EQ(run_program(folder, "render a.rib").exit_code, 6);
    EXPECT_TRUE(fs::is_directory(folder / "sphere.exr"));
    const auto entries = std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator());
    EXPECT_EQ(entries, 4) << "a.rib, sphere.exr/, .stdout, .stderr; but: " << files_in(folder);
}

TEST(CommandLine, CompareShowsTheTableAndTheVerdictAndWritesTheFigures) {
    WorkFolder folder;
    folder.write("a.rib", kSphere);
    const Outcome outcome = run_program(folder,
                                        "compare a.rib --samplers 'raytrace;interval' --samples 1x1,2x2 "
                                        "--reference 4 --repeat 2 --json c.json --report r.html "
                                        "-o made/here");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("tests/sample"), std::string::npos) << outcome.out;
    EXPECT_NE(outcome.out.find("For this scene take "), std::string::npos) << outcome.out;
    const auto json = nlohmann::json::parse(text_of(folder / "c.json"));
    ASSERT_EQ(json["results"].size(), 4u);
    EXPECT_EQ(json["results"][3]["method"], "interval");
    EXPECT_EQ(json["results"][3]["build_seconds_by_round"].size(), 2u);
    EXPECT_EQ(json["results"][0]["ratio_to_baseline"], 1);
    EXPECT_GT(json["results"][0]["predicate_hits"].get<int>(), 100);
    EXPECT_GT(json["results"][0]["rmse"].get<double>(), 0);
    for (const char* file :
         {"reference_4x4.exr", "raytrace_1x1.exr", "interval_2x2.exr", "raytrace_2x2_tests.exr"})
        EXPECT_TRUE(fs::exists(folder / "made/here" / file)) << file;
    EXPECT_TRUE(text_of(folder / "r.html").ends_with("</html>\n"));
    EXPECT_FALSE(fs::exists(folder / "sphere.exr")) << "the scene's own Display is not written";
}

TEST(CommandLine, CompareTakesEveryMethodWhereTheSceneIsSmall) {
    WorkFolder folder;
    folder.write("a.rib", kSphere);
    const Outcome outcome =
        run_program(folder, "compare a.rib -r 24x16 --reference 2 --repeat 1 --samples 1");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    for (const char* method : {"raytrace", "bruteforce", "interval", "interleaveuvt"})
        EXPECT_NE(outcome.out.find(method), std::string::npos) << method;
}

TEST(CommandLine, CompareSaysWhatIsWrongBeforeItMeasures) {
    WorkFolder folder;
    folder.write("a.rib", kSphere);
    folder.write("empty.rib", "# nothing\n");
    folder.write("file", "");
    EXPECT_EQ(run_program(folder, "compare").exit_code, 2);
    EXPECT_EQ(run_program(folder, "compare a.rib --samplers magic").exit_code, 2);
    EXPECT_EQ(run_program(folder, "compare a.rib --samples 0x4").exit_code, 2);
    EXPECT_EQ(run_program(folder, "compare missing.rib").exit_code, 3);
    EXPECT_EQ(run_program(folder, "compare empty.rib").exit_code, 4);
    EXPECT_EQ(run_program(folder, "compare a.rib --json no/such/folder/c.json").exit_code, 6);
    EXPECT_EQ(run_program(folder, "compare a.rib --report no/such/folder/r.html").exit_code, 6);
    EXPECT_EQ(run_program(folder, "compare a.rib -o file").exit_code, 6);
    const Outcome memory = run_program(folder, "compare a.rib --memory 1K");
    EXPECT_EQ(memory.exit_code, 7);
    EXPECT_NE(memory.err.find("--memory"), std::string::npos) << memory.err;
    EXPECT_EQ(files_in(folder).find(".part"), std::string::npos);
}

TEST(CommandLine, CompareCanBeInterrupted) {
    WorkFolder folder;
    folder.write("slow.rib", kSlow);
    const std::string command = "cd '" + folder.path().string() +
                                "' && timeout --preserve-status -s INT 1 '" TRAPEZE_PROGRAM
                                "' compare slow.rib --json c.json --report r.html >.stdout 2>.stderr";
    EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 130);
    EXPECT_EQ(files_in(folder), "slow.rib ");
}

TEST(CommandLine, ScenesForMeasurementsAreWrittenToAFileOrAsText) {
    WorkFolder folder;
    const Outcome text = run_program(folder, "scene hair --scale .01 --motion 0 -r 64x36");
    EXPECT_EQ(text.exit_code, 0) << text.err;
    EXPECT_NE(text.out.find("Format 64 36 1"), std::string::npos);
    EXPECT_EQ(text.out.find("MotionBegin"), std::string::npos);
    EXPECT_EQ(run_program(folder, "scene hair --scale .01 --motion 0 -r 64x36 -o hair.rib").exit_code, 0);
    const Outcome info = run_program(folder, "check hair.rib --strict");
    EXPECT_EQ(info.exit_code, 0) << info.err;
    EXPECT_EQ(run_program(folder, "scene nothing").exit_code, 2);
    EXPECT_EQ(run_program(folder, "scene hair --scale 0").exit_code, 2);
    EXPECT_EQ(run_program(folder, "scene hair -o no/such/folder/hair.rib").exit_code, 6);
}

TEST(CommandLine, AStudySaysWhatHeldAndWritesItsFigures) {
    WorkFolder folder;
    const Outcome outcome = run_program(folder, "study fig9 --quick --report r.html --json r.json");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("checks held"), std::string::npos) << outcome.out;
    const auto json = nlohmann::json::parse(text_of(folder / "r.json"));
    EXPECT_GT(json["scenes"][0]["micropolygons"], 100000);
    EXPECT_EQ(json["checks"].size(), 3u);
    EXPECT_NE(text_of(folder / "r.html").find("<svg"), std::string::npos);
    EXPECT_EQ(run_program(folder, "study table3").exit_code, 2);
    EXPECT_EQ(run_program(folder, "study fig9 --quick --json no/such/folder/r.json").exit_code, 6);
    EXPECT_EQ(run_program(folder, "study fig9 --quick --memory 1K").exit_code, 7);
}

TEST(CommandLine, AStudyCanBeInterrupted) {
    WorkFolder folder;
    const std::string command = "cd '" + folder.path().string() +
                                "' && timeout --preserve-status -s INT 1 '" TRAPEZE_PROGRAM
                                "' study table1 --json c.json >.stdout 2>.stderr";
    EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 130);
    EXPECT_EQ(files_in(folder), "");
}

}  // namespace
}  // namespace trapeze::testing
