/// Levels of detail in transition share out the samples of each pixel.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "sample/level_of_detail.h"
#include "tests/program_harness.h"
#include "tests/scene_harness.h"

namespace trapeze::testing {
namespace {

/// A square that covers the picture at two levels, red and blue, of 64 x 64 pixels in a transition from 4096
/// - 1000 * passed on, before a green one; `opacity` of the levels.
Image render_levels(double passed, const std::string& options = "", const std::string& opacity = "1 1 1",
                    const std::string& sampler = "raytrace") {
    const double begin = 4096 - 1000 * passed;
    const std::string transition = std::to_string(begin) + " " + std::to_string(begin + 1000);
    const std::string square = "Polygon \"P\" [-2 -2 0 2 -2 0 2 2 0 -2 2 0] ";
    const WorkFolder folder;  // tests run side by side
    const std::string path = (folder / "detail_levels.rib").string();
    std::ofstream(path)
        << "Display \"x\" \"exr\" \"rgba\" Format 64 64 1 PixelFilter \"box\" 1 1 PixelSamples 4 4 "
           "Projection \"orthographic\" "
        << options << " WorldBegin Surface \"constant\" Translate 0 0 5 Opacity " << opacity
        << " Detail [-1 1 -1 1 0 0] AttributeBegin DetailRange [" << transition << " 1e38 1e38] Color 1 0 0 "
        << square << "AttributeEnd AttributeBegin DetailRange [0 0 " << transition
        << "] Color 0 0 1 Translate 0 0 1 " << square
        << "AttributeEnd Opacity 1 1 1 Color 0 1 0 Translate 0 0 2 DetailRange [0 0 1e38 1e38] " << square
        << "WorldEnd\n";
    RenderSettings settings;
    settings.sampler = sampler;
    return render_scene(path, settings).at(0).image;
}

TEST(LevelsOfDetail, InTransitionCoverTogetherWhatOneWould) {
    for (const double passed : {0.25, 0.5, 0.9}) {
        const Image image = render_levels(passed);
        double red = 0;
        for (size_t i = 0; i < image.rgba.size(); i += 4) {
            ASSERT_EQ(image.rgba[i + 1], 0) << "nothing shines through";
            ASSERT_NEAR(image.rgba[i] + image.rgba[i + 2], 1, 1e-6);
            ASSERT_NEAR(image.rgba[i], passed, 0.16) << "of 16 samples";
            red += image.rgba[i];
        }
        EXPECT_NEAR(red / (64 * 64), passed, 0.01);
    }
}

TEST(LevelsOfDetail, KeepTheirOpacities) {
    const Image image = render_levels(0.5, "", "0.5 0.5 0.5");
    for (size_t i = 0; i < image.rgba.size(); i += 4) ASSERT_NEAR(image.rgba[i + 1], 0.5, 2e-3);
}

TEST(LevelsOfDetail, AreTheSameForEveryMethod) {
    const std::string blur = "DepthOfField 4 1 4 Shutter 0 1";
    const Image image = render_levels(0.4, blur, "1 0.5 1");
    for (const char* method : {"bruteforce", "raytrace:tree=paper"})
        EXPECT_EQ(render_levels(0.4, blur, "1 0.5 1", method).rgba, image.rgba) << method;
}

TEST(LevelsOfDetail, NumbersAreSpreadOverThePixelsSamples) {
    int differs = 0;
    for (int x = 0; x < 64; ++x) {
        for (const float share : {0.1f, 0.5f, 0.7f}) {
            int seen = 0;
            for (int s = 0; s < 64; ++s) seen += detail_number(3, x, 5, s) < share;
            EXPECT_NEAR(seen, 64 * share, 2.5);
        }
        differs += detail_number(3, x, 5, 0) < 0.5f;
        EXPECT_EQ(detail_number(3, x, 5, 7), detail_number(3, x, 5, 7));
    }
    EXPECT_NEAR(differs, 32, 16) << "pixels differ from each other";
}

}  // namespace
}  // namespace trapeze::testing
