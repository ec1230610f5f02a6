/// The program from outside: which shared libraries it loads for what, where it finds its modules, and the
/// program that it becomes to compare and measure.
#include <algorithm>
#include <vector>

#include "tests/command_line/command_line_harness.h"

namespace trapeze::testing {
namespace {

#ifdef TRAPEZE_HAS_MODULES
constexpr bool kHasModules = true;
#else
constexpr bool kHasModules = false;
#endif

/// A scene that looks up a texture.
constexpr const char* kTextured = R"(Format 32 24 1
Translate 0 0 5
WorldBegin
LightSource "ambientlight" 1
Surface "paintedplastic" "texturename" "sphere.tif"
Sphere 1 -1 1 360
WorldEnd
)";
/// More than the program needs by itself, fewer than any library of pictures brings.
constexpr size_t kMostLibraries = 30;

class Modules : public ::testing::Test {
  protected:
    void SetUp() override {
        if (!kHasModules) GTEST_SKIP() << "the modules are linked into the program";
        folder_.write("sphere.rib", kSphereScene);
        folder_.write("textured.rib", kTextured);
    }

    /// Names of the libraries that the program maps, from its start to its end, as the loader tells.
    std::vector<std::string> libraries_of(const std::string& arguments) {
        EXPECT_EQ(run_shell("rm -f loads.* && LD_DEBUG=files LD_DEBUG_OUTPUT=loads '" TRAPEZE_PROGRAM "' " +
                            arguments),
                  0)
            << errors();
        std::vector<std::string> names;
        for (const auto& entry : fs::directory_iterator(folder_.path())) {
            if (!entry.path().filename().string().starts_with("loads.")) continue;
            std::ifstream lines(entry.path());
            for (std::string line; std::getline(lines, line);)
                if (const size_t at = line.find("file=");
                    line.find("generating link map") != std::string::npos)
                    names.push_back(line.substr(at + 5, line.find(' ', at) - at - 5));
        }
        return names;
    }

    /// Puts the program alone into a folder, without what is built beside it.
    std::string copy_of_program(const std::string& place) const {
        fs::create_directories(folder_ / place);
        fs::copy_file(TRAPEZE_PROGRAM, folder_ / place / "trapeze");
        return (folder_ / place / "trapeze").string();
    }
    int run(const std::string& program, const std::string& arguments) const {
        return run_shell("'" + program + "' " + arguments);
    }
    std::string errors() const { return file_text(folder_ / ".stderr"); }

    /// Runs a command of the shell in the folder, with no settings but those in it.
    int run_shell(const std::string& command) const {
        const std::string folder = folder_.path().string();
        const std::string whole = "cd '" + folder + "' && export XDG_CONFIG_HOME='" + folder +
                                  "/.config' && " + command + " </dev/null >.stdout 2>.stderr";
        const int status = std::system(whole.c_str());
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }

