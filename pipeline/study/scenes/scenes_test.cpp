#include "pipeline/study/scenes/scenes.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "pipeline/frame/make_context.h"
#include "pipeline/frame/render_frame.h"
#include "pipeline/rib/read_rib.h"

namespace trapeze {
namespace {

namespace fs = std::filesystem;

struct Outcome {
    std::string messages;
    std::vector<FrameResult> frames;
};

/// Reads RIB from a file, and renders it.
Outcome render(const std::string& text) {
    Outcome outcome;
    const fs::path path = fs::temp_directory_path() / ("trapeze_scene_" + std::to_string(getpid()) + ".rib");
    std::ofstream(path, std::ios::binary) << text;
    Diagnostics diagnostics([&](const Diagnostic& d) { outcome.messages += to_string(d) + "\n"; });
    const std::vector<std::string> files{path.string()};
    read_rib(files, ReadOptions{}, diagnostics, [&](Scene&& scene) {
        RenderSettings settings;
        auto frame = render_frame(make_context(scene, settings, diagnostics), settings);
        if (frame) outcome.frames.push_back(std::move(*frame));
    });
    fs::remove(path);
    return outcome;
}

SceneParameters small(double motion = 1, double defocus = 1) {
    SceneParameters parameters;
    parameters.scale = .05, parameters.motion = motion, parameters.defocus = defocus;
    parameters.width = 64, parameters.height = 36;
    return parameters;
}

class MadeScene : public ::testing::TestWithParam<std::string_view> {};

TEST_P(MadeScene, ReadsWithoutADiagnosticAndRenders) {
    const Outcome outcome = render(scene_text(GetParam(), small()));
    EXPECT_EQ(outcome.messages, "");
    ASSERT_EQ(outcome.frames.size(), 1u);
    const Image& image = outcome.frames[0].image;
    const auto [low, high] = std::minmax_element(image.rgba.begin(), image.rgba.end());
    ASSERT_EQ(image.rgba.size(), 64u * 36 * 4);
    EXPECT_GT(*high, *low + .2f) << "a picture of nothing";
}

TEST_P(MadeScene, IsStillAndSharpWhenAsked) {
    const std::string moving = scene_text(GetParam(), small());
    EXPECT_NE(moving.find("MotionBegin"), std::string::npos);
    EXPECT_NE(moving.find("Shutter"), std::string::npos);
    EXPECT_NE(moving.find("DepthOfField"), std::string::npos);
    const std::string still = scene_text(GetParam(), small(0, 0));
    EXPECT_EQ(still.find("MotionBegin"), std::string::npos);
    EXPECT_EQ(still.find("Shutter"), std::string::npos);
    EXPECT_EQ(still.find("DepthOfField"), std::string::npos);
}

TEST_P(MadeScene, MicropolygonsGrowWithTheScale) {
    const auto micropolygons = [](double scale) {
        SceneParameters parameters = small(0, 0);
        parameters.scale = scale, parameters.width = 320, parameters.height = 180;
        // A few samples are enough to count by.
        std::string text = scene_text(GetParam(), parameters);
        const std::string many = "PixelSamples 8 8";
        text.replace(text.find(many), many.size(), "PixelSamples 2 2");
        return static_cast<double>(render(text).frames.at(0).stats.tessellate.micropolygons);
    };
    // Smaller scales have pieces that are a micropolygon already.
    const double ratio = micropolygons(1.6) / micropolygons(.4);
    EXPECT_GT(ratio, 2.4);
    EXPECT_LT(ratio, 4.6);
}

INSTANTIATE_TEST_SUITE_P(All, MadeScene, ::testing::ValuesIn(scene_names()), [](const auto& row) {
    std::string name(row.param);
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
});

// They are in the repository to be rendered at once; `trapeze scene NAME -o scenes/paper/NAME.rib` renews
// them.
TEST(Scenes, FilesOfTheRepositoryAreWhatIsWritten) {
    for (const std::string name : {"halberd", "car-study"}) {
        std::ifstream file(TRAPEZE_SOURCE_DIR "/scenes/paper/" + name + ".rib", std::ios::binary);
        const std::string text{std::istreambuf_iterator<char>(file), {}};
        EXPECT_TRUE(text == scene_text(name, {})) << name;
    }
}

TEST(Scenes, UnknownNamesGiveNothing) {
    EXPECT_EQ(scene_text("no such scene", {}), "");
}

}  // namespace
}  // namespace trapeze
