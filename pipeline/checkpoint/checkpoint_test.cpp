#include "pipeline/checkpoint/checkpoint.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>

#include "composite/film/film.h"
#include "core/files/file_text_harness.h"
#include "core/files/temporary_folder_harness.h"
#include "core/random.h"
#include "pipeline/frame/make_context.h"

namespace trapeze {
namespace {

namespace fs = std::filesystem;
using testing::file_text;
using testing::TemporaryFolder;

void write_file(const fs::path& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}

CheckpointState some_state() {
    CheckpointState state;
    state.origin = {"1.0", "abc", {{"samples", {"4x4"}}, {"safe", {}}}, {{"a.rib", 3, "ff", 12}}};
    state.worlds = {{false, true, {"a.exr", "b.exr"}}, {true, false, {}}};
    state.maps = {0, 2}, state.map_files = {"m.tx"}, state.passes = {"p.tif"};
    state.kept = {{"a.exr", 3}}, state.written = {{"a.exr", 9, "", -5}};
    state.tiles = 7, state.regions = 4;
    return state;
}

TEST(CheckpointFile, GivesBackWhatWasWritten) {
    const TemporaryFolder folder;
    const std::string path = folder.file("a.checkpoint"), tiles = "tiles as they are";
    const auto write = [&](const WriteBytes& bytes) { return bytes(tiles.data(), tiles.size()); };
    ASSERT_EQ(write_checkpoint(path, some_state(), write), "");
    EXPECT_TRUE(is_checkpoint(path));
    std::string problem;
    const auto reader = CheckpointReader::open(path, &problem);
    ASSERT_TRUE(reader) << problem;
    const CheckpointState expected = some_state(), &found = reader->state();
    EXPECT_EQ(found.origin.version, "1.0");
    EXPECT_EQ(found.origin.options, expected.origin.options);
    ASSERT_EQ(found.origin.files.size(), 1u);
    EXPECT_TRUE(found.origin.files[0].is_like(expected.origin.files[0]));
    ASSERT_EQ(found.worlds.size(), 2u);
    EXPECT_EQ(found.worlds[0].pictures, expected.worlds[0].pictures);
    EXPECT_TRUE(found.worlds[0].shows_something && found.worlds[1].failed);
    EXPECT_TRUE(found.maps == expected.maps && found.map_files == expected.map_files);
    EXPECT_TRUE(found.passes == expected.passes && found.kept == expected.kept);
    ASSERT_EQ(found.written.size(), 1u);
    EXPECT_EQ(found.written[0].modified, -5);
    EXPECT_TRUE(found.tiles == 7 && found.regions == 4);
    std::string got(tiles.size(), ' ');
    ASSERT_TRUE(reader->read(got.data(), got.size()));
    EXPECT_EQ(got, tiles);
    char more;
    EXPECT_FALSE(reader->read(&more, 1));
}

TEST(CheckpointFile, ThatIsNotWholeIsRefused) {
    const TemporaryFolder folder;
    const std::string path = folder.file("a.checkpoint");
    ASSERT_EQ(write_checkpoint(path, some_state(), [](const WriteBytes&) { return true; }), "");
    const std::string good = file_text(path);
    std::string problem;
    for (uint32_t i = 0; i < 200; ++i) {
        std::string bad = good;
        if (i % 2)
            bad.resize(hash(i) % bad.size());
        else
            bad[hash(i) % bad.size()] ^= static_cast<char>(1 + hash(i, 1) % 255);
        write_file(path, bad);
        EXPECT_FALSE(CheckpointReader::open(path, &problem)) << i;
        EXPECT_NE(problem, "");
    }
    EXPECT_FALSE(CheckpointReader::open(folder.file("none"), &problem));
    // What cannot be written leaves what is there.
    write_file(path, good);
    EXPECT_NE(write_checkpoint(path, some_state(), [](const WriteBytes&) { return false; }), "");
    EXPECT_NE(write_checkpoint(folder.file("none/a"), some_state(), [](auto&) { return true; }), "");
    EXPECT_EQ(file_text(path), good);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);
}

TEST(RunOrigin, TellsWhatHasChanged) {
    const TemporaryFolder folder;
    const std::string a = folder.file("a"), b = folder.file("b");
    write_file(a, "one"), write_file(b, "two");
    FileLooker looker;
    const std::vector<SeenFile> then{*looker.look(a), *looker.look(b)};
    EXPECT_TRUE(changed_files(then, looker).empty());
    EXPECT_FALSE(looker.look(folder.file("c")));
    EXPECT_FALSE(looker.look(folder.path()));
    // Another date alone is no change, another text of the same length is one.
    fs::last_write_time(a, fs::last_write_time(a) + std::chrono::seconds(5));
    EXPECT_TRUE(changed_files(then, looker).empty());
    write_file(a, "uno");
    fs::last_write_time(a, fs::last_write_time(a) + std::chrono::seconds(9));
    fs::remove(b);
    EXPECT_EQ(changed_files(then, looker),
              (std::vector<std::string>{"\"" + a + "\" has changed", "\"" + b + "\" is gone"}));

    RunOrigin was{"1", "r", {{"samples", {"4x4"}}, {"aov", {"N"}}}, {}}, is = was;
    EXPECT_TRUE(changed_settings(was, is).empty());
    is.options = {{"samples", {"8x8"}}, {"safe", {}}};
    is.revision = "s";
    EXPECT_EQ(changed_settings(was, is),
              (std::vector<std::string>{"the program was version 1 (r), is 1 (s)", "samples was 4x4, is 8x8",
                                        "aov was N, is not given", "safe was not given, is given"}));
}

/// Of a run over two worlds that ends early.
TEST(Checkpoint, KnowsTheWorldsAndMapsOfARunThatEndedEarly) {
    const TemporaryFolder folder;
    const std::string path = folder.file("a.checkpoint"), scene = folder.file("a.rib"),
                      picture = folder.file("p.exr");
    write_file(scene, "scene");
    const auto reads = std::make_shared<ReadNames>();
    reads->add(scene);
    CheckpointSettings settings{path, 1000, true, {"1", "r", {{"seed", {"0"}}}, {}}};
    Diagnostics diagnostics;
    const auto run = [&](const auto& steps) {
        Checkpoint checkpoint(settings, reads, diagnostics);
        EXPECT_TRUE(checkpoint.can_write());
        const bool opened = checkpoint.open();
        EXPECT_EQ(opened, !checkpoint.refused());
        if (opened) steps(checkpoint);
        return opened;
    };
    EXPECT_TRUE(run([&](Checkpoint& checkpoint) {
        EXPECT_FALSE(checkpoint.begin_world(0));
        write_file(picture, "picture");
        checkpoint.finish_world({false, true, {picture}}, {{picture, 3}});
        checkpoint.finish_map(1, picture);
        EXPECT_FALSE(fs::exists(path));
        EXPECT_NE(checkpoint.save_at_end().find("--resume"), std::string::npos);
        EXPECT_TRUE(fs::exists(path));
    }));
    EXPECT_TRUE(run([&](Checkpoint& checkpoint) {
        ASSERT_TRUE(checkpoint.begin_world(0));
        EXPECT_TRUE(checkpoint.begin_world(0)->shows_something);
        EXPECT_TRUE(checkpoint.has_made_map(1) && !checkpoint.has_made_map(0));
        EXPECT_EQ(checkpoint.state().kept.at(picture), 3);
        EXPECT_FALSE(checkpoint.begin_world(1));
    }));
    EXPECT_EQ(diagnostics.count(Severity::Error), 0u);
    // Another picture is there now: it is rendered again.
    write_file(picture, "another");
    EXPECT_TRUE(run([&](Checkpoint& checkpoint) { EXPECT_FALSE(checkpoint.begin_world(0)); }));
    // Another scene, or other options, are refused, and the file stays.
    settings.origin.options = {{"seed", {"1"}}};
    EXPECT_FALSE(run([](Checkpoint&) {}));
    settings.origin.options = {{"seed", {"0"}}};
    write_file(scene, "other");
    EXPECT_FALSE(run([](Checkpoint&) {}));
    EXPECT_EQ(diagnostics.count(Severity::Error), 2u);
    EXPECT_TRUE(is_checkpoint(path));
    // Complete runs leave nothing.
    write_file(scene, "scene");
    EXPECT_TRUE(run([](Checkpoint& checkpoint) { checkpoint.remove(); }));
    EXPECT_FALSE(fs::exists(path));
    write_file(path, "somebody's");
    EXPECT_FALSE(Checkpoint(settings, reads, diagnostics).can_write());
    EXPECT_EQ(file_text(path), "somebody's");
}

/// A run that ended between two worlds: the second may read what the first did not, the first may not.
TEST(Checkpoint, RefusesWhatAFinishedWorldDidNotRead) {
    const TemporaryFolder folder;
    const std::string path = folder.file("a.checkpoint"), scene = folder.file("a.rib"),
                      shader = folder.file("red.sl");
    for (const std::string& file : {scene, shader}) write_file(file, "text");
    const CheckpointSettings settings{path, 1000, true, {"1", "r", {}, {}}};
    const Scene of_picture;
    const RenderSettings of_frame;
    Diagnostics diagnostics;
    const auto run = [&](const auto& steps) {
        const auto reads = std::make_shared<ReadNames>();
        reads->add(scene);
        Checkpoint checkpoint(settings, reads, diagnostics);
        ASSERT_TRUE(checkpoint.open());
        steps(checkpoint, *reads);
    };
    run([&](Checkpoint& checkpoint, ReadNames&) {
        EXPECT_FALSE(checkpoint.begin_world(0));
        checkpoint.finish_world({false, true, {}}, {});
        checkpoint.save_at_end();
    });
    run([&](Checkpoint& checkpoint, ReadNames& reads) {
        EXPECT_TRUE(checkpoint.begin_world(0));
        reads.add(shader);
        EXPECT_FALSE(checkpoint.begin_world(1));
        const RenderContext context = make_context(of_picture, of_frame, diagnostics);
        Film film(context);
        EXPECT_TRUE(checkpoint.begin(film));
        EXPECT_FALSE(checkpoint.refused());
        EXPECT_EQ(diagnostics.count(Severity::Error), 0u);
    });
    run([&](Checkpoint& checkpoint, ReadNames& reads) {
        reads.add(shader);
        EXPECT_TRUE(checkpoint.begin_world(0));
        EXPECT_TRUE(checkpoint.refused());
        EXPECT_EQ(diagnostics.count(Severity::Error), 1u);
    });
}

TEST(Checkpoint, SavesNowAndThenUntilAFileChanges) {
    const TemporaryFolder folder;
    const std::string path = folder.file("a.checkpoint"), scene = folder.file("a.rib");
    write_file(scene, "scene");
    const auto reads = std::make_shared<ReadNames>();
    reads->add(scene);
    Diagnostics diagnostics;
    Checkpoint checkpoint({path, .005, false, {"1", "r", {}, {}}}, reads, diagnostics);
    ASSERT_TRUE(checkpoint.open());
    const auto saved_worlds = [&] {
        std::string problem;
        const auto reader = CheckpointReader::open(path, &problem);
        return reader ? reader->state().worlds.size() : 0;
    };
    const auto wait = [&](const auto& until) {
        for (int i = 0; i < 2000 && !until(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(5));
        return until();
    };
    checkpoint.begin_world(0);
    checkpoint.finish_world({false, true, {}}, {});
    EXPECT_TRUE(wait([&] { return saved_worlds() == 1; }));
    write_file(scene, "changed");
    checkpoint.begin_world(1);
    checkpoint.finish_world({false, true, {}}, {});
    EXPECT_TRUE(wait([&] { return diagnostics.count(Severity::Warning) == 1; }));
    EXPECT_EQ(saved_worlds(), 1u);
}

}  // namespace
}  // namespace trapeze
