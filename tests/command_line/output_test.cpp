/// The program from outside: names of pictures, what is said of them, displays that cannot be honoured.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/command_line/command_line_harness.h"

namespace trapeze::testing {
namespace {

/// A frame or world of one pixel's worth of work.
std::string world(const std::string& before, bool is_empty = false) {
    return before + "\nFormat 8 8 1 PixelSamples 1 1 WorldBegin\n" +
           (is_empty ? "" : "Translate 0 0 2 Sphere 1 -1 1 360\n") + "WorldEnd\n";
}
std::string frame(int number, const std::string& display, bool is_empty = false) {
    return "FrameBegin " + std::to_string(number) + "\n" + world(display, is_empty) + "FrameEnd\n";
}
constexpr const char* kShot = "Display \"shot.exr\" \"openexr\" \"rgba\"";

/// The pictures of a run, in order.
std::vector<std::string> pictures(const WorkFolder& folder) {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder.path()))
        if (const std::string extension = entry.path().extension();
            extension == ".exr" || extension == ".png")
            names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
}

using Names = std::vector<std::string>;

/// What a command that succeeds says on a terminal.
std::string said_on_a_terminal(const WorkFolder& folder, const std::string& arguments) {
    const std::string in_terminal = "cd '" + folder.path().string() +
                                    "' && script -qec \"'" TRAPEZE_PROGRAM "' " + arguments +
                                    "\" said >/dev/null 2>&1 </dev/null";
    EXPECT_EQ(std::system(in_terminal.c_str()), 0) << "script of util-linux is needed";
    return file_text(folder / "said");
}

TEST(OutputFiles, HaveTheFramesNumber) {
    WorkFolder folder;
    folder.write("a.rib", frame(3, kShot) + frame(12, kShot));
    const std::pair<const char*, Names> cases[] = {{"fo.####.exr", {"fo.0003.exr", "fo.0012.exr"}},
                                                   {"fp.%04d.exr", {"fp.0003.exr", "fp.0012.exr"}},
                                                   {"fq.<frame>.exr", {"fq.12.exr", "fq.3.exr"}}};
    for (const auto& [name, files] : cases) {
        const Outcome outcome = run_program(folder, std::string("render a.rib -o '") + name + "'");
        ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
        EXPECT_EQ(pictures(folder), files) << name;
        for (const std::string& file : pictures(folder)) fs::remove(folder / file);
    }
}

TEST(OutputFiles, OfEarlierFramesAreKept) {
    WorkFolder folder;
    folder.write("a.rib", frame(3, kShot) + frame(4, kShot) + frame(5, kShot));
    const Outcome outcome = run_program(folder, "render a.rib");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(pictures(folder), (Names{"shot.3.exr", "shot.4.exr", "shot.exr"}));
    EXPECT_NE(outcome.err.find("note: \"shot.exr\" of an earlier frame is kept as \"shot.3.exr\""),
              std::string::npos)
        << outcome.err;
}

TEST(OutputFiles, OfEmptyWorldsTakeNoName) {
    const SetVariable date("SOURCE_DATE_EPOCH", "0");  // equal pictures are equal files
    WorkFolder folder;
    const std::string drawn = world(kShot), empty = world("Display \"empty.exr\" \"openexr\" \"rgba\"", true);
    folder.write("first.rib", empty + drawn), folder.write("last.rib", drawn + world("", true));
    for (const char* file : {"first.rib", "last.rib"}) {
        ASSERT_EQ(run_program(folder, std::string("render ") + file + " -o x.exr --stats s.json").exit_code,
                  0);
        EXPECT_GT(fs::file_size(folder / "x.exr"), 0u);
        EXPECT_FALSE(fs::exists(folder / "x.2.exr") && file == std::string("first.rib"));
        fs::remove(folder / "x.exr");
    }
    // The one that shows something has the name.
    folder.write("order.rib", drawn + empty);
    ASSERT_EQ(run_program(folder, "render order.rib -o x.exr").exit_code, 0);
    ASSERT_EQ(run_program(folder, "render first.rib -o y.exr").exit_code, 0);
    EXPECT_EQ(fs::file_size(folder / "x.exr"), fs::file_size(folder / "y.exr"));
}

