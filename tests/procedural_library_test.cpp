/// Procedural "DynamicLoad": libraries in C, compiled outside of this build, loaded by the program.
#include <OpenImageIO/imagebuf.h>

#include "tests/program_harness.h"

namespace trapeze::testing {
namespace {

const std::string kRow =
    "#include <ri.h>\n#include <stdio.h>\n#include <stdlib.h>\n"
    "RtPointer ConvertParameters(RtString s) { int *n = malloc(sizeof *n); *n = atoi(s); return n; }\n"
    "RtVoid Free(RtPointer p) { free(p); }\n"
    "RtVoid Subdivide(RtPointer p, RtFloat detail) {\n"
    "    RtColor red = {1, 0, 0};\n    int i;\n    (void)detail;\n    printf(\"hello\\n\");\n    "
    "RiColor(red);\n"
    "    for (i = 0; i < *(int *)p; ++i) { RiSphere(.3f, -.3f, .3f, 360, RI_NULL); RiTranslate(.7f, 0, 0); "
    "}\n"
    "}\n";

class ProceduralLibrary : public ::testing::Test {
  protected:
    void compile(const std::string& name, const std::string& source) {
        folder_.write(name + ".c", source);
        const std::string file = (folder_ / name).string();
        const std::string command = TRAPEZE_CC " -shared -fPIC '-I" TRAPEZE_SOURCE_DIR "/pipeline/ri' '" +
                                    file + ".c' -o '" + file + ".so'";
        ASSERT_EQ(std::system(command.c_str()), 0);
    }
    Outcome render(const std::string& world, const std::string& arguments = "--allow-programs") {
        folder_.write("a.rib",
                      "Display \"a.exr\" \"file\" \"rgba\" Format 64 48 1 Projection \"perspective\"\n"
                      "Translate -1 0 4 WorldBegin\n" +
                          world + "\nWorldEnd\n");
        return run_program(folder_, "render a.rib " + arguments);
    }
    std::vector<float> pixels() {
        OIIO::ImageBuf picture((folder_ / "a.exr").string());
        if (!picture.read(0, 0, true, OIIO::TypeDesc::FLOAT)) return {};
        std::vector<float> values(picture.spec().image_pixels() * static_cast<size_t>(picture.nchannels()));
        picture.get_pixels(OIIO::get_roi(picture.spec()), OIIO::TypeDesc::FLOAT, values.data());
        return values;
    }
    static std::string ask(const std::string& name, const std::string& data) {
        return "Procedural \"DynamicLoad\" [\"" + name + "\" \"" + data + "\"] [0 3 -1 1 -1 1]\n";
    }

    WorkFolder folder_;
};

/// The attributes that it sets end with its answer.
TEST_F(ProceduralLibrary, IsLoadedAndAskedForItsPieces) {
    compile("row", kRow);
    const Outcome outcome = render(ask("row", "3") + "Translate 0 1 0 " + ask("row.so", "1") +
                                   "Translate 1 0 0 Sphere .2 -.2 .2 360");
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_EQ(outcome.err, "hello\nhello\n");
    const std::vector<float> loaded = pixels();
    const std::string sphere = "Sphere .3 -.3 .3 360 ", next = "Translate .7 0 0 ";
    ASSERT_EQ(render("AttributeBegin Color 1 0 0 " + sphere + next + sphere + next + sphere +
                     "AttributeEnd Translate 0 1 0 AttributeBegin Color 1 0 0 " + sphere +
                     "AttributeEnd Translate 1 0 0 Sphere .2 -.2 .2 360")
                  .exit_code,
              0);
    EXPECT_FALSE(loaded.empty());
    EXPECT_TRUE(loaded == pixels());
}

TEST_F(ProceduralLibrary, IsLeftAloneUnlessAllowed) {
    compile("row", kRow);
    const Outcome outcome = render(ask("row", "3"), "");
    EXPECT_EQ(
        outcome.err,
        "a.rib:3:1: warning: Procedural: programs are run only where that is allowed (--allow-programs); "
        "skipped\n");
}

TEST_F(ProceduralLibrary, ThatFailsIsSaidAndTheRestIsRendered) {
    compile("short", "int Subdivide;\n");
    compile("crash", kRow + "__attribute__((constructor)) static void crash(void) { abort(); }\n");
    for (const std::string name : {"none", "short", "crash"}) {
        const Outcome outcome = render(ask(name, "1") + "Sphere 1 -1 1 360");
        EXPECT_EQ(outcome.exit_code, 1) << name;
        EXPECT_NE(outcome.err.find("a.rib:3:1: error: Procedural: the procedural \"" + name +
                                   "\" ended before its answer did"),
                  std::string::npos)
            << outcome.err;
        EXPECT_FALSE(pixels().empty());
    }
    EXPECT_NE(render(ask("short", "1")).err.find("there is no ConvertParameters()"), std::string::npos);
}

/// The example of the documentation, a level deep: what it calls comes back to its own function.
TEST_F(ProceduralLibrary, MayCallItself) {
    compile("branches", file_text(TRAPEZE_SOURCE_DIR "/docs/examples/branches.c"));
    const Outcome outcome = render(ask("branches", "2 0.7"), "--allow-programs --stats a.json -q");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    const std::string branches = "Cylinder .06 0 1 360 ";
    std::string three;
    for (const char* turn : {"50", "170", "290"})
        three += "TransformBegin Translate 0 0 1 Rotate " + std::string(turn) +
                 " 0 0 1 Rotate 38 0 1 0 Scale .7 .7 .7 Color .2 .6 .2 " + branches + "TransformEnd ";
    const std::vector<float> loaded = pixels();
    ASSERT_EQ(render("Color .5 .35 .2 " + branches + three).exit_code, 0);
    const std::vector<float> written = pixels();
    ASSERT_EQ(loaded.size(), written.size());
    // The numbers of a library come as floats.
    for (size_t i = 0; i < loaded.size(); ++i) EXPECT_NEAR(loaded[i], written[i], 0.02f) << i;
}

}  // namespace
}  // namespace trapeze::testing
