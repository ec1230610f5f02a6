/// Crops are parts of the whole picture, bit for bit, where random numbers decide: a grid's do not depend on
/// which others are in the picture.
#include <gtest/gtest.h>

#include "tests/program_harness.h"
#include "tests/scene_harness.h"

namespace trapeze::testing {
namespace {

/// Balls, hairs and a floor under an area light, by shaders that draw numbers and send rays.
std::string cropped_scene(const std::string& options) {
    return "Format 64 48 1 PixelSamples 2 2 Option \"trace\" \"int maxdepth\" 3 Projection \"perspective\" \"fov\" [40] Shutter 0 1 " +
           options +
           "\nWorldBegin Attribute \"visibility\" \"int diffuse\" 1 \"int transmission\" 1 \"int specular\" 1 "
           "AttributeBegin Translate 0 3 6 Rotate 90 1 0 0 Attribute \"light\" \"int nsamples\" 4 "
           "AreaLightSource \"arealight\" 1 \"intensity\" [20] Polygon \"P\" [-1 -1 0 1 -1 0 1 1 0 -1 1 0] "
           "AttributeEnd Illuminate 1 1 Surface \"draws\" "
           "Polygon \"P\" [-9 -1 20 9 -1 20 9 -1 1 -9 -1 1] Translate -.6 0 5 Sphere .8 -.8 .8 360 "
           "MotionBegin [0 1] Translate 1.6 0 0 Translate 1.7 .1 0 MotionEnd Sphere .6 -.6 .6 360 "
           "Curves \"cubic\" [4 4] \"nonperiodic\" \"P\" [-2 -1 0 -2 0 0 -1 0 0 -1 1 0 "
           "0 -1 -1 0 0 -1 -1 0 -1 0 1 -1] \"constantwidth\" [.1] WorldEnd\n";
}

constexpr const char* kDraws =
    "surface draws() { Oi = 1; normal n = faceforward(normalize(N), I); color seen = 0;"
    "gather(\"illuminance\", P, n, PI / 2, 2, \"surface:Ci\", seen) {} "
    "Ci = random() + occlusion(P, n, 4) + diffuse(n) + noise(P) + seen; }";

TEST(Crop, HasTheRandomNumbersOfTheWholePicture) {
    const WorkFolder folder;
    folder.write("draws.sl", kDraws);
    const auto render = [&](const std::string& options) {
        folder.write("a.rib", "Option \"searchpath\" \"string shader\" [\"" + folder.path().string() +
                                  ":&\"] " + cropped_scene(options));
        auto frames = render_scene((folder / "a.rib").string(), {});
        EXPECT_EQ(frames.size(), 1u);
        return std::move(frames.at(0).image);
    };
    const Image whole = render("");
    for (const char* crop : {"0 .5 0 .5", ".5 1 .5 1", ".4 .6 .1 .9"}) {
        const Image part = render(std::string("CropWindow ") + crop);
        ASSERT_FALSE(part.rgba.empty());
        size_t other = 0;
        for (int y = part.window.y0; y < part.window.y1; ++y)
            for (int x = part.window.x0; x < part.window.x1; ++x)
                for (size_t c = 0; c < 4; ++c)
                    other += part.rgba[4 * part.index(x, y) + c] != whole.rgba[4 * whole.index(x, y) + c];
        EXPECT_EQ(other, 0u) << crop;
    }
}

}  // namespace
}  // namespace trapeze::testing
