/// Renders that are broken off and gone on with.
#include <chrono>

#include "core/random.h"
#include "tests/command_line/command_line_harness.h"

namespace trapeze::testing {
namespace {

/// A shadow map, and two pictures that are lit through it, of which the second takes a second or so. Its
/// textures, archives and shaders are files.
constexpr const char* kFrames = R"(PixelSamples 4 4
FrameBegin 1
    Format 64 64 1 Projection "perspective" "fov" [60] Display "light.z" "zfile" "z"
    Rotate 90 1 0 0 Translate 0 -5 0
    WorldBegin ReadArchive "balls.rib" WorldEnd
    MakeShadow "light.z" "light.shd"
FrameEnd
FrameBegin 2
    Format 64 48 1 Projection "perspective" "fov" [40] Display "small.exr" "openexr" "rgba"
    Translate 0 0 5
    WorldBegin LightSource "ambientlight" 1 Surface "red" ReadArchive "balls.rib" WorldEnd
FrameEnd
FrameBegin 3
    Format 640 400 1 Projection "perspective" "fov" [40] PixelSamples 10 10
    Display "large.exr" "openexr" "rgba" Display "+large_z.exr" "openexr" "z"
    Display "+deep.exr" "deepexr" "rgba"
    Translate 0 0 5
    WorldBegin
    LightSource "shadowspot" 1 "from" [0 5 0] "to" [0 0 0] "coneangle" [.8] "intensity" [30]
        "shadowname" ["light.shd"]
    Surface "red" ReadArchive "balls.rib"
    WorldEnd
FrameEnd
)";
constexpr const char* kBalls =
    "Opacity [.7 .7 .7] Sphere 1 -1 1 360 Translate .6 .4 -1 Sphere .4 -.4 .4 360 "
    "Translate -1.2 -.9 0 Sphere .3 -.3 .3 360\n";
constexpr const char* kRed =
    "surface red() { Oi = Os; Ci = Os * (color(.2 + noise(20 * P), .1, .1) + diffuse(normalize(N))); }";

void write_scene(const WorkFolder& folder) {
    folder.write("a.rib", kFrames);
    folder.write("balls.rib", kBalls);
    folder.write("red.sl", kRed);
}

/// Not the map, which has the date on which it was made.
const std::vector<std::string> kPictures = {"small.exr", "large.exr", "large_z.exr", "deep.exr"};

/// Pictures then have no times in them.
Outcome render(const WorkFolder& folder, const std::string& options, const std::string& before = {}) {
    return run_program(folder, "render a.rib " + options, "env SOURCE_DATE_EPOCH=1000000000 " + before);
}

/// Seconds that a plain render takes now, as busy as the machine is.
double seconds_of_render(const WorkFolder& folder, const std::string& options = {}) {
    const auto start = std::chrono::steady_clock::now();
    EXPECT_EQ(render(folder, options).exit_code, 0);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void expect_same_pictures(const WorkFolder& a, const WorkFolder& b) {
    for (const std::string& name : kPictures) {
        ASSERT_FALSE(file_text(a / name).empty()) << name;
        EXPECT_TRUE(file_text(a / name) == file_text(b / name)) << name;
    }
}

TEST(Resume, KilledAtTwentyMomentsEveryPictureIsTheSame) {
    WorkFolder whole, folder;
    write_scene(whole), write_scene(folder);
    const double whole_seconds = seconds_of_render(whole);
    int kills = 0, went_on = 0;
    for (uint32_t i = 0; kills < 20 && i < 60; ++i) {
        const double seconds = whole_seconds * (.05 + .75 * unit_float(hash(i)));
        const Outcome run =
            render(folder, "--resume --checkpoint .05s", "timeout -s KILL " + std::to_string(seconds) + " ");
        if (run.err.find("note: goes on with") != std::string::npos) ++went_on;
        if (run.exit_code == 0) {
            expect_same_pictures(whole, folder);
            for (const std::string& name : kPictures) fs::remove(folder / name);
        } else {
            ASSERT_EQ(run.exit_code, 137) << run.err;
            ++kills;
        }
    }
    const Outcome last = render(folder, "--resume");
    EXPECT_EQ(last.exit_code, 0) << last.err;
    expect_same_pictures(whole, folder);
    EXPECT_EQ(kills, 20);
    EXPECT_GT(went_on, 0);
    EXPECT_EQ(files_in(whole).size(), files_in(folder).size()) << files_in(folder);
    RecordProperty("went_on", went_on);
}

TEST(Resume, TheTimeLimitSavesUntilARunComesToItsEnd) {
    WorkFolder whole, folder;
    write_scene(whole), write_scene(folder);
    const double seconds = seconds_of_render(whole, "--samples 12");
    const std::string limit = " --time-limit " + std::to_string(.6 * seconds);
    int attempts = 0;
    bool said = false;
    Outcome run = render(folder, "--samples 12 --checkpoint 1h" + limit);
    while (run.exit_code == 8 && ++attempts < 40) {
        said = said || run.err.find("saved in \"a.exr.checkpoint\"; --resume") != std::string::npos;
        run = render(folder, "--samples 12 --resume" + limit);
    }
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_GT(attempts, 0);
    EXPECT_TRUE(said);
    expect_same_pictures(whole, folder);
    EXPECT_FALSE(fs::exists(folder / "a.exr.checkpoint"));
}

/// Runs it until more is saved than the small picture has, and ends it by SIGTERM.
void break_off(const WorkFolder& folder, const std::string& options = {},
               const std::string& checkpoint = "a.exr.checkpoint") {
    folder.write("term.sh", "\"$@\" & while kill -0 $! && [ $(stat -c %s " + checkpoint +
                                " || echo 0) -lt 90000 ]; "
                                "do sleep .02; done 2>/dev/null; kill -TERM $!; wait $!");
    const Outcome run = render(folder, "--checkpoint .05s " + options, "bash term.sh");
    ASSERT_EQ(run.exit_code, 143);
    EXPECT_NE(run.err.find("tiles of the picture are saved in \"" + checkpoint + "\"; --resume"),
              std::string::npos)
        << run.err;
    ASSERT_TRUE(fs::exists(folder / checkpoint));
}

TEST(Resume, WhatHasChangedIsRefusedByName) {
    WorkFolder folder;
    write_scene(folder);
    break_off(folder);
    const std::string saved = file_text(folder / "a.exr.checkpoint");
    const auto refused = [&](const std::string& options, const std::string& because) {
        const Outcome run = render(folder, "--resume " + options);
        EXPECT_EQ(run.exit_code, 3) << because;
        EXPECT_NE(run.err.find("error: cannot go on with the checkpoint \"a.exr.checkpoint\": " + because),
                  std::string::npos)
            << run.err;
        EXPECT_TRUE(file_text(folder / "a.exr.checkpoint") == saved);
    };
    for (const auto& [name, text] :
         {std::pair{"a.rib", kFrames}, std::pair{"balls.rib", kBalls}, std::pair{"red.sl", kRed}}) {
        folder.write(name, std::string(text) + "\n");
        const std::string found = name == std::string("red.sl") ? "./red.sl" : name;
        refused("", "\"" + found + "\" has changed");
        fs::remove(folder / name);
        if (name != std::string("a.rib")) refused("", "\"" + found + "\" is gone");
        folder.write(name, text);
    }
    refused("--shading-rate 2", "shading-rate was not given, is 2");
    refused("--seed 4", "seed was 0, is 4");
    // How much of the machine is used may change.
    const Outcome run = render(folder, "--resume -t 1 --memory 200M --regions 5 --simd sse4 --stats s.json");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    WorkFolder whole;
    write_scene(whole);
    render(whole, "");
    expect_same_pictures(whole, folder);
}

TEST(Resume, AShaderThatWasNotThereIsRefused) {
    WorkFolder folder;
    write_scene(folder);
    fs::remove(folder / "red.sl");
    break_off(folder);
    folder.write("red.sl", kRed);
    const Outcome run = render(folder, "--resume");
    EXPECT_EQ(run.exit_code, 3);
    EXPECT_NE(run.err.find("red.sl\" is read now, and was not read then"), std::string::npos) << run.err;
}

TEST(Resume, PicturesThatAreGoneAreRenderedAgain) {
    WorkFolder folder, whole;
    write_scene(folder);
    break_off(folder);
    fs::remove(folder / "small.exr");
    const Outcome run = render(folder, "--resume");
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_NE(run.err.find("small.exr\" is gone since it was written: the run begins anew"),
              std::string::npos)
        << run.err;
    write_scene(whole);
    render(whole, "");
    expect_same_pictures(whole, folder);
}

/// What a map is made of has other values than the file that -o has written.
TEST(Resume, AMapOfAPictureInAnotherFormIsMadeAgain) {
    WorkFolder folder, whole;
    const std::string film = std::string(kFrames).replace(0, 0, R"(PixelSamples 2 2
FrameBegin 2
    Format 64 48 1 Projection "perspective" "fov" [40] Display "pass.exr" "openexr" "rgba" Translate 0 0 5
    WorldBegin ReadArchive "balls.rib" WorldEnd
    MakeTexture "pass.exr" "pass.tx" "black" "black" "box" 1 1
FrameEnd
)");
    for (const WorkFolder* each : {&whole, &folder}) {
        write_scene(*each);
        each->write("a.rib", film);
    }
    ASSERT_EQ(render(whole, "-o x.png").exit_code, 0);
    break_off(folder, "-o x.png", "x.png.checkpoint");
    const Outcome run = render(folder, "--resume -o x.png");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_NE(run.err.find("a map is made of \"pass.exr\": the run begins anew"), std::string::npos)
        << run.err;
    EXPECT_EQ(files_in(folder).size(), files_in(whole).size() + std::string("term.sh ").size())
        << files_in(folder) << "\n"
        << files_in(whole);
    for (const char* const name : {"x.png", "large_z.exr"})
        EXPECT_TRUE(file_text(folder / name) == file_text(whole / name)) << name;
}

TEST(Resume, ADamagedCheckpointIsToldAndTheRunBeginsAnew) {
    WorkFolder folder, whole;
    write_scene(folder);
    break_off(folder);
    const std::string saved = file_text(folder / "a.exr.checkpoint");
    folder.write("a.exr.checkpoint", saved.substr(0, saved.size() - 1000));
    const Outcome run = render(folder, "--resume");
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_NE(run.err.find("warning: cannot go on with the checkpoint \"a.exr.checkpoint\": it is damaged"),
              std::string::npos)
        << run.err;
    write_scene(whole);
    render(whole, "");
    expect_same_pictures(whole, folder);
}

TEST(Resume, ACheckpointThatCannotBeWrittenIsTold) {
    WorkFolder folder;
    write_scene(folder);
    EXPECT_EQ(render(folder, "-o none/a.exr --checkpoint 1s").exit_code, 6);
    folder.write("a.exr.checkpoint", "a letter");
    const Outcome other = render(folder, "--checkpoint 1s");
    EXPECT_EQ(other.exit_code, 6);
    EXPECT_NE(
        other.err.find("cannot write the checkpoint \"a.exr.checkpoint\": what is there is no checkpoint"),
        std::string::npos)
        << other.err;
    EXPECT_EQ(file_text(folder / "a.exr.checkpoint"), "a letter");
    EXPECT_EQ(run_program(folder, "render --resume - <a.rib").exit_code, 2);
}

/// Not even the picture can be written then.
TEST(Resume, AFullDiskIsToldAndWhatWasSavedStays) {
    WorkFolder folder;
    write_scene(folder);
    break_off(folder);
    const std::string saved = file_text(folder / "a.exr.checkpoint");
    const std::string blocks = std::to_string(saved.size() / 2048);
    folder.write("full.sh", "trap '' XFSZ; ulimit -f $1; shift; exec \"$@\"");
    const Outcome run = render(folder, "--resume --checkpoint .05s", "bash full.sh " + blocks);
    EXPECT_EQ(run.exit_code, 6) << run.err;
    EXPECT_NE(run.err.find("warning: cannot write the checkpoint \"a.exr.checkpoint\": File too large"),
              std::string::npos)
        << run.err;
    EXPECT_TRUE(file_text(folder / "a.exr.checkpoint") == saved);
    EXPECT_EQ(render(folder, "--resume").exit_code, 0);
}

TEST(Resume, TilesAndFramesHaveCheckpointsOfTheirOwn) {
    for (const auto& [options, name] : {std::pair{"-o s.####.exr -f 3", "s.0003.exr.checkpoint"},
                                        {"-o s.exr -f 3", "s.3.exr.checkpoint"},
                                        {"-f 3 --tiles 2x1 --tile 2", "a.3.tile2.exr.checkpoint"}}) {
        WorkFolder folder;
        write_scene(folder);
        folder.write("light.shd", "");
        break_off(folder, options, name);
    }
}

}  // namespace
}  // namespace trapeze::testing