    WorkFolder folder_;
};

bool has(const std::vector<std::string>& libraries, const std::string& part) {
    return std::any_of(libraries.begin(), libraries.end(),
                       [&](const std::string& name) { return name.find(part) != std::string::npos; });
}

TEST_F(Modules, AreNotLoadedForWhatNeedsNone) {
    ASSERT_EQ(run_program(folder_, "render sphere.rib -o sphere.tif").exit_code, 0);
    for (const char* arguments : {"--version", "check sphere.rib", "check textured.rib", "info sphere.rib",
                                  "cat sphere.rib", "render sphere.rib -q", "render textured.rib --help"}) {
        const std::vector<std::string> libraries = libraries_of(arguments);
        EXPECT_TRUE(has(libraries, "libstdc++")) << arguments << ": the loader tells nothing";
        EXPECT_LE(libraries.size(), kMostLibraries) << arguments;
        for (const char* heavy : {"libOpenImageIO", "libOpenColorIO", "libembree", "trapeze-"})
            EXPECT_FALSE(has(libraries, heavy)) << arguments << " loads " << heavy;
    }
}

TEST_F(Modules, AreLoadedForTexturesAndForPicturesThatAreNotOpenExr) {
    const std::vector<std::string> writing = libraries_of("render sphere.rib -q -o sphere.tif");
    EXPECT_TRUE(has(writing, "trapeze-displays.so"));
    EXPECT_FALSE(has(writing, "trapeze-maps.so"));
    const std::vector<std::string> reading = libraries_of("render textured.rib -q");
    EXPECT_TRUE(has(reading, "trapeze-maps.so"));
    EXPECT_FALSE(has(reading, "trapeze-displays.so"));
    EXPECT_TRUE(has(reading, "libOpenImageIO"));
    const std::vector<std::string> managed = libraries_of("render sphere.rib -q --view sRGB");
    EXPECT_TRUE(has(managed, "trapeze-colors.so"));
    EXPECT_TRUE(has(managed, "libOpenColorIO"));
    EXPECT_FALSE(has(managed, "libOpenImageIO"));
}

TEST_F(Modules, ThatAreMissingAreErrorsOfWhatNeedsThem) {
    const std::string alone = copy_of_program("alone");
    EXPECT_EQ(run(alone, "render sphere.rib"), 0) << errors();

    EXPECT_NE(run(alone, "render sphere.rib -o picture.tif"), 0);
    EXPECT_NE(errors().find("cannot write \"picture.tif\": trapeze-displays.so is not in \"" +
                            fs::path(alone).parent_path().string() + "\""),
              std::string::npos)
        << errors();

    EXPECT_EQ(run(alone, "render sphere.rib --view sRGB"), 3);
    EXPECT_NE(errors().find("OpenColorIO, the built-in config: trapeze-colors.so is not in"),
              std::string::npos)
        << errors();

    ASSERT_EQ(run_program(folder_, "render sphere.rib -o sphere.tif").exit_code, 0);
    EXPECT_EQ(run(alone, "render textured.rib"), 1);
    EXPECT_NE(errors().find("error: texture \"sphere.tif\": trapeze-maps.so is not in"), std::string::npos)
        << errors();
    EXPECT_TRUE(fs::exists(folder_ / "textured.exr"));

    folder_.write("make.rib", "MakeTexture \"sphere.tif\" \"sphere.tex\" \"clamp\" \"clamp\" \"box\" 1 1\n");
    EXPECT_NE(run(alone, "render make.rib"), 0);
    EXPECT_NE(errors().find("trapeze-maps.so is not in"), std::string::npos) << errors();
}

TEST_F(Modules, AreFoundInAnInstallWhereverItIs) {
    const std::string program = copy_of_program("install/bin");
    fs::create_directories(folder_ / "install/lib");
    fs::copy(fs::path(TRAPEZE_PROGRAM).parent_path().parent_path() / "lib/trapeze",
             folder_ / "install/lib/trapeze");
    fs::create_symlink(program, folder_ / "linked");
    for (const std::string& called : {program, std::string("install/bin/trapeze"), std::string("./linked")}) {
        EXPECT_EQ(run(called, "render sphere.rib -o picture.tif"), 0) << called << ": " << errors();
        EXPECT_TRUE(fs::remove(folder_ / "picture.tif")) << called;
    }
}

/// The program that the renderer becomes to compare and measure; it is there without modules, too.
class Laboratory : public Modules {
  protected:
    void SetUp() override { folder_.write("sphere.rib", kSphereScene); }
};

TEST_F(Laboratory, ThatIsMissingIsAnErrorOfItsCommandsAlone) {
    const std::string alone = copy_of_program("alone");
    for (const char* arguments : {"compare sphere.rib", "scene hair", "study growth"}) {
        EXPECT_EQ(run(alone, arguments), 70) << arguments;
        EXPECT_NE(errors().find("trapeze-laboratory is not beside the program"), std::string::npos)
            << errors();
    }
    // What is wrong is told first, and help needs no laboratory.
    EXPECT_EQ(run(alone, "scene magic"), 2);
    EXPECT_NE(errors().find("magic"), std::string::npos) << errors();
    for (const char* arguments : {"compare --help", "help study", "render sphere.rib"})
        EXPECT_EQ(run(alone, arguments), 0) << arguments << ": " << errors();
}

TEST_F(Laboratory, SaysOfOtherCommandsThatTheyAreNotIts) {
    const fs::path laboratory =
        fs::path(TRAPEZE_PROGRAM).parent_path().parent_path() / "lib/trapeze/trapeze-laboratory";
    EXPECT_EQ(run("timeout' 20 '" + laboratory.string(), "render sphere.rib"), 2) << errors();
    EXPECT_NE(errors().find("call trapeze"), std::string::npos) << errors();
}

TEST_F(Laboratory, ThatCannotBeRunIsTold) {
    const std::string alone = copy_of_program("alone");
    folder_.write("alone/trapeze-laboratory", "no program");
    EXPECT_EQ(run(alone, "scene hair"), 70);
    EXPECT_NE(errors().find("alone/trapeze-laboratory: "), std::string::npos) << errors();
}

TEST_F(Laboratory, IsFoundInAnInstallAndDoesWhatTheCommandSays) {
    const std::string program = copy_of_program("install/bin");
    fs::create_directories(folder_ / "install/lib");
    fs::copy(fs::path(TRAPEZE_PROGRAM).parent_path().parent_path() / "lib/trapeze",
             folder_ / "install/lib/trapeze");
    EXPECT_EQ(run(program, "scene falling --scale .001 -o falling.rib"), 0) << errors();
    EXPECT_EQ(run(program, "compare sphere.rib --samples 2x2 --repeat 1 --json figures.json"), 0) << errors();
    EXPECT_NE(file_text(folder_ / "figures.json").find("raytrace"), std::string::npos);
    EXPECT_EQ(run(program, "render falling.rib --resolution 32x18 -o falling.exr"), 0) << errors();
}

}  // namespace
}  // namespace trapeze::testing
