/// The files of jobs; tests/farm/run gives them to schedulers.
#include <nlohmann/json.hpp>

#include "core/shell_word.h"
#include "tests/command_line/command_line_harness.h"

namespace trapeze::testing {
namespace {

constexpr const char* kFilm = R"(Format 48 32 1 PixelSamples 2 2 Projection "perspective" "fov" [40]
FrameBegin 3 Translate 0 0 5 WorldBegin Sphere 1 -1 1 360 WorldEnd FrameEnd
FrameBegin 4 Translate .3 0 5 WorldBegin Sphere 1 -1 1 360 WorldEnd FrameEnd
)";

/// Runs a job's script as whoever is in the folder does.
int run_script(const WorkFolder& folder, const std::string& words) {
    const std::string command = "cd '" + folder.path().string() + "' && TRAPEZE='" TRAPEZE_PROGRAM "' bash " +
                                words + " >.stdout 2>.stderr";
    return WEXITSTATUS(std::system(command.c_str()));
}

TEST(Farm, ScriptsRenderTilesAndJoinThem) {
    WorkFolder folder;
    const SetVariable date("SOURCE_DATE_EPOCH", "1");
    folder.write("it's a film.rib", kFilm);
    const Outcome made =
        run_program(folder,
                    "farm \\\"it's a film.rib\\\" -f 3-4 --tiles 2x1 --for parallel -o 'a b' "
                    "--with '--seed 4'");
    ASSERT_EQ(made.exit_code, 0) << made.err;
    EXPECT_EQ(file_text(folder / "a b/render.jobs"),
              "bash 'a b'/render 3 1\nbash 'a b'/render 3 2\nbash 'a b'/render 4 1\nbash 'a b'/render 4 2\n");
    EXPECT_EQ(file_text(folder / "a b/merge.jobs"), "bash 'a b'/merge 3\nbash 'a b'/merge 4\n");
    for (const char* words : {"3 1", "3 2", "4 2", "4 1"})
        ASSERT_EQ(run_script(folder, std::string("'a b/render' ") + words), 0)
            << file_text(folder / ".stderr");
    for (const char* frame : {"3", "4"}) {
        ASSERT_EQ(run_script(folder, std::string("'a b/merge' ") + frame), 0)
            << file_text(folder / ".stderr");
        ASSERT_EQ(run_program(folder,
                              std::string("render \\\"it's a film.rib\\\" --seed 4 -o whole.exr -f ") + frame)
                      .exit_code,
                  0);
        const std::string joined = file_text(folder / (std::string("a b/it's a film.000") + frame + ".exr"));
        EXPECT_FALSE(joined.empty());
        EXPECT_TRUE(joined == file_text(folder / "whole.exr"));
    }
    // Those that are missing are named.
    fs::remove(folder / "a b/tiles/it's a film.0004.tile2.exr");
    fs::remove(folder / "a b/it's a film.0004.exr");
    EXPECT_EQ(run_script(folder, "'a b/merge' 4"), 4);
    EXPECT_NE(file_text(folder / ".stderr").find("2 of 2x1"), std::string::npos)
        << file_text(folder / ".stderr");
    EXPECT_FALSE(fs::exists(folder / "a b/it's a film.0004.exr"));
}

TEST(Farm, SlurmScriptsAreRightForTheShell) {
    WorkFolder folder;
    folder.write("a.rib", kFilm);
    ASSERT_EQ(run_program(folder, "farm a.rib -f 3-4,9 --tiles 3x2 --for slurm --retries 5").exit_code, 0);
    for (const char* script : {"submit", "task", "render", "merge"})
        EXPECT_EQ(run_script(folder, std::string("-n a.farm/") + script), 0) << file_text(folder / ".stderr");
    const std::string task = file_text(folder / "a.farm/task"), submit = file_text(folder / "a.farm/submit");
    EXPECT_NE(task.find("#SBATCH --signal=B:TERM@120\n"), std::string::npos);
    EXPECT_NE(task.find("frames=(3 4 9)\n"), std::string::npos);
    EXPECT_NE(submit.find("tasks=18\n"), std::string::npos);
    EXPECT_NE(submit.find("--dependency=afterany:"), std::string::npos);
    // Without tiles there is nothing to join.
    ASSERT_EQ(run_program(folder, "farm a.rib -f 3-4 --for slurm -o whole").exit_code, 0);
    EXPECT_FALSE(fs::exists(folder / "whole/merge"));
    EXPECT_EQ(file_text(folder / "whole/submit").find("afterany"), std::string::npos);
}

TEST(Farm, TheTemplateIsOfOpenJobDescription) {
    WorkFolder folder;
    folder.write("a.rib", kFilm);
    ASSERT_EQ(run_program(folder, "farm a.rib -f 1-3,7,9-10 --tiles 2x2 --for openjd").exit_code, 0);
    const auto whole = nlohmann::json::parse(file_text(folder / "a.farm/template.json"));
    EXPECT_EQ(whole.at("specificationVersion"), "jobtemplate-2023-09");
    EXPECT_EQ(whole.at("parameterDefinitions")[0].at("default"), fs::canonical(folder.path()).string());
    const auto& steps = whole.at("steps");
    ASSERT_EQ(steps.size(), 2u);
    const auto& space = steps[0].at("parameterSpace").at("taskParameterDefinitions");
    EXPECT_EQ(space[0].at("range"), "1-3,7,9-10");
    EXPECT_EQ(space[1].at("range"), "1-4");
    EXPECT_EQ(steps[1].at("dependencies")[0].at("dependsOn"), "Render");
    // The command of a task, as a host runs it.
    std::string words;
    const auto& run = steps[0].at("script").at("actions").at("onRun");
    for (const auto& argument : run.at("args")) {
        std::string word = argument;
        if (word == "{{Param.Folder}}") word = folder.path().string();
        if (word == "{{Task.Param.Frame}}") word = "3";
        if (word == "{{Task.Param.Tile}}") word = "2";
        words += " " + shell_word(word);
    }
    EXPECT_EQ(run.at("command"), "bash");
    EXPECT_EQ(run_script(folder, words), 0) << file_text(folder / ".stderr");
    EXPECT_TRUE(fs::exists(folder / "a.farm/tiles/a.0003.tile2.exr"));
}

TEST(Farm, WhatIsWrongIsSaid) {
    WorkFolder folder;
    folder.write("a.rib", kFilm);
    EXPECT_EQ(run_program(folder, "farm a.rib --for slurm").exit_code, 2);
    EXPECT_EQ(run_program(folder, "farm a.rib -f 1").exit_code, 2);
    EXPECT_EQ(run_program(folder, "farm a.rib -f 1 --for deadline").exit_code, 2);
    EXPECT_EQ(run_program(folder, "farm a.rib -f 1-2000000000 --for slurm").exit_code, 2);
    EXPECT_EQ(run_program(folder, "farm none.rib -f 1 --for slurm").exit_code, 3);
    EXPECT_EQ(run_program(folder, "farm a.rib -f 1 --for slurm -o a.rib").exit_code, 6);
    fs::create_directory(folder / "a.farm");
    folder.write("a.farm/render", "mine");
    const Outcome other = run_program(folder, "farm a.rib -f 1 --for slurm");
    EXPECT_EQ(other.exit_code, 6);
    EXPECT_NE(other.err.find("what is there is no job's file"), std::string::npos) << other.err;
    EXPECT_EQ(file_text(folder / "a.farm/render"), "mine");
}

}  // namespace
}  // namespace trapeze::testing
