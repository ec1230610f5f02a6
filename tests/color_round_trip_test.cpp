/// Option "color" "transfer" from outside: a file that is written and read back gives the same light, in 8
/// and 16 bits; and what `-o` makes of floats.
#include <OpenImageIO/imagebuf.h>

#include <cmath>

#include "tests/command_line/command_line_harness.h"

namespace trapeze::testing {
namespace {

float red_of(const fs::path& path) {
    OIIO::ImageBuf image(path.string());
    EXPECT_TRUE(image.read(0, 0, true, OIIO::TypeDesc::FLOAT)) << path << image.geterror();
    return image.getchannel(image.spec().width / 2, image.spec().height / 2, 0, 0);
}

float encoded(float linear) {
    return 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

/// An even surface of 1/4; where a picture is named, of what it shows.
std::string frame(const std::string& display, const std::string& picture = {}) {
    return "FrameBegin 1\n" + display +
           "\nFormat 16 16 1\nPixelSamples 1 1\nPixelFilter \"box\" 1 1\nProjection \"orthographic\"\n"
           "WorldBegin\nColor [.25 .25 .25]\nSurface \"" +
           (picture.empty() ? "constant\"" : "look\" \"string picture\" [\"" + picture + "\"]") +
           "\nPolygon \"P\" [-2 -2 1  2 -2 1  2 2 1  -2 2 1]\nWorldEnd\nFrameEnd\n";
}

constexpr const char* kSeenDisplay =
    "Display \"seen.exr\" \"openexr\" \"rgb\" \"string exrpixeltype\" [\"float\"]";
constexpr const char* kLook =
    "surface look(string picture = \"\";) { Ci = color texture(picture, 0.5, 0.5); Oi = 1; }";

struct RoundTrip {
    const char* transfer;
    const char* extension;
    int bits;
    bool is_encoded;
};

class RoundTrips : public ::testing::TestWithParam<RoundTrip> {};

TEST_P(RoundTrips, AQuarterIsAQuarter) {
    const RoundTrip& p = GetParam();
    const std::string file = std::string("kept.") + p.extension;
    const int one = (1 << p.bits) - 1;
    WorkFolder folder;
    folder.write("look.sl", kLook);
    folder.write("a.rib", std::string("Option \"color\" \"transfer\" [\"") + p.transfer + "\"]\n" +
                              frame("Display \"" + file + "\" \"file\" \"rgb\" \"quantize\" [0 " +
                                    std::to_string(one) + " 0 " + std::to_string(one) + "] \"dither\" [0]") +
                              "MakeTexture \"" + file + "\" \"kept.tex\" \"clamp\" \"clamp\" \"box\" 1 1\n" +
                              frame(kSeenDisplay, file) +
                              frame("Display \"made.exr\" \"openexr\" \"rgb\"", "kept.tex"));
    const Outcome outcome = run_program(folder, "render a.rib");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    const float step = 1.0f / static_cast<float>(one);
    EXPECT_NEAR(red_of(folder / file), p.is_encoded ? encoded(0.25f) : 0.25f, step);
    EXPECT_NEAR(red_of(folder / "seen.exr"), 0.25f, step);
    EXPECT_NEAR(red_of(folder / "made.exr"), 0.25f, std::max(step, 1e-3f));
}

INSTANTIATE_TEST_SUITE_P(
    All, RoundTrips,
    ::testing::Values(RoundTrip{"linear", "png", 8, false}, RoundTrip{"linear", "png", 16, false},
                      RoundTrip{"linear", "tif", 8, false}, RoundTrip{"linear", "tif", 16, false},
                      RoundTrip{"srgb", "png", 8, true}, RoundTrip{"srgb", "png", 16, true},
                      RoundTrip{"srgb", "tif", 8, true}, RoundTrip{"srgb", "tif", 16, true},
                      RoundTrip{"auto", "png", 8, true}, RoundTrip{"auto", "png", 16, false},
                      RoundTrip{"auto", "tif", 8, true}, RoundTrip{"auto", "tif", 16, false}),
    [](const auto& row) {
        return std::string(row.param.transfer) + "_" + row.param.extension + std::to_string(row.param.bits);
    });

/// Colours are not rounded to halves on the way to files that hold more: .7 of 65535 is 45875, of the nearest
/// half 45887.
TEST(Transfer, FilesHoldAllBitsOfColours) {
    const struct {
        const char *type, *options;
        int one;
    } files[] = {{"tiff", "\"quantize\" [0 65535 0 65535]", 65535},
                 {"png", "\"quantize\" [0 255 0 255]", 255}};
    constexpr int kTenths[] = {1, 3, 5, 7, 9};
    const auto name_of = [](const std::string& type, int tenths) {
        return "a" + std::to_string(tenths) + (type == "png" ? ".png" : ".tif");
    };
    // All pictures are frames of one scene: most of the time is the program's start.
    WorkFolder folder;
    std::string scene =
        "Format 16 16 1\nPixelSamples 1 1\nPixelFilter \"box\" 1 1\nProjection \"orthographic\"\n";
    for (const auto& [type, options, one] : files)
        for (const int tenths : kTenths) {
            const std::string text = "." + std::to_string(tenths), colors = text + ' ' + text + ' ' + text;
            scene +=
                "FrameBegin 1\nDisplay \"" + name_of(type, tenths) + "\" \"" + type + "\" \"rgba\" " +
                options + " \"dither\" [0]\nWorldBegin\nColor [" + colors + "]\nOpacity [" + colors +
                "]\nSurface \"constant\"\nPolygon \"P\" [-2 -2 1  2 -2 1  2 2 1  -2 2 1]\nWorldEnd\nFrameEnd\n";
        }
    folder.write("a.rib", scene);
    ASSERT_EQ(run_program(folder, "render a.rib").exit_code, 0);
    for (const auto& [type, options, one] : files)
        for (const int tenths : kTenths) {
            OIIO::ImageBuf image((folder / name_of(type, tenths)).string());
            ASSERT_TRUE(image.read(0, 0, true, OIIO::TypeDesc::FLOAT)) << name_of(type, tenths);
            const double alpha = image.getchannel(8, 8, 0, 3) * one;
            EXPECT_EQ(std::lround(alpha), (tenths * one + 5) / 10) << name_of(type, tenths);  // halves go up
        }
}

TEST(Transfer, TheCommandLineComesBeforeTheScene) {
    WorkFolder folder;
    folder.write("a.rib", "Option \"color\" \"transfer\" [\"srgb\"]\n" +
                              frame("Display \"a.png\" \"png\" \"rgb\" \"dither\" [0]"));
    ASSERT_EQ(run_program(folder, "render a.rib").exit_code, 0);
    EXPECT_NEAR(red_of(folder / "a.png"), encoded(0.25f), 0.003f);
    ASSERT_EQ(run_program(folder, "render a.rib --transfer linear").exit_code, 0);
    EXPECT_NEAR(red_of(folder / "a.png"), 0.25f, 0.003f);
    const Outcome wrong = run_program(folder, "render a.rib --transfer rec709");
    EXPECT_EQ(wrong.exit_code, 2) << wrong.err;
}

/// What a scene keeps in floats is encoded where the command line wants 8 bits of it, which is said; what it
/// asks for in whole numbers is what it asks for.
TEST(Transfer, FloatsBecomeEightBitsForViewing) {
    WorkFolder folder;
    const struct {
        const char *display, *more;
        bool is_encoded;
    } cases[] = {{"Display \"a.exr\" \"openexr\" \"rgb\"", "", true},
                 {"Display \"a.tif\" \"framebuffer\" \"rgb\"", "", true},
                 {"Display \"a.tif\" \"tiff\" \"rgb\"", "", false},
                 {"Display \"a.exr\" \"file\" \"rgb\" \"quantize\" [0 255 0 255]", "", false},
                 {"Display \"a.exr\" \"openexr\" \"rgb\"\nQuantize \"rgba\" 255 0 255 .5", "", false},
                 {"Display \"a.exr\" \"openexr\" \"rgb\"\nExposure 1 2", "", false},
                 {"Display \"a.exr\" \"openexr\" \"rgb\"", " --transfer linear", false}};
    for (const auto& c : cases) {
        folder.write("a.rib", frame(c.display));
        for (const char* file : {"x.png", "x.tif"}) {
            const Outcome outcome = run_program(folder, std::string("render a.rib -o ") + file + c.more);
            ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
            const bool has_gamma = std::string(c.display).find("Exposure") != std::string::npos;
            EXPECT_NEAR(red_of(folder / file),
                        c.is_encoded ? encoded(0.25f)
                        : has_gamma  ? 0.5f
                                     : 0.25f,
                        0.006f)
                << c.display << c.more;
            EXPECT_EQ(outcome.err.find("is for viewing") != std::string::npos, c.is_encoded) << outcome.err;
        }
    }
    const Outcome plain = run_program(folder, "render a.rib -o x.exr");
    EXPECT_EQ(plain.err, "");
}

/// A pass that `-o` makes a file of 8 bits of is still the light that it was.
TEST(Transfer, MapsOfEncodedPassesAreDecoded) {
    WorkFolder folder;
    folder.write("look.sl", kLook);
    for (const char* request : {"MakeTexture", "MakeBump"}) {
        folder.write("a.rib", frame("Display \"pass.exr\" \"openexr\" \"rgb\"") + request +
                                  " \"pass.exr\" \"pass.tex\" \"clamp\" \"clamp\" \"box\" 1 1\n" +
                                  frame("Display \"seen.exr\" \"openexr\" \"rgb\"", "pass.tex"));
        const Outcome outcome = run_program(folder, "render a.rib -o out.png");
        ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
        EXPECT_NEAR(red_of(folder / "out.png"), encoded(0.25f), 0.006f) << request;
    }
}

/// A surface of light, brighter than 8 bits can say, and what is in its map.
std::string bright(const std::string& display) {
    std::string text = frame(display);
    return text.replace(text.find("[.25 .25 .25]"), 13, "[4 4 4]");
}

/// Maps are made of pictures as their own Displays have them, whatever `-o` says.
TEST(Transfer, MapsOfRenamedPassesHaveAllOfTheirLight) {
    const std::string make = "MakeTexture \"env.exr\" \"env.tex\" \"clamp\" \"clamp\" \"box\" 1 1\n",
                      pass = bright("Display \"env.exr\" \"exr\" \"rgba\""),
                      last = frame("Display \"out.exr\" \"exr\" \"rgba\"", "env.tex"),
                      between = frame("Display \"between.exr\" \"exr\" \"rgba\"");
    for (const char* flags : {"", " --safe", " -t 1"})
        for (const std::string& scene : {pass + make + last, pass + between + make + last}) {
            WorkFolder folder, temporary;
            folder.write("look.sl", kLook);
            folder.write("a.rib", scene);
            const bool two = scene.find("between") != std::string::npos;
            setenv("TMPDIR", temporary.path().c_str(), 1);
            const Outcome outcome =
                run_program(folder, std::string("render a.rib -o q.png --stats s.json") + flags);
            unsetenv("TMPDIR");
            ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
            EXPECT_NEAR(red_of(folder / "env.tex"), 4, 0.01f) << outcome.err;
            EXPECT_TRUE(fs::is_empty(temporary.path()));
            EXPECT_FALSE(fs::exists(folder / "env.exr")) << "nobody has asked for it";
            EXPECT_EQ(fs::exists(folder / "q.2.png"), two);
        }
}

/// A picture of a depth pass, too: `-o` has colours.
TEST(Transfer, DepthsOfRenamedPassesAreStillDepths) {
    WorkFolder folder;
    folder.write("a.rib",
                 frame("Display \"deep.exr\" \"exr\" \"z\"") + "MakeShadow \"deep.exr\" \"deep.shd\"\n");
    const Outcome outcome = run_program(folder, "render a.rib -o q.png");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_TRUE(fs::exists(folder / "deep.shd"));
}

/// A file that another display has written since then is the one that is meant.
TEST(Transfer, MapsAreOfTheLastPictureOfTheirName) {
    WorkFolder folder;
    folder.write("look.sl", kLook);
    folder.write("a.rib",
                 bright("Display \"env.exr\" \"exr\" \"rgba\"") +
                     frame("Display \"b.exr\" \"exr\" \"rgba\"\nDisplay \"+env.exr\" \"exr\" \"rgba\"") +
                     "MakeTexture \"env.exr\" \"env.tex\" \"clamp\" \"clamp\" \"box\" 1 1\n");
    const Outcome outcome = run_program(folder, "render a.rib -o q.png");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_NEAR(red_of(folder / "env.tex"), 0.25f, 0.01f);
}

}  // namespace
}  // namespace trapeze::testing
