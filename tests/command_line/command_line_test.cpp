/// The program from outside: exit codes, messages, outputs that appear whole or not at all.
#include <nlohmann/json.hpp>
#include <set>

#include "tests/command_line/command_line_harness.h"

namespace trapeze::testing {
namespace {

TEST(CommandLine, RendersASceneAndWritesItsDisplay) {
    WorkFolder folder;
    folder.write("a.rib", kSphereScene);
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

TEST(CommandLine, TheCommandMayBeLeftOutAsWithPrman) {
    WorkFolder folder;
    folder.write("a.rib", kSphereScene);
    const Outcome outcome = run_program(folder, "-t:1 -res 32 32 -Progress a.rib -o x.exr");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_NE(outcome.err.find("R90000"), std::string::npos) << outcome.err;
    EXPECT_TRUE(fs::exists(folder / "x.exr"));
    EXPECT_FALSE(fs::exists(folder / "sphere.exr"));
}

TEST(CommandLine, ReadsStandardInputAndSeveralFilesAsOne) {
    WorkFolder folder;
    const std::string scene = kSphereScene;
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
    folder.write("a.rib", kSphereScene);
    ASSERT_EQ(run_program(folder, "render a.rib --stats s.json").exit_code, 0);
    const auto stats = nlohmann::json::parse(file_text(folder / "s.json"));
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
    folder.write("a.rib", kSphereScene);
    folder.write("empty.rib", "# nothing\n");
    folder.write("wrong.rib", std::string("Sphare 1\n") + kSphereScene);
    folder.write("shader.rib",
                 std::string(kSphereScene).replace(std::string(kSphereScene).find("plastic"), 7, "gloop"));
    EXPECT_EQ(run_program(folder, "render").exit_code, 2);
    EXPECT_EQ(run_program(folder, "render a.rib --sampler none").exit_code, 2);
    EXPECT_EQ(run_program(folder, "render missing.rib").exit_code, 3);
    EXPECT_EQ(run_program(folder, "render empty.rib").exit_code, 4);
    EXPECT_EQ(run_program(folder, "render wrong.rib").exit_code, 1);
    EXPECT_EQ(run_program(folder, "render shader.rib").exit_code, 1);
    EXPECT_EQ(run_program(folder, "check shader.rib").exit_code, 1);
    EXPECT_EQ(run_program(folder, "render shader.rib --strict").exit_code, 5);
    EXPECT_EQ(run_program(folder, "check shader.rib --strict").exit_code, 5);
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
                 "Attribute \"trace\" \"float decimation\" [1] Attribute \"trace\" \"float decimation\" [2] "
                 "Attribute \"user\" \"float x\" [1] Sphere 1 -1 1 360 WorldEnd");
    const Outcome outcome = run_program(folder, "check a.rib");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(outcome.out,
              "no effect Attribute \"trace\" \"decimation\" 2\n"
              "no effect Option \"limits\" \"eyesplits\" 1\n"
              "no effect PixelVariance 1\n");
    EXPECT_EQ(run_program(folder, "check --strict a.rib").exit_code, 1);
}

/// What would be said of pictures while they are rendered.
TEST(CommandLine, CheckLooksAtDisplays) {
    WorkFolder folder;
    folder.write(
        "a.rib",
        "Display \"a.exr\" \"exr\" \"foo\" Display \"+b.exr\" \"exr\" \"rgba\" \"string compression\" \"none of it\" "
        "WorldBegin Sphere 1 -1 1 360 WorldEnd");
    const Outcome outcome = run_program(folder, "check a.rib");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_NE(outcome.err.find("\"foo\""), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("\"none of it\""), std::string::npos) << outcome.err;
    EXPECT_EQ(run_program(folder, "check --strict a.rib").exit_code, 1);
    EXPECT_FALSE(fs::exists(folder / "a.exr"));
    EXPECT_FALSE(fs::exists(folder / "b.exr"));
}

/// Archives that stand in the file itself are kept where archives are, and put in their places otherwise.
TEST(CommandLine, CatKeepsArchivesOfTheFileItself) {
    WorkFolder folder;
    folder.write(
        "a.rib",
        "ArchiveBegin \"outer\" Sphere 2 -2 2 360 ArchiveBegin \"inner\" Sphere 1 -1 1 360 ArchiveEnd "
        "ReadArchive \"inner\" ArchiveEnd WorldBegin ReadArchive \"outer\" WorldEnd");
    EXPECT_EQ(
        run_program(folder, "cat --keep-archives a.rib").out,
        "##RenderMan RIB-Structure 1.1\nArchiveBegin \"outer\"\n  Sphere 2 -2 2 360\n  ArchiveBegin \"inner\"\n"
        "    Sphere 1 -1 1 360\n  ArchiveEnd\n  ReadArchive \"inner\"\nArchiveEnd\nWorldBegin\n"
        "  ReadArchive \"outer\"\nWorldEnd\n");
    EXPECT_EQ(
        run_program(folder, "cat a.rib").out,
        "##RenderMan RIB-Structure 1.1\nWorldBegin\n  Sphere 2 -2 2 360\n  Sphere 1 -1 1 360\nWorldEnd\n");
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
    folder.write("a.rib", kSphereScene);
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
        targets.insert(nlohmann::json::parse(file_text(folder / "s.json"))["simd_target"].get<std::string>());
    }
    EXPECT_GT(usable, 0);
#if !defined(HWY_COMPILE_ONLY_STATIC)  // else one instruction set alone is compiled in
    EXPECT_EQ(targets.size(), static_cast<size_t>(usable)) << "the limit limits nothing";
#endif
    EXPECT_EQ(run_program(folder, "render a.rib --simd best").exit_code, 0);
    const Outcome wrong = run_program(folder, "render a.rib --simd avx9");
    EXPECT_EQ(wrong.exit_code, 2);
    EXPECT_NE(wrong.err.find("no instruction set"), std::string::npos) << wrong.err;
}

TEST(CommandLine, AMissingShaderIsSaidOnce) {
    WorkFolder folder;
    const std::string scene = kSphereScene;
    const size_t sphere = scene.find("Sphere");
    folder.write("a.rib", scene.substr(0, scene.find("Surface")) + "Surface \"gloop\"\n" +
                              scene.substr(sphere, 18) + "Surface \"gloop\"\n" + scene.substr(sphere));
    const Outcome outcome = run_program(folder, "render a.rib");
    const size_t first = outcome.err.find("error");
    ASSERT_NE(first, std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("a.rib:"), std::string::npos);
    EXPECT_NE(outcome.err.find("gloop"), std::string::npos);
    EXPECT_EQ(outcome.err.find("error", first + 1), std::string::npos) << outcome.err;
}

TEST(CommandLine, MemoryBoundsWhatEveryCommandReads) {
    WorkFolder folder;
    folder.write("a.rib", std::string(3 << 20, ' ') + kSphereScene);
    for (const char* command : {"check", "info", "cat", "render -d null"}) {
        EXPECT_EQ(run_program(folder, std::string(command) + " a.rib").exit_code, 0) << command;
        const Outcome bounded = run_program(folder, std::string(command) + " --memory 1M a.rib");
        EXPECT_NE(bounded.exit_code, 0) << command;
        EXPECT_NE(bounded.err.find("limit of 1 MiB"), std::string::npos) << command << ": " << bounded.err;
    }
}

TEST(CommandLine, AnOutputThatCannotBeWrittenLeavesTheOldOneAlone) {
    WorkFolder folder;
    folder.write("a.rib", kSphereScene);
    fs::create_directory(folder / "sphere.exr");  // a folder in the output's place
    EXPECT_EQ(run_program(folder, "render a.rib").exit_code, 6);
    EXPECT_TRUE(fs::is_directory(folder / "sphere.exr"));
    const auto entries = std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator());
    EXPECT_EQ(entries, 4) << "a.rib, sphere.exr/, .stdout, .stderr; but: " << files_in(folder);
}

}  // namespace
}  // namespace trapeze::testing
