/// Configs of OpenColorIO as the renderer opens them.
#include "composite/colors/color_library.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <thread>
#include <vector>

#include "composite/colors/small_config_harness.h"

namespace trapeze {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::TemporaryFolder;
using testing::write_config;

struct Opened {
    std::shared_ptr<const ColorManagement> colors;
    std::string problem;
};

Opened open_colors_of(const ColorRequest& request) {
    Opened opened;
    const ColorLibrary* const library = color_library(&opened.problem);
    if (library) opened.colors = library->open(request, &opened.problem);
    return opened;
}

/// What the view makes of a colour.
std::array<float, 3> viewed(const ColorRequest& request, std::array<float, 3> color) {
    const Opened opened = open_colors_of(request);
    EXPECT_TRUE(opened.colors) << opened.problem;
    if (!opened.colors) return {};
    float pixel[4] = {color[0], color[1], color[2], 1};
    opened.colors->view().apply(pixel, 1);
    return {pixel[0], pixel[1], pixel[2]};
}

/// The problem with a small config of this text.
std::string problem_of_text(const std::string& text, ColorRequest request = {}) {
    const TemporaryFolder folder;
    request.config = write_config(folder, text);
    const Opened opened = open_colors_of(request);
    EXPECT_FALSE(opened.colors);
    EXPECT_THAT(opened.problem, Not(HasSubstr("\n")));
    return opened.problem;
}

double srgb_by_its_formula(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

TEST(BuiltInColors, AreTheSrgbCurve) {
    const Opened opened = open_colors_of({.view = "sRGB"});
    ASSERT_TRUE(opened.colors) << opened.problem;
    EXPECT_EQ(opened.colors->names().working_space, "Linear Rec.709");
    EXPECT_EQ(opened.colors->names().display, "sRGB");
    EXPECT_EQ(opened.colors->names().view, "sRGB");
    EXPECT_EQ(opened.colors->names().look, "");
    EXPECT_TRUE(opened.colors->view_is_srgb());
    for (int i = 0; i <= 4096; ++i) {
        const float linear = static_cast<float>(i) / 4096;
        float pixel[4] = {linear, linear / 2, linear / 16, 1};
        opened.colors->view().apply(pixel, 1);
        EXPECT_NEAR(pixel[0], srgb_by_its_formula(linear), 2e-5) << linear;
        EXPECT_NEAR(pixel[1], srgb_by_its_formula(linear / 2), 2e-5) << linear;
        EXPECT_NEAR(pixel[2], srgb_by_its_formula(linear / 16), 2e-5) << linear;
    }
}

TEST(BuiltInColors, HaveARawView) {
    const std::array<float, 3> color = {0.25f, 3, -1};
    EXPECT_EQ(viewed({.view = "Raw"}, color), color);
    EXPECT_FALSE(open_colors_of({.view = "Raw"}).colors->view_is_srgb());
    EXPECT_THAT(open_colors_of({.view = "Filmic"}).problem,
                HasSubstr("no view of display \"sRGB\" \"Filmic\"; there is \"sRGB\", \"Raw\""));
    EXPECT_THAT(open_colors_of({.look = "x"}).problem, HasSubstr("no look \"x\"; there is none"));
}

TEST(Colors, AreTheConfigs) {
    const TemporaryFolder folder;
    const std::string config = write_config(folder);
    constexpr std::array<float, 3> kColor = {0.5f, 0.25f, 1};
    const auto near = [](std::array<float, 3> is, double r, double g, double b) {
        EXPECT_NEAR(is[0], r, 1e-5);
        EXPECT_NEAR(is[1], g, 1e-5);
        EXPECT_NEAR(is[2], b, 1e-5);
    };
    // (.5/2 + .25/4, .25, 1/2) squared; twice the colours are four times that.
    near(viewed({.config = config}, kColor), 0.09765625, 0.0625, 0.25);
    near(viewed({.config = config, .view = "brighter"}, kColor), 0.390625, 0.25, 1);
    near(viewed({.config = config, .look = "double"}, kColor), 0.390625, 0.25, 1);
    near(viewed({.config = config, .look = "double, double"}, kColor), 1.5625, 1, 4);
    near(viewed({.config = config, .look = "+double, -double"}, kColor), 0.09765625, 0.0625, 0.25);
    near(viewed({.config = config, .view = "plain"}, kColor), 0.5, 0.25, 1);
    // The square of (r^2/2 + g^2/4, g^2, b^2/2).
    near(viewed({.config = config, .working_space = "painted"}, kColor), 0.0197754, 0.00390625, 0.25);
}

TEST(Colors, OfFilesAreBroughtToTheWorkingSpace) {
    const TemporaryFolder folder;
    const Opened opened = open_colors_of({.config = write_config(folder)});
    ASSERT_TRUE(opened.colors) << opened.problem;
    EXPECT_EQ(opened.colors->space_of_file("/a/b/wood_paint.png"), "paint");
    EXPECT_EQ(opened.colors->space_of_file("/a/b/wood.png"), "") << "only the rule for all others";
    EXPECT_EQ(opened.colors->space_named("Painted"), "paint");
    EXPECT_EQ(opened.colors->space_named("scene_linear"), "work");
    EXPECT_EQ(opened.colors->space_named("acescg"), "");
    EXPECT_EQ(opened.colors->spaces_listed(), R"("work", "raw", "mixed", "paint", "lost")");
    std::string problem;
    const auto transform = opened.colors->from_space("paint", &problem);
    ASSERT_TRUE(transform) << problem;
    float pixel[4] = {0.5f, 0.25f, 1, 1};
    transform->apply(pixel, 1);
    EXPECT_NEAR(pixel[0], 0.25, 1e-5);
    EXPECT_NEAR(pixel[1], 0.0625, 1e-5);
    EXPECT_NEAR(pixel[2], 1, 1e-5);
    for (const char* same : {"work", "raw"}) {
        EXPECT_FALSE(opened.colors->from_space(same, &problem)) << same;
        EXPECT_EQ(problem, "") << same;
    }
    EXPECT_FALSE(opened.colors->from_space("lost", &problem));
    EXPECT_THAT(problem, HasSubstr("lost.spi1d"));
}

TEST(Colors, HaveTheNamesOfTheConfig) {
    const TemporaryFolder folder;
    const std::string config = write_config(folder);
    const Opened usual = open_colors_of({.config = config});
    ASSERT_TRUE(usual.colors) << usual.problem;
    EXPECT_EQ(usual.colors->names().display, "screen");
    EXPECT_EQ(usual.colors->names().view, "mixed");
    EXPECT_FALSE(usual.colors->view_is_srgb());
    const Opened asked = open_colors_of(
        {.config = config, .display = "projector", .look = "double", .working_space = "PAINTED"});
    ASSERT_TRUE(asked.colors) << asked.problem;
    EXPECT_EQ(asked.colors->names().working_space, "paint");
    EXPECT_EQ(asked.colors->names().display, "Projector");
    EXPECT_EQ(asked.colors->names().view, "dark");
    EXPECT_EQ(asked.colors->names().look, "double");
}

TEST(Colors, ThatAreNotThereAreSaidWithThoseThatAre) {
    const TemporaryFolder folder;
    const std::string config = write_config(folder);
    const auto problem = [&](ColorRequest request) {
        request.config = config;
        const Opened opened = open_colors_of(request);
        EXPECT_FALSE(opened.colors);
        return opened.problem;
    };
    EXPECT_EQ(problem({.display = "tv"}), "no display \"tv\"; there is \"screen\", \"Projector\"");
    EXPECT_EQ(problem({.view = "dark"}),
              "no view of display \"screen\" \"dark\"; there is \"mixed\", \"brighter\", \"plain\"");
    EXPECT_EQ(problem({.look = "double, half"}), "no look \"half\"; there is \"double\"");
    EXPECT_EQ(problem({.working_space = "acescg"}),
              "no colour space \"acescg\"; there is \"work\", \"raw\", \"mixed\", \"paint\", \"lost\"");
    EXPECT_THAT(problem({.working_space = "lost"}), HasSubstr("lost.spi1d"));
}

TEST(Colors, OfBrokenConfigsAreAProblemOnOneLine) {
    EXPECT_NE(problem_of_text(""), "");
    EXPECT_NE(problem_of_text("no config"), "");
    EXPECT_NE(problem_of_text("ocio_profile_version: 99\n"), "");
    EXPECT_NE(problem_of_text("ocio_profile_version: 2\ncolorspaces: [\n"), "");
    const std::string small = testing::kSmallConfig;
    EXPECT_NE(problem_of_text(small.substr(0, small.find("brighter"))), "");
    EXPECT_NE(problem_of_text(std::string(100000, '[')), "");
    EXPECT_NE(problem_of_text(std::string("\0\xff\x01", 3) + "ocio"), "");
    const std::string bare =
        "ocio_profile_version: 2\nroles: {default: a}\ncolorspaces:\n  - !<ColorSpace> {name: a}\n";
    EXPECT_EQ(
        problem_of_text(bare),
        "there is no role scene_linear: Option \"ocio\" \"workingspace\" says which colour space shading "
        "is in: \"a\"");
    EXPECT_EQ(problem_of_text(bare, {.working_space = "a"}), "there is no display");
    EXPECT_NE(open_colors_of({.config = "/nowhere/to/be/found.ocio"}).problem, "");
}

TEST(Colors, AreTheSameBitsHoweverPixelsAreSplit) {
    const TemporaryFolder folder;
    const Opened opened = open_colors_of({.config = write_config(folder), .view = "brighter"});
    ASSERT_TRUE(opened.colors) << opened.problem;
    constexpr size_t kPixels = 1003;
    std::vector<float> whole(4 * kPixels);
    for (size_t i = 0; i < whole.size(); ++i) whole[i] = 0.37f * static_cast<float>(i % 101) - 1;
    std::vector<float> one_by_one = whole, threaded = whole;
    opened.colors->view().apply(whole.data(), kPixels);
    for (size_t i = 0; i < kPixels; ++i) opened.colors->view().apply(one_by_one.data() + 4 * i, 1);
    std::vector<std::thread> threads;
    for (size_t t = 0; t < 4; ++t)
        threads.emplace_back([&, t] {
            for (size_t i = t; i < kPixels; i += 4) opened.colors->view().apply(threaded.data() + 4 * i, 1);
        });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(whole, one_by_one);
    EXPECT_EQ(whole, threaded);
}

}  // namespace
}  // namespace trapeze
