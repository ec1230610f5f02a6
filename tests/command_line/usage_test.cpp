/// The program from outside: what it says of command lines, on which stream, and where it cannot be said.
#include <nlohmann/json.hpp>

#include "tests/command_line/command_line_harness.h"

namespace trapeze::testing {
namespace {

using json = nlohmann::json;

constexpr const char* kCommands[] = {"render", "check", "info",   "cat",       "compare",
                                     "scene",  "study", "shader", "compliance"};

/// Every line of a text, as JSON.
std::vector<json> lines_of(const std::string& text) {
    std::vector<json> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) {
        lines.push_back(json::parse(line, nullptr, false));
        EXPECT_TRUE(lines.back().is_object()) << line;
    }
    return lines;
}

TEST(CommandLine, ProgressAsJsonIsAnObjectALine) {
    WorkFolder folder;
    folder.write("a.rib", std::string("FrameBegin 7\nSphare 1\nSphare 1\n") + kSphereScene + "FrameEnd\n");
    const Outcome outcome = run_program(folder, "render a.rib --progress json");
    EXPECT_EQ(outcome.exit_code, 1);
    bool finished = false, traced = false, complained = false;
    for (const json& line : lines_of(outcome.err)) {
        if (line.contains("severity")) {
            for (const char* key : {"file", "line", "column", "message"})
                EXPECT_TRUE(line.contains(key)) << line;
            complained = complained || (line["severity"] == "error" && line["file"] == "a.rib" &&
                                        line["line"] == 2 && line["column"] == 1);
            continue;
        }
        for (const char* key : {"frame", "file", "stage", "fraction", "seconds", "estimate"})
            EXPECT_TRUE(line.contains(key)) << line;
        traced = traced || (line["stage"] == "trace" && line["frame"] == 7 && line["file"] == "sphere.exr");
        finished = finished || line["fraction"] == 1;
    }
    EXPECT_TRUE(finished && traced && complained) << outcome.err;
    const Outcome wrong = run_program(folder, "render a.rib --progress json --samples many");
    EXPECT_EQ(wrong.exit_code, 2);
    ASSERT_EQ(lines_of(wrong.err).size(), 1u);
    EXPECT_EQ(lines_of(wrong.err)[0]["severity"], "error");
}

TEST(CommandLine, StatisticsSayWhatWasReadAndWritten) {
    WorkFolder folder;
    folder.write("ball.rib", "Sphere 1 -1 1 360\nSphare 1\n");
    folder.write("a.rib",
                 "Format 32 32 1 Display \"a.exr\" \"file\" \"rgba\" Display \"+b.tif\" \"tiff\" \"rgb\"\n"
                 "Translate 0 0 5 WorldBegin ReadArchive \"ball.rib\" WorldEnd\n");
    ASSERT_EQ(run_program(folder, "render a.rib --stats s.json").exit_code, 1);
    const json stats = json::parse(file_text(folder / "s.json"));
    EXPECT_EQ(stats["command"], json::array({"render", "a.rib", "--stats", "s.json"}));
    EXPECT_FALSE(stats["version"].get<std::string>().empty());
    EXPECT_FALSE(stats["revision"].get<std::string>().empty());
    EXPECT_EQ(stats["scene_files"], json::array({"a.rib", "ball.rib"}));
    EXPECT_EQ(stats["messages"]["errors"], 1);
    EXPECT_EQ(stats["messages"]["warnings"], 0);
    ASSERT_EQ(stats["outputs"].size(), 2u);
    EXPECT_EQ(stats["outputs"][1]["path"], "b.tif");
    EXPECT_EQ(stats["outputs"][1]["bytes"], fs::file_size(folder / "b.tif"));
    EXPECT_GT(stats["outputs"][1]["seconds"], 0);
}

TEST(CommandLine, HelpIsHadInEveryWay) {
    WorkFolder folder;
    const std::string whole = run_program(folder, "--help").out;
    EXPECT_EQ(run_program(folder, "help").out, whole);
    for (const std::string command : kCommands) {
        const Outcome help = run_program(folder, "help " + command);
        EXPECT_EQ(help.exit_code, 0) << help.err;
        EXPECT_EQ(help.out, run_program(folder, command + " --help").out);
        EXPECT_NE(help.out.find("trapeze " + command), std::string::npos) << help.out;
        EXPECT_NE(whole.find("\n  " + command), std::string::npos) << command;
    }
    const Outcome unknown = run_program(folder, "help rendr");
    EXPECT_EQ(unknown.exit_code, 2);
    EXPECT_NE(unknown.err.find("\"rendr\""), std::string::npos) << unknown.err;
}

TEST(CommandLine, WhatCannotBePrintedIsAnError) {
    WorkFolder folder;
    folder.write("a.rib", std::string("Option \"limits\" \"int eyesplits\" [5]\n") + kSphereScene);
    folder.write("a.sl", "surface a() { Ci = 1; }\n");
    const std::string scenes = " --scenes '" TRAPEZE_SOURCE_DIR "/scenes'";
    for (const std::string& command :
         {std::string("info a.rib"), std::string("check a.rib"), std::string("cat a.rib"),
          std::string("shader a.sl"), std::string("scene halberd"), "compliance" + scenes,
          std::string("compare a.rib -r 8x8 --samples 1 --reference 1 --repeat 1 --samplers raytrace"),
          std::string("--help"), std::string("help info"), std::string("--version")}) {
        const Outcome full = run_program(folder, command + " >/dev/full");
        EXPECT_EQ(full.exit_code, 6) << command;
        EXPECT_NE(full.err.find("cannot write to standard output: No space left"), std::string::npos)
            << command << ": " << full.err;
    }
    EXPECT_EQ(run_program(folder, "info a.rib >&-").exit_code, 6);
    EXPECT_EQ(run_program(folder, "scene halberd > >(true)").exit_code, 6) << "nobody reads";
    EXPECT_EQ(run_program(folder, "render a.rib >&- 2>&-").exit_code, 0) << "all that matters is the picture";
    EXPECT_TRUE(fs::exists(folder / "sphere.exr"));
}

TEST(CommandLine, FramesThatAreNotThereAreSaid) {
    WorkFolder folder;
    folder.write("a.rib", kSphereScene);
    const Outcome outcome = run_program(folder, "render a.rib -f 5");
    EXPECT_EQ(outcome.exit_code, 4);
    EXPECT_NE(outcome.err.find("none of the frames asked for"), std::string::npos) << outcome.err;
}

TEST(CommandLine, InputsThatCannotBeReadAreSaid) {
    WorkFolder folder;
    fs::create_directory(folder / "here");
    for (const std::string command : {"render", "check", "info", "cat", "compare", "shader"}) {
        EXPECT_NE(run_program(folder, command + " here").err.find("\"here\" is a folder"), std::string::npos);
        const Outcome missing = run_program(folder, command + " none");
        EXPECT_EQ(missing.exit_code, 3) << command;
        EXPECT_NE(missing.err.find("no such file: \"none\""), std::string::npos) << missing.err;
    }
}

TEST(CommandLine, InputsAreNotWrittenOver) {
    WorkFolder folder;
    folder.write("a.rib", kSphereScene);
    fs::create_symlink("a.rib", folder / "same.rib");
    for (const char* wrong : {"-o a.rib", "-o ./a.rib", "-o same.rib", "--stats a.rib", "-o s --stats s"}) {
        EXPECT_EQ(run_program(folder, std::string("render a.rib ") + wrong).exit_code, 2) << wrong;
        EXPECT_EQ(file_text(folder / "a.rib"), kSphereScene) << wrong;
    }
    EXPECT_EQ(run_program(folder, "cat a.rib -o a.rib").exit_code, 0) << "which has been read by then";
    EXPECT_NE(file_text(folder / "a.rib").find("Sphere"), std::string::npos);
}

TEST(CommandLine, OutputsThatCannotBeWrittenAreSaidAtOnce) {
    WorkFolder folder;
    folder.write("a.rib", kSphereScene);
    fs::create_directory(folder / "here");
    for (const char* wrong : {"-o here", "-o here/", "-o none/a.exr", "--stats here", "--stats none/s.json",
                              "-o /dev/full", "-o a.rib/x.exr"}) {
        const Outcome outcome = run_program(folder, std::string("render a.rib ") + wrong);
        EXPECT_EQ(outcome.exit_code, 6) << wrong << outcome.err;
        EXPECT_NE(outcome.err.find("cannot write \""), std::string::npos) << wrong << outcome.err;
    }
    EXPECT_EQ(files_in(folder).find("exr"), std::string::npos) << files_in(folder);
}

TEST(CommandLine, APictureThatNoMachineHoldsIsRefused) {
    WorkFolder folder;
    folder.write("a.rib", std::string("Display \"+x.exr\" \"exr\" \"color Cs\"\n") + kSphereScene);
    const Outcome outcome = run_program(folder, "render a.rib -r 65536x65536 -d null");
    EXPECT_EQ(outcome.exit_code, 7) << outcome.err;
    EXPECT_NE(outcome.err.find("machine's memory"), std::string::npos) << outcome.err;
    EXPECT_EQ(run_program(folder, "render a.rib -r 65536x65536 --crop 0 .001 0 .001 -d null").exit_code, 0);
}

TEST(CommandLine, NamesMayHaveSpacesAndAnyLetters) {
    WorkFolder folder;
    folder.write("my \u00e4 sc\u00e8ne.rib", kSphereScene);
    EXPECT_EQ(
        run_program(folder, "render 'my \u00e4 sc\u00e8ne.rib' -o 'x \u6f22.exr' --stats '\u00e9 s.json'")
            .exit_code,
        0);
    EXPECT_TRUE(fs::exists(folder / "x \u6f22.exr"));
    EXPECT_EQ(json::parse(file_text(folder / "\u00e9 s.json"))["outputs"][0]["path"], "x \u6f22.exr");
    folder.write("\xff.rib", kSphereScene);  // not UTF-8
    EXPECT_EQ(run_program(folder, "render \xff.rib --stats s.json --progress json").exit_code, 0);
    EXPECT_TRUE(json::accept(file_text(folder / "s.json")));
}

}  // namespace
}  // namespace trapeze::testing