/// What is behind the camera or beside the view is not seen either.
TEST(OutputFiles, InWhichNothingIsSeenTakeNoName) {
    const SetVariable date("SOURCE_DATE_EPOCH", "0");
    WorkFolder folder;
    const std::string hidden =
        "\nFormat 8 8 1 PixelSamples 1 1 WorldBegin\nTranslate 0 90 2 Sphere 1 -1 1 360\n"
        "WorldEnd\n";
    folder.write("alone.rib", "Display \"a.exr\" \"openexr\" \"rgba\"" + hidden);
    ASSERT_EQ(run_program(folder, "render alone.rib -o alone.exr").exit_code, 0);
    folder.write("s.rib", world("Display \"c.exr\" \"openexr\" \"rgba\""));  // files name their scene
    ASSERT_EQ(run_program(folder, "render s.rib -o seen.exr").exit_code, 0);
    folder.write("a.rib", "Display \"a.exr\" \"openexr\" \"rgba\"" + hidden +
                              "Display \"b.exr\" \"openexr\" \"rgba\"" + hidden +
                              world("Display \"c.exr\" \"openexr\" \"rgba\"") +
                              "Display \"d.exr\" \"openexr\" \"rgba\"" + hidden);
    const Outcome outcome = run_program(folder, "render a.rib -o x.exr");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(pictures(folder), (Names{"alone.exr", "seen.exr", "x.2.exr", "x.exr"}));
    EXPECT_EQ(fs::file_size(folder / "x.exr"), fs::file_size(folder / "seen.exr"));
    EXPECT_NE(fs::file_size(folder / "x.exr"), fs::file_size(folder / "alone.exr"));
}

TEST(OutputFiles, AreNotStandardOutput) {
    WorkFolder folder;
    folder.write("a.rib", world(kShot));
    const Outcome outcome = run_program(folder, "render a.rib -o -");
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_NE(outcome.err.find("standard output"), std::string::npos) << outcome.err;
    EXPECT_TRUE(pictures(folder).empty());
}

TEST(OutputFiles, OfAnotherFormatAreNotAskedWhatTheFirstWas) {
    WorkFolder folder;
    folder.write("a.rib", world("Display \"a.exr\" \"openexr\" \"rgba\" \"string compression\" [\"piz\"] "
                                "\"string exrheader_artist\" [\"Somebody\"]"));
    const Outcome outcome = run_program(folder, "render a.rib -o x.png --transfer linear --strict");
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_EQ(outcome.err, "");
    ASSERT_EQ(run_program(folder, "render a.rib -o x.exr").exit_code, 0);
    EXPECT_NE(file_text(folder / "x.exr").find("Somebody"), std::string::npos);
}

TEST(OutputFiles, OfTwoDisplaysAreSharedOrBesideEachOther) {
    WorkFolder folder;
    folder.write(
        "a.rib",
        world("Display \"a.exr\" \"openexr\" \"rgba\"\nDisplay \"+a.exr\" \"openexr\" \"normal N\""));
    EXPECT_EQ(run_program(folder, "render a.rib --strict").err, "");
    EXPECT_EQ(pictures(folder), (Names{"a.exr"}));
    // What renames the first renames its layers.
    EXPECT_EQ(run_program(folder, "render a.rib --strict -o b.exr").err, "");
    EXPECT_EQ(pictures(folder), (Names{"a.exr", "b.exr"}));
    folder.write("c.rib",
                 world("Display \"c.tif\" \"tiff\" \"rgba\"\nDisplay \"+c.tif\" \"tiff\" \"normal N\""));
    const Outcome outcome = run_program(folder, "render c.rib");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_TRUE(fs::exists(folder / "c.tif") && fs::exists(folder / "c.N.tif"));
    EXPECT_NE(outcome.err.find("c.rib:2:1: warning: \"c.tif\" is another display's"), std::string::npos)
        << outcome.err;
    EXPECT_EQ(run_program(folder, "render c.rib --strict").exit_code, 1);
}

