/// The program from outside: compare, study and the scenes that they measure.
#include <nlohmann/json.hpp>

#include "tests/command_line/command_line_harness.h"

namespace trapeze::testing {
namespace {

TEST(CommandLine, CompareShowsTheTableAndTheVerdictAndWritesTheFigures) {
    WorkFolder folder;
    folder.write("a.rib", kSphereScene);
    const Outcome outcome = run_program(folder,
                                        "compare a.rib --samplers 'raytrace;interval' --samples 1x1,2x2 "
                                        "--reference 4 --repeat 2 --json c.json --report r.html "
                                        "-o made/here");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("tests/sample"), std::string::npos) << outcome.out;
    EXPECT_NE(outcome.out.find("For this scene take "), std::string::npos) << outcome.out;
    const auto json = nlohmann::json::parse(file_text(folder / "c.json"));
    ASSERT_EQ(json["results"].size(), 4u);
    EXPECT_EQ(json["results"][3]["method"], "interval");
    EXPECT_EQ(json["results"][3]["build_seconds_by_round"].size(), 2u);
    EXPECT_EQ(json["results"][0]["ratio_to_baseline"], 1);
    EXPECT_GT(json["results"][0]["predicate_hits"].get<int>(), 100);
    EXPECT_GT(json["results"][0]["rmse"].get<double>(), 0);
    for (const char* file :
         {"reference_4x4.exr", "raytrace_1x1.exr", "interval_2x2.exr", "raytrace_2x2_tests.exr"})
        EXPECT_TRUE(fs::exists(folder / "made/here" / file)) << file;
    EXPECT_TRUE(file_text(folder / "r.html").ends_with("</html>\n"));
    EXPECT_FALSE(fs::exists(folder / "sphere.exr")) << "the scene's own Display is not written";
}

TEST(CommandLine, CompareTakesEveryMethodWhereTheSceneIsSmall) {
    WorkFolder folder;
    folder.write("a.rib", kSphereScene);
    const Outcome outcome =
        run_program(folder, "compare a.rib -r 24x16 --reference 2 --repeat 1 --samples 1");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    for (const char* method : {"raytrace", "bruteforce", "interval", "interleaveuvt"})
        EXPECT_NE(outcome.out.find(method), std::string::npos) << method;
}

TEST(CommandLine, CompareSaysWhatIsWrongBeforeItMeasures) {
    WorkFolder folder;
    folder.write("a.rib", kSphereScene);
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
    const auto json = nlohmann::json::parse(file_text(folder / "r.json"));
    EXPECT_GT(json["scenes"][0]["micropolygons"], 100000);
    EXPECT_EQ(json["checks"].size(), 3u);
    EXPECT_NE(file_text(folder / "r.html").find("<svg"), std::string::npos);
    EXPECT_EQ(run_program(folder, "study table6").exit_code, 2);
    EXPECT_EQ(run_program(folder, "study fig9 --quick --json no/such/folder/r.json").exit_code, 6);
    EXPECT_EQ(run_program(folder, "study fig9 --quick --memory 1K").exit_code, 7);
}

}  // namespace
}  // namespace trapeze::testing
