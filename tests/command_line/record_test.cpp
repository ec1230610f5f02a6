/// The program from outside: figures as tables, and comparisons that are repeated.
#include <nlohmann/json.hpp>
#include <set>

#include "core/files/sha256.h"
#include "pipeline/compare/record/csv_harness.h"
#include "tests/command_line/command_line_harness.h"

namespace trapeze::testing {
namespace {

using json = nlohmann::json;

json json_of(const WorkFolder& folder, const std::string& file) {
    return json::parse(file_text(folder / file));
}

/// A scene that reads an archive and a shader.
void write_scene(const WorkFolder& folder) {
    folder.write("a.rib", std::string(kSphereScene)
                              .replace(std::string(kSphereScene).find("Sphere"), 6,
                                       "Surface \"dot\"\nReadArchive \"part.rib\"\nSphere"));
    folder.write("part.rib", "TransformBegin\nTranslate 1 0 0\nSphere .5 -.5 .5 360\nTransformEnd\n");
    folder.write("dot.sl", "surface dot() { Ci = color(1, .5, 0); Oi = 1; }\n");
}

/// A cell has a value of the JSON.
void expect_cell(const std::string& cell, const json& value, const std::string& name) {
    if (value.is_number()) {
        EXPECT_EQ(std::stod(cell), value.get<double>()) << name;
    } else {
        EXPECT_EQ(cell, value.is_string() ? value.get<std::string>() : value.dump()) << name;
    }
}

/// Every number of the JSON's results is in the row of its method, rate and round.
TEST(CommandLineRecord, TheTableOfCompareHasTheNumbersOfTheJson) {
    WorkFolder folder;
    folder.write("a, \"b\".rib", kSphereScene);
    const Outcome outcome = run_program(folder,
                                        "compare 'a, \\\"b\\\".rib' --samplers 'raytrace;interval' --samples "
                                        "1x1,2x2 --reference 4 --repeat 3 --json c.json --csv c.csv");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const json results = json_of(folder, "c.json")["results"];
    const auto rows = csv_rows(file_text(folder / "c.csv"));
    ASSERT_EQ(rows.size(), results.size() * 3);
    for (size_t r = 0; r < rows.size(); ++r) {
        EXPECT_EQ(rows[r].at("scene"), "a, \"b\".rib");
        EXPECT_EQ(rows[r].at("round"), std::to_string(r % 3 + 1));
        size_t numbers = 0;
        for (const auto& [name, value] : results[r / 3].items()) {
            const json& one = value.is_array() ? value[r % 3] : value;
            numbers += one.is_number();
            expect_cell(rows[r].at(name), one, name);
        }
        EXPECT_GT(numbers, 25u);
    }
    EXPECT_EQ(run_program(folder, "compare a.rib --csv no/such/folder/c.csv").exit_code, 3);
}

TEST(CommandLineRecord, TheTableOfAStudyHasTheNumbersOfTheJson) {
    WorkFolder folder;
    const Outcome outcome = run_program(folder, "study fig9 --quick --csv r.csv --json r.json");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const json study = json_of(folder, "r.json");
    const json& figures = study["figures"];
    EXPECT_EQ(study["program"], "trapeze study");
    EXPECT_EQ(study["options"], (json{{"repeat", "3"}, {"quick", true}}));
    const auto rows = csv_rows(file_text(folder / "r.csv"));
    ASSERT_EQ(rows.size(), figures.size());
    ASSERT_GT(rows.size(), 10u);
    for (size_t r = 0; r < rows.size(); ++r) {
        EXPECT_EQ(rows[r].at("study"), "fig9");
        for (const auto& [name, value] : figures[r].items()) expect_cell(rows[r].at(name), value, name);
    }
    EXPECT_EQ(run_program(folder, "study fig9 --quick --csv no/such/folder/r.csv").exit_code, 6);
}

TEST(CommandLineRecord, OutputsOfOneNameAreRefused) {
    WorkFolder folder;
    folder.write("a.rib", kSphereScene);
    EXPECT_EQ(run_program(folder, "compare a.rib --json x --csv x").exit_code, 2);
    folder.write("there", "");
    EXPECT_EQ(run_program(folder, "compare a.rib --report there --csv ./there").exit_code, 2);
    EXPECT_EQ(run_program(folder, "compare a.rib --csv a.rib").exit_code, 2);
    EXPECT_EQ(run_program(folder, "study fig9 --json x --csv x").exit_code, 2);
    EXPECT_EQ(file_text(folder / "a.rib"), kSphereScene);
}

TEST(CommandLineRecord, TheJsonNamesWhatWasRead) {
    WorkFolder folder;
    write_scene(folder);
    ASSERT_EQ(run_program(folder,
                          "compare a.rib --reference 2 --repeat 1 --samplers raytrace --json c.json "
                          "--option 'PixelFilter \\\"box\\\" 1 1' --crop 0 1 .25 .75")
                  .exit_code,
              0);
    const std::string text = file_text(folder / "c.json");
    EXPECT_EQ(text.find(folder.path().string()), std::string::npos) << "a path of this machine";
    const json c = json::parse(text);
    std::set<std::string> names;
    for (const json& input : c["inputs"]) {
        const std::string name = input["name"], content = file_text(folder / name);
        names.insert(fs::path(name).lexically_normal().string());
        EXPECT_EQ(input["bytes"], content.size()) << name;
        EXPECT_EQ(input["sha256"], sha256(content)) << name;
    }
    EXPECT_EQ(names, (std::set<std::string>{"a.rib", "part.rib", "dot.sl"}));
    EXPECT_EQ(c["program"], "trapeze compare");
    EXPECT_EQ(c["scenes"], json::array({"a.rib"}));
    EXPECT_EQ(c["command"][1], "a.rib");
    EXPECT_EQ(c["options"]["samplers"], "raytrace");
    EXPECT_EQ(c["options"]["samples"], "2x2") << "the scene's";
    EXPECT_EQ(c["options"]["crop"], "0 1 0.25 0.75");
    EXPECT_EQ(c["options"]["option"], "PixelFilter \"box\" 1 1");
    EXPECT_FALSE(c["machine"]["cpu"].get<std::string>().empty());
    EXPECT_FALSE(c["machine"]["trapeze"].get<std::string>().empty());
}

/// The figures of a comparison do not depend on threads: all methods, adaptive samples, options.
TEST(CommandLineRecord, AReplayFindsEveryFigureAgain) {
    WorkFolder folder;
    write_scene(folder);
    ASSERT_EQ(run_program(folder,
                          "compare a.rib -t 1 --samples 1x1,8x8 --variance .001 --reference 4 --repeat 1 "
                          "--seed 5 --shading-rate 2 -r 40x30 --json c.json --option 'Shutter 0 1'")
                  .exit_code,
              0);
    const Outcome again =
        run_program(folder, "compare --replay c.json -t 7 --json again.json --csv again.csv");
    EXPECT_EQ(again.exit_code, 0) << again.err;
    EXPECT_EQ(again.err, "");
    EXPECT_NE(again.out.find("are as recorded"), std::string::npos) << again.out;
    const json then = json_of(folder, "c.json"), now = json_of(folder, "again.json");
    EXPECT_EQ(then["options"], now["options"]);
    EXPECT_EQ(then["inputs"], now["inputs"]);
    EXPECT_EQ(then["results"].size(), now["results"].size());
    EXPECT_EQ(then["options"]["simd"], now["options"]["simd"]);
    EXPECT_EQ(run_program(folder, "compare --replay again.json").exit_code, 0) << "a replay can be replayed";
}

TEST(CommandLineRecord, AReplayNamesFilesThatChangedAndFiguresThatDiffer) {
    WorkFolder folder;
    write_scene(folder);
    ASSERT_EQ(run_program(folder, "compare a.rib --reference 2 --repeat 1 --samplers raytrace --json c.json")
                  .exit_code,
              0);
    const std::string part = file_text(folder / "part.rib");
    folder.write("part.rib", part + "# a comment\n");
    const Outcome comment = run_program(folder, "compare --replay c.json");
    EXPECT_EQ(comment.exit_code, 1);
    EXPECT_NE(comment.err.find("part.rib\" has changed: its SHA-256 was " + sha256(part)), std::string::npos)
        << comment.err;
    EXPECT_EQ(comment.err.find("\"rmse\""), std::string::npos) << comment.err;
    folder.write("part.rib", "Sphere 1.5 -1.5 1.5 360\n");
    const Outcome larger = run_program(folder, "compare --replay c.json");
    EXPECT_EQ(larger.exit_code, 1);
    EXPECT_NE(larger.err.find("raytrace at 2x2: \"rmse\" was "), std::string::npos) << larger.err;
    folder.write("part.rib", part);
    EXPECT_EQ(run_program(folder, "compare --replay c.json").exit_code, 0);
    json planted = json_of(folder, "c.json");
    planted["results"][0]["predicate_tests"] = 1;
    folder.write("planted.json", planted.dump());
    const Outcome other = run_program(folder, "compare --replay planted.json");
    EXPECT_EQ(other.exit_code, 1);
    EXPECT_NE(other.err.find("raytrace at 2x2: \"predicate_tests\" was 1, is "), std::string::npos)
        << other.err;
    EXPECT_NE(other.out.find("1 are not as recorded"), std::string::npos) << other.out;
    fs::remove(folder / "dot.sl");
    const Outcome gone = run_program(folder, "compare --replay c.json");
    EXPECT_EQ(gone.exit_code, 1);
    EXPECT_NE(gone.err.find("dot.sl\" was read then, and is not read now"), std::string::npos) << gone.err;
}

/// What a file may not say: options that run or reach something, or values that no command line may have.
TEST(CommandLineRecord, FilesThatAreNoRecordsAreRefused) {
    WorkFolder folder;
    folder.write("a.rib", kSphereScene);
    ASSERT_EQ(run_program(folder,
                          "compare a.rib --reference 2 --repeat 1 --samplers raytrace --json c.json "
                          "--option 'Color 1 0 0'")
                  .exit_code,
              0);
    const std::string good = file_text(folder / "c.json");
    const auto replayed = [&](const std::string& text, const std::string& more = "") {
        folder.write("other.json", text);
        return run_program(folder, "compare --replay other.json " + more);
    };
    EXPECT_EQ(run_program(folder, "compare --replay missing.json").exit_code, 3);
    EXPECT_EQ(replayed("").exit_code, 3);
    EXPECT_EQ(replayed(good.substr(0, good.size() / 3)).exit_code, 3);
    EXPECT_EQ(replayed("{\"program\": \"trapeze study\"}").exit_code, 3);
    for (const auto& [option, value] :
         std::initializer_list<std::pair<std::string, json>>{{"allow-programs", true},
                                                             {"json", "stolen.json"},
                                                             {"plugin", "x.so"},
                                                             {"samplers", "magic"},
                                                             {"samples", "0x4"},
                                                             {"seed", "-1"},
                                                             {"crop", "1 0 0 1"},
                                                             {"crop", "0 1"},
                                                             {"repeat", "1e9"},
                                                             {"samplers", true},
                                                             {"simd", 7},
                                                             {"option", json::array()}}) {
        json broken = json::parse(good);
        broken["options"][option] = value;
        const Outcome outcome = replayed(broken.dump());
        EXPECT_EQ(outcome.exit_code, 3) << option;
        EXPECT_NE(outcome.err.find("cannot replay \"other.json\""), std::string::npos) << outcome.err;
    }
    json other = json::parse(good);
    other["scenes"] = {"-"};
    EXPECT_EQ(replayed(other.dump()).exit_code, 3);
    other["scenes"] = {"gone.rib"};
    EXPECT_EQ(replayed(other.dump()).exit_code, 3);
    EXPECT_NE(replayed(good, "--safe").err.find("--safe"), std::string::npos);
    EXPECT_EQ(replayed(good, "a.rib").exit_code, 2);
    EXPECT_EQ(replayed(good, "--seed 3").exit_code, 2);
    EXPECT_EQ(replayed(good, "--samplers interval").exit_code, 2);
    EXPECT_EQ(replayed(good, "--json other.json").exit_code, 2) << "it would be written over";
    EXPECT_EQ(replayed(good).exit_code, 0);
    EXPECT_EQ(files_in(folder).find("stolen"), std::string::npos);
}

}  // namespace
}  // namespace trapeze::testing