TEST(OutputFiles, HaveTheLayersThatAovAsksFor) {
    WorkFolder folder;
    folder.write("a.rib", world("Display \"a.exr\" \"openexr\" \"rgb\""));
    const std::string all =
        " --aov \"albedo,N,P,z,id,motion,uv,alpha,crypto_object,crypto_material,crypto_asset\" --strict";
    EXPECT_EQ(run_program(folder, "render a.rib" + all).err, "");
    EXPECT_EQ(pictures(folder), (Names{"a.exr"}));
    EXPECT_EQ(run_program(folder, "render a.rib -d null" + all).err, "");
    // A picture without layers has them in a file beside it.
    const Outcome beside = run_program(folder, "render a.rib -o b.png --aov N");
    EXPECT_EQ(beside.exit_code, 0) << beside.err;
    EXPECT_EQ(pictures(folder), (Names{"a.exr", "b.exr", "b.png"}));
    EXPECT_NE(beside.err.find("\"b.png\" holds no layers; --aov writes \"b.exr\""), std::string::npos)
        << beside.err;
    const Outcome missing = run_program(folder, "render a.rib --aov 'color nowhere'");
    EXPECT_EQ(missing.exit_code, 0);
    EXPECT_NE(missing.err.find("has a variable \"nowhere\""), std::string::npos) << missing.err;
    const Outcome wrong = run_program(folder, "render a.rib --aov N,crypto_shader");
    EXPECT_NE(wrong.exit_code, 0);
    EXPECT_NE(wrong.err.find("\"crypto_shader\" is none of albedo"), std::string::npos) << wrong.err;
}

TEST(OutputFiles, AreInTheStatistics) {
    WorkFolder folder;
    folder.write("a.rib", world(std::string(kShot) + "\nDisplay \"+z.exr\" \"openexr\" \"z\""));
    ASSERT_EQ(run_program(folder, "render a.rib --stats s.json").exit_code, 0);
    const auto stats = nlohmann::json::parse(file_text(folder / "s.json"));
    ASSERT_EQ(stats.at("outputs").size(), 2u);
    EXPECT_EQ(stats["outputs"][0].at("path"), "shot.exr");
    EXPECT_EQ(stats["outputs"][1].at("path"), "z.exr");
    EXPECT_EQ(stats["outputs"][1].at("bytes"), fs::file_size(folder / "z.exr"));
}

TEST(OutputFiles, AreSaidOnATerminalAlone) {
    WorkFolder folder;
    folder.write("a.rib", world(kShot));
    EXPECT_EQ(run_program(folder, "render a.rib").err, "");
    EXPECT_NE(said_on_a_terminal(folder, "render a.rib --progress none").find("wrote shot.exr, 8x8, "),
              std::string::npos);
}

/// Not pictures alone: reports, statistics, scenes.
TEST(OutputFiles, OfEveryCommandAreSaidOnATerminal) {
    WorkFolder folder;
    folder.write("a.rib", world(kShot));
    const std::pair<const char*, Names> cases[] = {
        {"render a.rib --stats st.json", {"shot.exr", "st.json"}},
        {"cat a.rib -o c.rib", {"c.rib"}},
        {"scene halberd -o h.rib", {"h.rib"}},
        {"compare a.rib --samplers raytrace --reference 1 --json c.json --report c.html -o dir",
         {"c.json", "c.html", "dir/raytrace_1x1.exr", "dir/reference_1x1.exr"}}};
    for (const auto& [command, files] : cases) {
        const std::string said = said_on_a_terminal(folder, command);
        for (const std::string& file : files) {
            EXPECT_NE(said.find("wrote " + file), std::string::npos) << said;
            EXPECT_TRUE(fs::exists(folder / file)) << file;
        }
        EXPECT_EQ(run_program(folder, command).err.find("wrote"), std::string::npos) << command;
    }
}

