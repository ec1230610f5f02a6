/// The program from outside: colour management, asked for and not.
#include <cstdlib>

#include "composite/colors/small_config_harness.h"
#include "tests/command_line/command_line_harness.h"

namespace trapeze::testing {
namespace {

/// A flat square that fills the picture.
constexpr const char* kFlat = R"(Format 8 8 1
PixelSamples 1 1
PixelFilter "box" 1 1
Display "flat.exr" "openexr" "rgb"
Display "+flat.png" "png" "rgb" "float dither" [0]
WorldBegin
Surface "constant"
Color [.5 .25 1]
Translate 0 0 2
Polygon "P" [-9 -9 0  9 -9 0  9 9 0  -9 9 0]
WorldEnd
)";

class ColorsAsked : public ::testing::Test {
  protected:
    void SetUp() override {
        unsetenv("OCIO");
        setenv("SOURCE_DATE_EPOCH", "0", 1);  // the same bytes each time
        folder_.write("flat.rib", kFlat);
        folder_.write("small.ocio", kSmallConfig);
    }
    void TearDown() override { unsetenv("SOURCE_DATE_EPOCH"); }

    /// Renders without an error; the PNG's bytes.
    std::string png(const std::string& arguments) {
        said_ = run_program(folder_, "render flat.rib " + arguments);
        EXPECT_EQ(said_.exit_code, 0) << arguments << ": " << said_.err;
        return file_text(folder_ / "flat.png");
    }
    /// What is said where nothing is rendered.
    std::string refused(const std::string& arguments, int exit_code = 3) {
        fs::remove(folder_ / "flat.exr"), fs::remove(folder_ / "flat.png");
        said_ = run_program(folder_, "render " + arguments);
        EXPECT_EQ(said_.exit_code, exit_code) << arguments;
        EXPECT_FALSE(fs::exists(folder_ / "flat.exr") || fs::exists(folder_ / "flat.png")) << arguments;
        return said_.err;
    }
    /// The scene with an Option before it.
    void ask(const std::string& parameters) {
        folder_.write("flat.rib", "Option \"ocio\" " + parameters + "\n" + kFlat);
    }

