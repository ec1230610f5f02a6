/// Scenes from strangers: each way out that is known is tried, under --safe and, where that does no harm,
/// without, so that the test knows that it is one.
#include <sys/stat.h>

#include <algorithm>

#include "tests/command_line/command_line_harness.h"

namespace trapeze::testing {
namespace {

const std::string kSafeHead =
    "Format 16 12 1\nPixelSamples 1 1\nProjection \"perspective\" \"fov\" 40\nTranslate 0 0 3\n";
const std::string kWorld = "WorldBegin\nSphere 1 -1 1 360\nWorldEnd\n";
/// What is in a file that is closed; every reader repeats it in its message.
constexpr const char* kSecret = "LeakedSecret 1\n";

bool holds_text(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

size_t count_of(const std::string& text, const std::string& part) {
    size_t count = 0;
    for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
    return count;
}

std::string quoted(const std::string& text) {
    return "\"" + text + "\"";
}

/// The working folder, and one that is none of the scene's business.
class Safe : public ::testing::Test {
  protected:
    Outcome render(const std::string& rib, const std::string& options = "--safe") {
        work_.write("a.rib", rib);
        return run_program(work_, "render a.rib -t 1 " + options);
    }
    std::string out(const std::string& name) const { return (outside_ / name).string(); }
    std::string out_from_here(const std::string& name) const {
        return "../" + outside_.path().filename().string() + "/" + name;
    }
    void link(const std::string& target, const std::string& name) const {
        fs::create_symlink(target, work_ / name);
    }

    /// The RIB says of each of `names` what is wrong, and nothing comes of any.
    void expect_closed(const std::string& rib, const std::vector<std::string>& names) {
        const Outcome run = render(rib);
        EXPECT_FALSE(holds_text(run.err, "LeakedSecret")) << run.err;
        for (const std::string& name : names)
            EXPECT_TRUE(holds_text(run.err, quoted(name) + " lies outside") ||
                        holds_text(run.err, quoted(name) + ": lies outside") ||
                        holds_text(run.err, quoted(name) + " is not found"))
                << name << "\n"
                << run.err;
        EXPECT_NE(run.exit_code, 0);
    }

    WorkFolder work_, outside_;
};

TEST_F(Safe, ArchivesLieInside) {
    outside_.write("leak.rib", kSecret);
    link(out("leak.rib"), "file.rib");
    link(outside_.path().string(), "folder");
    ASSERT_EQ(mkfifo((work_ / "pipe").c_str(), 0600), 0);
    work_.write("sub.rib", "ReadArchive \"" + out("leak.rib") + "\"\n");
    const std::string climbing = "x/../" + out_from_here("leak.rib");
    const std::vector<std::string> names = {out("leak.rib"),
                                            out_from_here("leak.rib"),
                                            "file.rib",
                                            "folder/leak.rib",
                                            climbing,
                                            "/proc/self/root" + out("leak.rib"),
                                            "./folder/leak.rib",
                                            "folder/../folder/leak.rib"};
    std::string rib = kSafeHead + "WorldBegin\n";
    for (const std::string& name : names) rib += "ReadArchive " + quoted(name) + "\n";
    rib += "Procedural \"DelayedReadArchive\" [" + quoted(names[0]) + "] [-1 1 -1 1 -1 1]\n";
    rib += "ArchiveBegin \"in\"\nReadArchive " + quoted(names[0]) + "\nArchiveEnd\nReadArchive \"in\"\n";
    rib += "ReadArchive \"sub.rib\"\nSphere 1 -1 1 360\nWorldEnd\n";
    EXPECT_GT(count_of(render(rib, "").err, "LeakedSecret"), 0u);
    expect_closed(rib, names);
    const Outcome devices =
        render(kSafeHead +
               "WorldBegin\nReadArchive \"/dev/stdin\"\nReadArchive \"/proc/self/environ\"\n"
               "ReadArchive \"pipe\"\nReadArchive \"/dev/zero\"\nSphere 1 -1 1 360\nWorldEnd\n");
    for (const char* name : {"/dev/stdin", "/proc/self/environ", "/dev/zero"})
        EXPECT_TRUE(holds_text(devices.err, quoted(name) + " lies outside")) << devices.err;
    EXPECT_TRUE(holds_text(devices.err, "\"pipe\" is not found")) << devices.err;
    EXPECT_FALSE(holds_text(devices.err, "no such request")) << devices.err;
}

TEST_F(Safe, SearchPathsOfScenesLeadNowhereElse) {
    outside_.write("leak.rib", kSecret);
    outside_.write("leak.sl", kSecret);
    link(outside_.path().string(), "folder");
    setenv("LEAK", outside_.path().c_str(), 1);
    setenv("HOME", outside_.path().c_str(), 1);
    const std::vector<std::string> paths = {outside_.path().string(),
                                            "../" + outside_.path().filename().string(),
                                            "folder",
                                            "$LEAK",
                                            "${LEAK}",
                                            "%LEAK%",
                                            "~"};
    std::string rib = kSafeHead;
    for (const std::string& path : paths) {
        rib += "FrameBegin 1\nOption \"searchpath\" \"string archive\" [\"&:" + path +
               ":@\"] \"string shader\" [\"" + path + "\"]\n";
        rib += "WorldBegin\nSurface \"leak\"\nReadArchive \"leak.rib\"\nSphere 1 -1 1 360\nWorldEnd\n";
        rib += "FrameEnd\n";
    }
    EXPECT_TRUE(holds_text(render(rib, "").err, std::to_string(paths.size()) + " times: LeakedSecret"));
    const Outcome run = render(rib);
    EXPECT_FALSE(holds_text(run.err, "LeakedSecret")) << run.err;
    for (const std::string& path : paths)
        EXPECT_TRUE(holds_text(run.err, "the folder " + quoted(path) + " lies outside")) << path << run.err;
    EXPECT_TRUE(holds_text(run.err, "\"leak.rib\" is not found")) << run.err;
}

TEST_F(Safe, FoldersAboveAndBesideAreNotLookedThrough) {
    fs::create_directories(work_ / "job/scenes");
    fs::create_directories(work_ / "job/archives");
    work_.write("job/scenes/b.rib", kSafeHead +
                                        "WorldBegin\nReadArchive \"archives/leak.rib\"\nSurface \"leak\"\n"
                                        "Sphere 1 -1 1 360\nWorldEnd\n");
    work_.write("job/archives/leak.rib", kSecret);
    work_.write("job/leak.sl", kSecret);
    const auto run = [&](const std::string& options) {
        const std::string command = "cd '" + work_.path().string() +
                                    "/job/scenes' && '" TRAPEZE_PROGRAM "' render b.rib -t 1 " + options +
                                    " >/dev/null 2>.stderr";
        static_cast<void>(!std::system(command.c_str()));
        return file_text(work_ / "job/scenes/.stderr");
    };
    EXPECT_EQ(count_of(run(""), "LeakedSecret"), 3u);
    EXPECT_FALSE(holds_text(run("--safe"), "LeakedSecret")) << run("--safe");
}

TEST_F(Safe, MembersOfZipArchivesOutsideAreClosed) {
    // A member that is stored: local header, bytes, directory, end (APPNOTE.TXT).
    const std::string name = "leak.rib", bytes = kSecret;
    const auto number = [](uint32_t value, int count) {
        std::string text;
        for (int i = 0; i < count; ++i) text += static_cast<char>(value >> 8 * i & 0xff);
        return text;
    };
    const auto size = static_cast<uint32_t>(bytes.size()), length = static_cast<uint32_t>(name.size());
    const std::string about = number(size, 4) + number(size, 4) + number(length, 2) + number(0, 2);
    const std::string local =
        number(0x04034b50, 4) + number(10, 2) + std::string(12, '\0') + about + name + bytes;
    const std::string central =
        number(0x02014b50, 4) + number(10, 4) + std::string(12, '\0') + about + std::string(14, '\0') + name;
    outside_.write("leak.zip", local + central + number(0x06054b50, 4) + number(0, 4) + number(1, 2) +
                                   number(1, 2) + number(static_cast<uint32_t>(central.size()), 4) +
                                   number(static_cast<uint32_t>(local.size()), 4) + number(0, 2));
    link(out("leak.zip"), "link.zip");
    const std::vector<std::string> names = {out("leak.zip") + "!leak.rib", "link.zip!leak.rib"};
    std::string rib = kSafeHead + "WorldBegin\n";
    for (const std::string& archive : names) rib += "ReadArchive " + quoted(archive) + "\n";
    rib += "Sphere 1 -1 1 360\nWorldEnd\n";
    const Outcome open = render(rib, "");
    EXPECT_EQ(count_of(open.err, "error: LeakedSecret"), 1u) << open.err;
    expect_closed(rib, names);
}

TEST_F(Safe, ShadersAndWhatTheyIncludeLieInside) {
    outside_.write("leak.sl", kSecret);
    outside_.write("leak.h", kSecret);
    link(out("leak.sl"), "file.sl");
    link(outside_.path().string(), "folder");
    const std::vector<std::string> headers = {out("leak.h"), out_from_here("leak.h"), "folder/leak.h"};
    std::string rib = kSafeHead + "WorldBegin\n";
    for (size_t i = 0; i < headers.size(); ++i) {
        const std::string shader = "s" + std::to_string(i);
        work_.write(shader + ".sl",
                    "#include " + quoted(headers[i]) + "\nsurface " + shader + "() { Ci = 1; }\n");
        rib += "Surface " + quoted(shader) + "\nSphere 1 -1 1 360\n";
    }
    const std::vector<std::string> shaders = {out("leak"), out_from_here("leak"), "folder/leak",
                                              out("leak.slo")};
    for (const std::string& shader : shaders) rib += "Surface " + quoted(shader) + "\nSphere 1 -1 1 360\n";
    rib += "Surface \"file\"\nSphere 1 -1 1 360\nWorldEnd\n";
    EXPECT_GT(count_of(render(rib, "").err, "LeakedSecret"), 4u);
    expect_closed(rib, headers);
    expect_closed(rib, shaders);
}

TEST_F(Safe, MapsLieInsideWhateverComputesTheirNames) {
    // A picture to be found: the program's own.
    ASSERT_EQ(
        render(kSafeHead + "Display " + quoted(out("map.exr")) + " \"exr\" \"rgb\"\n" + kWorld, "").exit_code,
        0);
    ASSERT_TRUE(fs::exists(outside_ / "map.exr"));
    link(out("map.exr"), "link.exr");
    work_.write("maps.sl",
                "surface maps(string folder = \"\") {\n"
                "  string name = concat(folder, \"/\", \"map.exr\");\n"
                "  Ci = texture(name) + environment(name, N) + shadow(name, P) + texture(\"link.exr\");\n"
                "  float there = 0; textureinfo(name, \"exists\", there);\n}\n");
    const std::string rib = kSafeHead + "WorldBegin\nSurface \"maps\" \"string folder\" [\"" +
                            outside_.path().string() + "\"]\nSphere 1 -1 1 360\nWorldEnd\n";
    EXPECT_FALSE(holds_text(render(rib, "").err, "lies outside"));
    const Outcome run = render(rib);
    EXPECT_TRUE(holds_text(run.err, "texture " + quoted(out("map.exr")) + ": lies outside")) << run.err;
    EXPECT_TRUE(holds_text(run.err, "texture \"link.exr\": lies outside")) << run.err;
    EXPECT_EQ(run.exit_code, 1);
}

TEST_F(Safe, MapsAreOfFormatsThatPicturesAreMostlyIn) {
    work_.write("film.mp4",
                "\0\0\0\x18"
                "ftypmp42 and so on, for longer than any header");
    const Outcome run =
        render(kSafeHead +
               "WorldBegin\nSurface \"paintedplastic\" \"string texturename\" [\"film.mp4\"]\n"
               "Sphere 1 -1 1 360\nWorldEnd\n");
    EXPECT_TRUE(holds_text(run.err, "texture \"film.mp4\": is of a format that is not open to scenes"))
        << run.err;
}

TEST_F(Safe, PicturesAreWrittenInside) {
    outside_.write("old.exr", "old");
    work_.write("notes.txt", "mine");
    link(out("old.exr"), "link.exr");
    link(out("none.exr"), "dangling.exr");
    link(outside_.path().string(), "folder");
    fs::create_directory(work_ / "sub");
    const std::vector<std::string> names = {out("new.exr"),   out_from_here("new.exr"),
                                            "folder/new.exr", "link.exr",
                                            "dangling.exr",   "sub/../" + out_from_here("other.exr")};
    std::string rib = kSafeHead;
    for (size_t i = 0; i < names.size(); ++i)
        rib += "Display \"" + std::string(i ? "+" : "") + names[i] + "\" \"exr\" \"rgba\"\n";
    rib += "Display \"+" + out("depth.tif") + "\" \"zfile\" \"z\"\nDisplay \"+notes.txt\" \"exr\" \"rgba\"\n";
    // No folder is made elsewhere: what belongs there goes into the working folder.
    rib += "Display \"+folder/made/here.exr\" \"exr\" \"rgba\"\n";
    rib += "Display \"+good/new.exr\" \"exr\" \"rgba\"\n" + kWorld;
    const Outcome run = render(rib);
    for (const std::string& name : names)
        EXPECT_TRUE(holds_text(run.err, "cannot write " + quoted(name) + ": it lies outside"))
            << name << run.err;
    EXPECT_TRUE(holds_text(run.err, "cannot write " + quoted(out("depth.tif")) + ": it lies outside"))
        << run.err;
    EXPECT_TRUE(holds_text(run.err, "cannot write \"notes.txt\": the file that is there is not a picture"))
        << run.err;
    EXPECT_EQ(run.exit_code, 6);
    EXPECT_EQ(files_in(outside_), "old.exr ");
    EXPECT_EQ(file_text(outside_ / "old.exr"), "old");
    EXPECT_EQ(file_text(work_ / "notes.txt"), "mine");
    EXPECT_TRUE(fs::exists(work_ / "good/new.exr"));
    EXPECT_TRUE(fs::exists(work_ / "here.exr"));
}

TEST_F(Safe, MapsAreMadeInside) {
    ASSERT_EQ(render(kSafeHead + "Display \"in.exr\" \"exr\" \"rgb\"\n" + kWorld, "").exit_code, 0);
    fs::copy(work_ / "in.exr", outside_ / "out.exr");
    link(outside_.path().string(), "folder");
    work_.write("notes.tex", "mine");
    const std::vector<std::string> maps = {out("a.tex"), out_from_here("a.tex"), "folder/a.tex", "notes.tex"};
    std::string rib = kSafeHead;
    for (const std::string& map : maps)
        rib += "MakeTexture \"in.exr\" " + quoted(map) + " \"periodic\" \"periodic\" \"box\" 1 1\n";
    rib += "MakeLatLongEnvironment \"in.exr\" " + quoted(out("b.env")) + " \"box\" 1 1\n";
    rib += "MakeShadow \"in.exr\" " + quoted(out("c.shd")) + "\n";
    rib +=
        "MakeTexture " + quoted(out("out.exr")) + " \"stolen.tex\" \"periodic\" \"periodic\" \"box\" 1 1\n";
    rib += "MakeTexture \"in.exr\" \"good.tex\" \"periodic\" \"periodic\" \"box\" 1 1\n" + kWorld;
    const Outcome run = render(rib);
    for (const std::string& map : {maps[0], maps[1], maps[2], out("b.env"), out("c.shd")})
        EXPECT_TRUE(holds_text(run.err, "cannot make " + quoted(map) + " from \"in.exr\": it lies outside"))
            << map << run.err;
    EXPECT_TRUE(holds_text(
        run.err, "cannot make \"notes.tex\" from \"in.exr\": the file that is there is not a picture"))
        << run.err;
    EXPECT_TRUE(holds_text(run.err, "cannot make \"stolen.tex\"")) << run.err;
    EXPECT_EQ(files_in(outside_), "out.exr ");
    EXPECT_EQ(file_text(work_ / "notes.tex"), "mine");
    EXPECT_FALSE(fs::exists(work_ / "stolen.tex"));
    EXPECT_TRUE(fs::exists(work_ / "good.tex"));
}

TEST_F(Safe, NothingIsRun) {
    work_.write("run.sh", "touch ran; printf '\\377'");
    work_.write("lib.so", "no library");
    const std::string rib = kSafeHead +
                            "WorldBegin\nProcedural \"RunProgram\" [\"sh run.sh\" \"\"] [-1 1 -1 1 -1 1]\n"
                            "Procedural \"DynamicLoad\" [\"./lib.so\" \"\"] [-1 1 -1 1 -1 1]\n"
                            "System \"touch ran\"\nSphere 1 -1 1 360\nWorldEnd\n";
    const Outcome run = render(rib);
    EXPECT_TRUE(holds_text(run.err, "programs are not run (--safe)")) << run.err;
    EXPECT_FALSE(fs::exists(work_ / "ran"));
    EXPECT_EQ(render(rib, "--safe --allow-programs").exit_code, 2);
    EXPECT_FALSE(fs::exists(work_ / "ran"));
    render(rib, "--allow-programs");
    EXPECT_TRUE(fs::exists(work_ / "ran"));
}

TEST_F(Safe, TheEnvironmentAsksForItToo) {
    outside_.write("leak.rib", kSecret);
    const std::string rib =
        kSafeHead + "WorldBegin\nReadArchive " + quoted(out("leak.rib")) +
        "\nIfBegin \"$LEAK == 'yes'\"\nLeakedSecret\nIfEnd\nSphere 1 -1 1 360\nWorldEnd\n";
    setenv("LEAK", "yes", 1);
    EXPECT_EQ(count_of(render(rib, "").err, "error: LeakedSecret"), 1u);
    setenv("TRAPEZE_SAFE", "1", 1);
    EXPECT_FALSE(holds_text(render(rib, "").err, "LeakedSecret"));
    EXPECT_EQ(render(rib, "--allow-programs").exit_code, 2);
    for (const char* command : {"check", "info", "cat"})
        EXPECT_FALSE(holds_text(run_program(work_, std::string(command) + " a.rib").err, "LeakedSecret"))
            << command;
    setenv("TRAPEZE_SAFE", "0", 1);
    EXPECT_TRUE(holds_text(render(rib, "").err, "LeakedSecret"));
    unsetenv("TRAPEZE_SAFE");
    // Conditions know nothing of the environment.
    work_.write("b.rib", "IfBegin \"$LEAK == 'yes'\"\nLeakedSecret\nIfEnd\n" + kWorld);
    EXPECT_TRUE(holds_text(run_program(work_, "check b.rib").err, "LeakedSecret"));
    EXPECT_FALSE(holds_text(run_program(work_, "check --safe b.rib").err, "LeakedSecret"));
}

TEST_F(Safe, WhatTheUserSaysIsOpen) {
    fs::create_directories(work_ / "scene");
    fs::create_directories(work_ / ".config/trapeze");
    outside_.write("part.rib", "Surface \"own\"\nSphere 1 -1 1 360\n");
    outside_.write("own.sl", "surface own() { Ci = 1; }\n");
    outside_.write("b.rib", kSafeHead + "WorldBegin\nReadArchive \"part.rib\"\nWorldEnd\n");
    const auto expect_good = [&](const std::string& arguments, const std::string& picture) {
        const Outcome run = run_program(work_, arguments);
        EXPECT_EQ(run.exit_code, 0) << arguments << "\n" << run.err;
        EXPECT_TRUE(fs::exists(picture)) << arguments << "\n" << run.err;
        fs::remove(picture);
    };
    // The scene's folder, -o, folders searched by --option and by the user's defaults.
    expect_good("render --safe -t 1 " + out("b.rib"), (work_ / "b.exr").string());
    expect_good("render --safe -t 1 " + out("b.rib") + " -o " + out("new.exr"), out("new.exr"));
    work_.write("scene/c.rib", kSafeHead + "WorldBegin\nReadArchive \"part.rib\"\nWorldEnd\n");
    const std::string path = "Option 'searchpath' 'string archive' ['" + outside_.path().string() +
                             "'] 'string shader' ['" + outside_.path().string() + "']\n";
    std::string rib = path;
    std::replace(rib.begin(), rib.end(), '\'', '"');
    work_.write(".config/trapeze/trapeze.rib", rib);
    expect_good("render --safe -t 1 scene/c.rib", (work_ / "c.exr").string());
    fs::remove(work_ / ".config/trapeze/trapeze.rib");
    EXPECT_NE(run_program(work_, "render --safe -t 1 scene/c.rib").exit_code, 0);
}

/// Without --safe.
TEST(Outside, FilesThatAreNoPicturesStay) {
    WorkFolder work, outside;
    outside.write("notes.txt", "mine");
    const auto display = [&](const std::string& name) {
        work.write("a.rib",
                   kSafeHead + "Display \"" + (outside / name).string() + "\" \"exr\" \"rgba\"\n" + kWorld);
        return run_program(work, "render a.rib -t 1");
    };
    const Outcome refused = display("notes.txt");
    EXPECT_EQ(refused.exit_code, 6) << refused.err;
    EXPECT_TRUE(holds_text(refused.err, "the file that is there is not a picture")) << refused.err;
    EXPECT_EQ(file_text(outside / "notes.txt"), "mine");
    for (int i = 0; i < 2; ++i) {
        const Outcome written = display("new.exr");
        EXPECT_EQ(written.exit_code, 0) << written.err;
        EXPECT_TRUE(holds_text(written.err, "lies outside of the working folder")) << written.err;
    }
    // What the user names is written, wherever and whatever it was.
    const Outcome ordered = run_program(work, "render a.rib -t 1 -o " + (outside / "notes.txt").string());
    EXPECT_EQ(ordered.exit_code, 0) << ordered.err;
    EXPECT_FALSE(holds_text(ordered.err, "lies outside")) << ordered.err;
    EXPECT_NE(file_text(outside / "notes.txt"), "mine");
}

}  // namespace
}  // namespace trapeze::testing