/// Each is named, with what is done instead.
TEST(Displays, ThatCannotBeHonouredAreNamedOneByOne) {
    WorkFolder folder;
    folder.write("a.rib",
                 world("Display \"a.exr\" \"vortech\" \"rgba\"\nDisplay \"+b.exr\" \"teleporter\" \"rgb\"\n"
                       "Display \"+c.exr\" \"openexr\" \"bgr\"\nDisplay \"+d.exr\" \"openexr\" \"sepia\"\n"
                       "Display \"+e\" \"framebuffer\" \"a\"\nDisplay \"+f\" \"it\" \"az\"\n"
                       "Display \"+g.exr\" \"openexr\" \"color one\"\n"
                       "Display \"+h.exr\" \"openexr\" \"color two\"\n"
                       "Display \"+i.exr\" \"openexr\" \"color two\""));
    const Outcome outcome = run_program(folder, "render a.rib");
    EXPECT_EQ(outcome.exit_code, 0);
    for (
        const char* text :
        {"a.rib:1:1: warning: Display driver \"vortech\" is not known; \"a.exr\" is written as its "
         "extension says",
         "a.rib:2:1: warning: Display driver \"teleporter\"",
         "a.rib:3:1: warning: Display mode \"bgr\" is not supported; it is left out of \"c.exr\"",
         "a.rib:4:1: warning: Display mode \"sepia\"",
         "a.rib:5:1: warning: Display \"framebuffer\": no window is opened; \"e.exr\" is written instead",
         "a.rib:6:1: warning: Display \"it\"",
         "a.rib:7:1: warning: Display \"g.exr\": no surface or displacement shader of the scene has a variable "
         "\"one\" of three numbers; it is 0 everywhere",
         "a.rib:8:1: warning: Display \"h.exr\"", "a.rib:9:1: warning: Display \"i.exr\""})
        EXPECT_NE(outcome.err.find(text), std::string::npos) << text << "\n" << outcome.err;
    EXPECT_EQ(run_program(folder, "render a.rib --strict").exit_code, 1);
}

/// A window beside a file is not opened either.
TEST(Displays, WindowsAreNamedOneByOne) {
    WorkFolder folder;
    folder.write("a.rib",
                 world("Display \"a.exr\" \"openexr\" \"rgba\"\nDisplay \"+one\" \"framebuffer\" \"rgb\"\n"
                       "Display \"+two\" \"it\" \"rgb\""));
    const Outcome outcome = run_program(folder, "render a.rib");
    EXPECT_EQ(outcome.exit_code, 0);
    for (const char* text :
         {"a.rib:2:1: warning: Display of \"one\": no window (\"framebuffer\") is opened; see \"a.exr\"",
          "a.rib:3:1: warning: Display of \"two\": no window (\"it\") is opened; see \"a.exr\""})
        EXPECT_NE(outcome.err.find(text), std::string::npos) << text << "\n" << outcome.err;
    EXPECT_EQ(run_program(folder, "render a.rib --strict").exit_code, 1);
}

TEST(OutputFiles, MapsAreInTheStatistics) {
    WorkFolder folder;
    folder.write("a.rib",
                 world(kShot) + "MakeTexture \"shot.exr\" \"shot.tex\" \"black\" \"black\" \"box\" 1 1\n");
    ASSERT_EQ(run_program(folder, "render a.rib --stats s.json").exit_code, 0);
    const auto maps = nlohmann::json::parse(file_text(folder / "s.json")).at("maps");
    ASSERT_EQ(maps.size(), 1u);
    EXPECT_EQ(maps[0].at("path"), "shot.tex");
    EXPECT_EQ(maps[0].at("bytes"), fs::file_size(folder / "shot.tex"));
}

