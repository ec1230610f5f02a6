/// Imager "glow" in whole frames: crops, regions and threads, Exposure, and what a scene may say wrong.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>

#include "composite/filters/glow_filter.h"
#include "tests/scene_harness.h"

namespace trapeze::testing {
namespace {

/// Small bright squares before a dim one that fills 96 x 64 pixels, with motion and defocus.
std::string glowing_scene(const std::string& options) {
    const std::string folder = ::testing::TempDir() + "glow_scene" + std::to_string(getpid());
    std::filesystem::create_directories(folder);
    const std::string path = folder + "/scene.rib";
    std::ofstream(path)
        << "Display \"x\" \"exr\" \"rgba\" Format 96 64 1 PixelSamples 3 3 Projection \"perspective\" \"fov\" "
           "[40] DepthOfField 2 .6 4 Shutter 0 1\n"
        << options
        << "\nWorldBegin Surface \"constant\" Color .2 .3 .4 Polygon \"P\" [-9 -9 9 9 -9 9 9 9 9 -9 9 9] "
           "MotionBegin [0 1] Translate 0 0 0 Translate .1 0 0 MotionEnd Color 60 30 10 "
           "Polygon \"P\" [-1 -.4 5 -.9 -.4 5 -.9 -.3 5 -1 -.3 5] Color 5 90 20 "
           "Polygon \"P\" [.8 .4 3 .85 .4 3 .85 .5 3 .8 .5 3] WorldEnd\n";
    return path;
}

constexpr const char* kGlow = "Imager \"glow\" \"float amount\" [.4] \"float size\" [.05] ";

Image render_glow(const std::string& options, int threads = 2, int regions = 1) {
    RenderSettings settings;
    settings.regions_at_least = regions;
    return render_scene(glowing_scene(options), settings, threads).at(0).image;
}

Image part_of(Image whole, const PixelRect& window) {
    trim(window, whole);
    return whole;
}

TEST(Glow, CropsArePartsOfTheWholePictureBitForBit) {
    for (const std::string further : {"", "Exposure 2 2.2 ", "PixelFilter \"catmull-rom\" 4 4 "}) {
        const Image whole = render_glow(kGlow + further);
        for (const char* crop : {"0 .5 0 .5", ".5 .6 .4 .5", ".25 1 .5 1", "0 1 .98 1"}) {
            const Image part = render_glow(kGlow + further + "CropWindow " + crop);
            ASSERT_FALSE(part.rgba.empty());
            EXPECT_TRUE(part == part_of(whole, part.window)) << further << crop;
            EXPECT_LT(part.rgba.size(), whole.rgba.size()) << "the margin is not kept";
        }
    }
}

TEST(Glow, IsTheSameForAnyThreadsAndRegions) {
    const Image image = render_glow(kGlow);
    EXPECT_TRUE(render_glow(kGlow, 1) == image);
    EXPECT_TRUE(render_glow(kGlow, 7) == image);
    for (const int regions : {3, 40}) EXPECT_TRUE(render_glow(kGlow, 2, regions) == image) << regions;
}

TEST(Glow, OfNothingLeavesThePictureAsItIs) {
    const Image image = render_glow("");
    for (const char* none : {"Imager \"glow\" \"float amount\" [0]", "Imager \"glow\" \"float size\" [0]",
                             "Imager \"glow\" Imager \"null\"", "Imager \"glow\" \"float threshold\" [1000]"})
        EXPECT_TRUE(render_glow(none) == image) << none;
    EXPECT_FALSE(render_glow(kGlow) == image);
}

/// Light adds up before gamma: with it the picture is the power of that without.
TEST(Glow, ComesBeforeGamma) {
    const Image linear = render_glow(std::string(kGlow) + "Exposure 3 1"),
                gamma = render_glow(std::string(kGlow) + "Exposure 3 2");
    for (size_t i = 0; i < linear.rgba.size(); ++i)
        ASSERT_NEAR(gamma.rgba[i], i % 4 == 3 ? linear.rgba[i] : std::sqrt(linear.rgba[i]),
                    1e-5f * gamma.rgba[i]);
}

/// Imagers see the picture that glows, whichever is asked for first, also in crops.
TEST(Glow, AndImagersDoNotReplaceEachOther) {
    constexpr const char* kBehind = "Imager \"background\" \"color bgcolor\" [.1 .2 .3] ";
    const Image glowing = render_glow(std::string(kGlow) + "Exposure 1 2");
    for (const std::string& both : {std::string(kGlow) + kBehind, std::string(kBehind) + kGlow}) {
        const Image image = render_glow(both + "Exposure 1 2");
        ASSERT_EQ(image.rgba.size(), glowing.rgba.size());
        for (size_t i = 0; i < image.rgba.size(); i += 4)
            for (size_t k = 0; k < 3; ++k) {
                const float behind = .1f * static_cast<float>(k + 1);
                ASSERT_NEAR(image.rgba[i + k], glowing.rgba[i + k] + (1 - glowing.rgba[i + 3]) * behind,
                            1e-6f);
            }
        const Image part = render_glow(both + "Exposure 1 2 CropWindow .25 .75 .5 1");
        EXPECT_TRUE(part == part_of(image, part.window));
    }
    const Image plain = render_glow("Exposure 1 2");
    EXPECT_TRUE(render_glow(std::string(kGlow) + kBehind + "Imager \"null\" Exposure 1 2") == plain);
}

TEST(Glow, LeavesDepthAndOpacity) {
    const Image before = render_glow(""), after = render_glow(kGlow);
    EXPECT_EQ(after.z, before.z);
    for (size_t i = 3; i < after.rgba.size(); i += 4) ASSERT_EQ(after.rgba[i], before.rgba[i]);
}

TEST(Glow, AScenesOwnShaderOfThisNameIsRun) {
    const std::string path = glowing_scene("Imager \"glow\"");
    const std::string shader = std::filesystem::path(path).parent_path().string() + "/glow.sl";
    std::ofstream(shader) << "imager glow() { Ci = color (1, 2, 3); }\n";
    const Image image = render_scene(path, {}).at(0).image;
    std::filesystem::remove(shader);
    EXPECT_EQ(image.rgba[0], 1);
    EXPECT_EQ(image.rgba[1], 2);
}

TEST(Glow, WhatIsOutOfRangeIsSaidAndClamped) {
    const auto messages = [](const std::string& parameters) {
        std::vector<std::string> said;
        Diagnostics diagnostics([&](const Diagnostic& message) { said.push_back(message.text); });
        const std::string path = glowing_scene("Imager \"glow\" " + parameters);
        const std::vector<std::string> files{path};
        read_rib(files, ReadOptions{}, diagnostics, [&](Scene&& read) {
            const auto glow = find_glow(read.options, &diagnostics);
            if (!glow) said.push_back("none");
            const Glow in_range = glow.value_or(Glow{});
            EXPECT_TRUE(in_range.amount <= 1 && in_range.size <= Glow::kMostSize && in_range.threshold >= 0);
        });
        return said.empty() ? std::string() : said.front();
    };
    EXPECT_EQ(messages("\"float amount\" [1] \"float size\" [.1] \"float threshold\" [9]"), "");
    EXPECT_EQ(messages("\"float amount\" [7]"),
              "Imager: \"glow\": \"amount\" is out of range; the nearest value is used");
    EXPECT_EQ(messages("\"float size\" [1e30]"),
              "Imager: \"glow\": \"size\" is out of range; the nearest value is used");
    EXPECT_EQ(messages("\"float threshold\" [-1]"),
              "Imager: \"glow\": \"threshold\" is out of range; the nearest value is used");
    EXPECT_EQ(messages("\"string size\" [\"big\"]"), "Imager: \"glow\": \"size\" is not a number; left out");
    EXPECT_EQ(messages("\"float radius\" [3]"),
              "Imager: \"glow\": there is no parameter \"radius\": there are amount, size and threshold");
    EXPECT_EQ(messages("\"float amount\" [0]"), "none");
}

}  // namespace
}  // namespace trapeze::testing