    WorkFolder folder_;
    Outcome said_;
};

TEST_F(ColorsAsked, ByNobodyAreAsTheyWere) {
    const std::string before = png("");
    EXPECT_EQ(said_.err, "");
    EXPECT_NE(before.find("transfer: linear"), std::string::npos);
    const SetVariable ocio("OCIO", "small.ocio");
    folder_.write("flat.rib",
                  std::string(kFlat) + "Display \"none\" \"null\" \"rgb\"\nWorldBegin\nWorldEnd\n");
    EXPECT_EQ(png(""), before);
    const size_t said =
        said_.err.find("note: $OCIO names \"small.ocio\", which changes no colours by itself");
    ASSERT_NE(said, std::string::npos) << said_.err;
    EXPECT_EQ(said_.err.find("$OCIO", said + 8), std::string::npos) << "more than once: " << said_.err;
    EXPECT_EQ(run_program(folder_, "render flat.rib --safe").err, "") << "the environment is not looked at";
}

TEST_F(ColorsAsked, ComeFromTheCommandLineThenTheSceneThenTheEnvironment) {
    const std::string raw = png(""), mixed = png("--ocio small.ocio");
    EXPECT_NE(mixed.find("workingSpace: work; display: screen; view: mixed"), std::string::npos);
    EXPECT_NE(png("--view sRGB").find("workingSpace: Linear Rec.709; display: sRGB; view: sRGB"),
              std::string::npos);
    {
        const SetVariable ocio("OCIO", "small.ocio");
        EXPECT_EQ(png("--view mixed"), mixed);
        EXPECT_EQ(said_.err, "");
        EXPECT_EQ(png("--display screen"), mixed);
    }
    ask("\"string config\" \"small.ocio\"");
    EXPECT_EQ(png(""), mixed);
    ask("\"config\" \"small.ocio\" \"view\" \"plain\" \"workingspace\" \"painted\"");
    EXPECT_NE(png("").find("workingSpace: paint; display: screen; view: plain"), std::string::npos);
    {
        const SetVariable ocio("OCIO", "nowhere.ocio");
        EXPECT_NE(png("").find("view: plain"), std::string::npos);
        EXPECT_EQ(png("--ocio small.ocio"), mixed);
    }
    EXPECT_NE(png("--look double").find("view: plain; look: double"), std::string::npos);
    EXPECT_NE(png("--display projector").find("display: Projector; view: dark"), std::string::npos);
    EXPECT_NE(raw, mixed);
}

TEST_F(ColorsAsked, OfAConfigBesideTheSceneAreFound) {
    fs::create_directories(folder_ / "shot");
    fs::rename(folder_ / "small.ocio", folder_ / "shot/beside.ocio");
    folder_.write("shot/a.rib", std::string("Option \"ocio\" \"config\" \"beside.ocio\"\n") + kFlat);
    const Outcome outcome = run_program(folder_, "render shot/a.rib");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_NE(file_text(folder_ / "flat.png").find("view: mixed"), std::string::npos);
}

TEST_F(ColorsAsked, AreForAPictureThatTheCommandLineNames) {
    folder_.write("flat.rib", "Display \"a.exr\" \"openexr\" \"rgb\"\n" +
                                  std::string(kFlat).substr(std::string(kFlat).find("WorldBegin")));
    const Outcome outcome = run_program(folder_, "render flat.rib --view sRGB -o x.png");
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_EQ(outcome.err, "") << "the picture has a view, and is not encoded for viewing";
    EXPECT_NE(file_text(folder_ / "x.png").find("view: sRGB"), std::string::npos);
}

TEST_F(ColorsAsked, InVainAreErrorsBeforeAnythingIsRendered) {
    EXPECT_NE(
        refused("flat.rib --ocio lost.ocio").find("error: OpenColorIO, config \"lost.ocio\": is not found"),
        std::string::npos)
        << said_.err;
    EXPECT_NE(refused("flat.rib --ocio .").find("config \".\": is no file"), std::string::npos) << said_.err;
    EXPECT_NE(refused("flat.rib --ocio flat.rib").find("error: OpenColorIO, config \"flat.rib\": "),
              std::string::npos);
    EXPECT_NE(refused("flat.rib --ocio ocio://default")
                  .find("config \"ocio://default\": names a config inside OpenColorIO"),
              std::string::npos)
        << said_.err;
    EXPECT_NE(refused("flat.rib --ocio small.ocio --display tv")
                  .find("config \"small.ocio\": no display \"tv\"; there is \"screen\", \"Projector\""),
              std::string::npos)
        << said_.err;
    EXPECT_NE(
        refused("flat.rib --ocio small.ocio --view dark").find("no view of display \"screen\" \"dark\""),
        std::string::npos)
        << said_.err;
    EXPECT_NE(
        refused("flat.rib --view dark")
            .find("the built-in config: no view of display \"sRGB\" \"dark\"; there is \"sRGB\", \"Raw\""),
        std::string::npos)
        << said_.err;
    const SetVariable ocio("OCIO", "nowhere.ocio");
    EXPECT_NE(refused("flat.rib --view dark").find("config \"nowhere.ocio\" ($OCIO): is not found"),
              std::string::npos)
        << said_.err;
}

TEST_F(ColorsAsked, InVainByTheSceneAreErrorsBeforeAnythingIsRendered) {
    ask("\"config\" \"small.ocio\" \"look\" \"half\"");
    EXPECT_NE(refused("flat.rib")
                  .find("flat.rib:1:1: error: OpenColorIO, config \"small.ocio\": no look "
                        "\"half\"; there is \"double\""),
              std::string::npos)
        << said_.err;
    EXPECT_TRUE(refused("flat.rib --look third").starts_with("error: OpenColorIO, ")) << said_.err;
    EXPECT_NE(run_program(folder_, "check flat.rib").err.find("no look \"half\""), std::string::npos);
    ask("\"config\" \"small.ocio\" \"workingspace\" \"acescg\"");
    EXPECT_NE(refused("flat.rib").find("no colour space \"acescg\"; there is \"work\", \"raw\""),
              std::string::npos)
        << said_.err;
    ask("\"config\" \"ocio://default\"");
    EXPECT_NE(refused("flat.rib").find("config \"ocio://default\": names a config inside"), std::string::npos)
        << said_.err;
    ask("\"config\" \"small.ocio\"");
    EXPECT_NE(refused("flat.rib --safe").find("config \"small.ocio\": is not open to scenes (--safe)"),
              std::string::npos)
        << said_.err;
    EXPECT_NE(png("--safe --ocio small.ocio").find("view: mixed"), std::string::npos);
    ask("\"float config\" 1");
    EXPECT_EQ(run_program(folder_, "render flat.rib").exit_code, 1);
    EXPECT_NE(run_program(folder_, "render flat.rib")
                  .err.find("flat.rib:1:1: error: Option: \"config\" of \"ocio\" is a string"),
              std::string::npos)
        << run_program(folder_, "render flat.rib").err;
}

TEST_F(ColorsAsked, AreThoseOfTextures) {
    // The config's "paint" holds square roots; a file called *_paint.* is in it. A quarter is 64.
    ASSERT_EQ(run_program(folder_, "render flat.rib --option 'Exposure 1 1' -o quarter.png").exit_code, 0);
    ASSERT_TRUE(fs::exists(folder_ / "quarter.png"));
    fs::rename(folder_ / "quarter.png", folder_ / "quarter_paint.png");
    folder_.write("look.sl",
                  "surface look(string name = \"\"; string space = \"\") { Ci = color texture(name, .5, .5, "
                  "\"colorspace\", space); Oi = 1; }");
    const auto look = [&](const std::string& space, const std::string& options) {
        std::string scene = kFlat;
        scene.replace(
            scene.find("Surface \"constant\""), 18,
            "Surface \"look\" \"string name\" \"quarter_paint.png\" \"string space\" \"" + space + "\"");
        folder_.write("flat.rib", scene);
        return png(options);
    };
    const std::string plain = look("", "--transfer linear --view Raw");
    EXPECT_EQ(said_.err, "");
    EXPECT_NE(look("", "--ocio small.ocio --view plain"), look("linear", "--ocio small.ocio --view plain"));
    EXPECT_EQ(look("paint", "--ocio small.ocio --view plain"), look("", "--ocio small.ocio --view plain"));
    EXPECT_EQ(look("srgb", "--view Raw"), look("sRGB", "--view Raw"));
    look("acescg", "--view Raw");
    EXPECT_NE(said_.err.find("there are \"Linear Rec.709\", \"sRGB\", \"Raw\", and \"linear\""),
              std::string::npos)
        << said_.err;
}

TEST_F(ColorsAsked, GiveTheSameBytesForAnyNumberOfThreads) {
    const std::string one = png("--ocio small.ocio --view brighter -t 1");
    EXPECT_EQ(png("--ocio small.ocio --view brighter -t 7"), one);
}

}  // namespace
}  // namespace trapeze::testing