/// A file of map requests alone is no mistake.
TEST(OutputFiles, MapsAloneAreEnough) {
    WorkFolder folder;
    folder.write("a.rib", world(kShot));
    ASSERT_EQ(run_program(folder, "render a.rib").exit_code, 0);
    folder.write("b.rib", "MakeTexture \"shot.exr\" \"shot.tex\" \"black\" \"black\" \"box\" 1 1\n");
    const Outcome outcome = run_program(folder, "render b.rib --stats s.json");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(nlohmann::json::parse(file_text(folder / "s.json")).at("maps").size(), 1u);
    folder.write("b.rib", "MakeTexture \"none.exr\" \"shot.tex\" \"black\" \"black\" \"box\" 1 1\n");
    EXPECT_EQ(run_program(folder, "render b.rib").exit_code, 4);
}

/// Outside of the working folder they write over reports of other runs, and over nothing else.
TEST(Statistics, ElsewhereWriteOverTheirLikesAlone) {
    WorkFolder folder, elsewhere;
    folder.write("a.rib", world(kShot));
    const std::string file = (elsewhere / "notes.txt").string(), run = "render a.rib --stats '" + file + "'";
    elsewhere.write("notes.txt", "mine");
    const Outcome refused = run_program(folder, run);
    EXPECT_EQ(refused.exit_code, 6);
    EXPECT_NE(refused.err.find("is no report of a run"), std::string::npos) << refused.err;
    EXPECT_EQ(file_text(elsewhere / "notes.txt"), "mine");
    fs::remove(file);
    for (const bool is_there : {false, true}) {
        const Outcome outcome = run_program(folder, run);
        EXPECT_EQ(outcome.exit_code, 0) << is_there << outcome.err;
        EXPECT_NE(outcome.err.find("lies outside of the working folder"), std::string::npos) << outcome.err;
    }
    EXPECT_EQ(run_program(folder, run + " --safe").exit_code, 6);
    EXPECT_EQ(run_program(folder, "render a.rib --safe --stats s.json").exit_code, 0);
}

/// As on a full disk; the system would end the program.
TEST(OutputFiles, LargerThanTheUsersLimitEndWithSix) {
    WorkFolder folder;
    const std::string large =
        "\nFormat 128 128 1 PixelSamples 1 1 WorldBegin\nTranslate 0 0 2\n"
        "Surface \"constant\" Sphere 1 -1 1 360\nWorldEnd\n";
    folder.write("pass.rib", "Display \"pass.exr\" \"openexr\" \"rgba\"" + large);
    ASSERT_EQ(run_program(folder, "render pass.rib").exit_code, 0);
    folder.write("1.rib", "Display \"a.exr\" \"openexr\" \"rgba\" \"string compression\" [\"none\"]" + large);
    folder.write("2.rib", "Display \"a.tif\" \"tiff\" \"rgba\" \"string compression\" [\"none\"]" + large);
    folder.write("3.rib", "Display \"a.bmp\" \"bmp\" \"rgb\"" + large);
    folder.write("4.rib", "Display \"a.z\" \"zfile\" \"z\"" + large);
    folder.write("5.rib", "MakeTexture \"pass.exr\" \"a.tex\" \"black\" \"black\" \"box\" 1 1\n");
    for (const char* file : {"1", "2", "3", "4", "5"}) {
        const std::string run = "cd '" + folder.path().string() +
                                "' && ulimit -f 1 && '" TRAPEZE_PROGRAM "' render " + file +
                                ".rib </dev/null >.stdout 2>.stderr";
        const std::string before = files_in(folder);
        const int status = std::system(("bash -c \"" + run + "\"").c_str());
        EXPECT_EQ(WIFEXITED(status) ? WEXITSTATUS(status) : -1, 6) << file;
        EXPECT_EQ(files_in(folder), before) << file;
        const std::string said = file_text(folder / ".stderr");
        EXPECT_NE(said.find("error: cannot "), std::string::npos) << said;
        EXPECT_NE(said.find("File too large"), std::string::npos) << said;
    }
}

/// What is no picture stays, also in the working folder; what the program itself has made is replaced.
TEST(Displays, OverwriteNothingButPictures) {
    WorkFolder folder;
    folder.write("victim.rib", "# mine");
    folder.write("a.rib", world("Display \"victim.rib\" \"exr\" \"rgba\""));
    const Outcome outcome = run_program(folder, "render a.rib");
    EXPECT_EQ(outcome.exit_code, 6);
    EXPECT_NE(
        outcome.err.find("a.rib:1:1: error: cannot write \"victim.rib\": the file that is there is not a "
                         "picture"),
        std::string::npos)
        << outcome.err;
    EXPECT_EQ(file_text(folder / "victim.rib"), "# mine");
    folder.write("b.rib", "MakeTexture \"a.exr\" \"victim.rib\" \"black\" \"black\" \"box\" 1 1\n");
    ASSERT_EQ(run_program(folder, "render a.rib -o a.exr").exit_code, 0);
    EXPECT_EQ(run_program(folder, "render b.rib").exit_code, 6);
    EXPECT_EQ(file_text(folder / "victim.rib"), "# mine");
    // The user has named it.
    EXPECT_EQ(run_program(folder, "render a.rib -o a.exr --stats victim.rib").exit_code, 0);

    std::string all = world("Display \"d.z\" \"zfile\" \"z\"\nDisplay \"+e.shd\" \"shadow\" \"z\"");
    for (const char* ending : {"exr", "tif", "png", "jpg", "tga", "bmp"})
        all += world(std::string("Display \"f.") + ending + "\" \"file\" \"rgb\"");
    all +=
        "MakeTexture \"f.tif\" \"f.tex\" \"black\" \"black\" \"box\" 1 1\n"
        "MakeBump \"f.tif\" \"f.bump\" \"black\" \"black\" \"box\" 1 1\n"
        "MakeLatLongEnvironment \"f.tif\" \"f.env\" \"box\" 1 1\nMakeShadow \"d.z\" \"d.shd\"\n";
    folder.write("all.rib", all);
    for (const char* time : {"first", "second"}) {
        const Outcome made = run_program(folder, "render all.rib --stats s.json");
        EXPECT_EQ(made.exit_code, 0) << time << made.err;
    }
}

TEST(Displays, WithoutANameHaveOne) {
    WorkFolder folder;
    folder.write("a.rib", world("Display \"\" \"framebuffer\" \"rgb\""));
    const Outcome outcome = run_program(folder, "render a.rib");
    EXPECT_EQ(pictures(folder), Names{"untitled.exr"}) << outcome.err;
}

/// One who sets the date gets the same file each time.
TEST(OutputFiles, AreTheSameBytesOnASetDate) {
    WorkFolder folder;
    folder.write("a.rib", frame(2, std::string(kShot) + "\nDisplay \"+b.png\" \"png\" \"rgb\""));
    std::string first[2];
    for (const bool again : {false, true}) {
        const std::string run = "cd '" + folder.path().string() +
                                "' && SOURCE_DATE_EPOCH=1700000000 '" TRAPEZE_PROGRAM "' render a.rib";
        ASSERT_EQ(std::system(run.c_str()), 0);
        for (const int i : {0, 1}) {
            const std::string bytes = file_text(folder / (i ? "b.png" : "shot.exr"));
            if (again) {
                EXPECT_EQ(bytes, first[i]) << i;
            }
            first[i] = bytes;
        }
    }
    EXPECT_NE(first[0].find("2023:11:14 22:13:20"), std::string::npos);
    EXPECT_NE(first[0].find("a.rib"), std::string::npos);
}

}  // namespace
}  // namespace trapeze::testing
