/// What rays meet is made again and again where memory is short: the picture stays the same, bit for bit.
#include <tuple>

#include "tests/program_harness.h"
#include "tests/scene_harness.h"

namespace trapeze::testing {
namespace {

/// A floor that asks for rays of all kinds under balls that only rays see: displaced, seen through,
/// one-sided; and curves. Some may move.
std::string scene(bool moves) {
    std::string text =
        std::string(
            "Display \"x\" \"exr\" \"rgba\" Format 48 36 1 PixelSamples 2 2 Projection \"perspective\" \"fov\" 40 "
            "Translate 0 -.2 4 Rotate -20 1 0 0 WorldBegin ShadingInterpolation \"smooth\" "
            "Attribute \"visibility\" \"int diffuse\" 1 \"int specular\" 1 \"int transmission\" 1 ") +
        std::string(moves ? "Attribute \"trace\" \"int samplemotion\" 1 " : "") +
        "Surface \"ask\" ShadingRate 12 Patch \"bilinear\" \"P\" [-3 0 -2 3 0 -2 -3 0 5 3 0 5] ShadingRate .01 Attribute \"visibility\" \"int camera\" 0 ";
    for (int i = 0; i < 12; ++i) {
        const std::string place = "Translate " + std::to_string(i % 4 - 1.5) + " .3 " +
                                  std::to_string(.8 * (i / 4)) + " Rotate " + std::to_string(30 * i) +
                                  " 1 1 0 ";
        text += "AttributeBegin " + place;
        if (moves && i % 3 == 0) text += "MotionBegin [0 1] Translate 0 0 0 Translate .2 .1 .05 MotionEnd ";
        if (i % 4 == 1)
            text +=
                "Displacement \"waves\" Attribute \"displacementbound\" \"float sphere\" .06 "
                "Attribute \"trace\" \"int displacements\" 1 ";
        if (i % 4 == 2) text += "Opacity .4 .5 .6 Attribute \"visibility\" \"int specular\" 0 ";
        if (i % 4 == 3) text += "Sides 1 ";
        text += i < 10 ? "Sphere .3 -.3 .25 360 " : "Torus .2 .1 0 360 360 ";
        text += "AttributeEnd ";
    }
    return text +
           "Surface \"constant\" Curves \"cubic\" [4 4] \"nonperiodic\" \"P\" [0 0 0 0 .4 0 .2 .8 0 0 1.2 0 "
           "1 0 0 1 .5 0 1.2 .8 .3 .9 1.2 0] \"constantwidth\" .02 WorldEnd\n";
}

constexpr const char* kAsk =
    "surface ask() { normal n = faceforward(normalize(N), I);"
    " Ci = Cs * (1 - occlusion(P, n, 4)) * (.4 + .6 * transmission(P, P + vector(2, 3, -2)))"
    "      + .2 * color trace(P, reflect(normalize(I), n)); Oi = Os; Ci *= Oi; }";
constexpr const char* kWaves =
    "displacement waves() { P += .04 * sin(20 * s) * sin(20 * t) * normalize(N); N = calculatenormal(P); }";

/// Whether things move, and whether rays meet levels.
class RayBudget : public ::testing::TestWithParam<std::tuple<bool, bool>> {};

TEST_P(RayBudget, ChangesNothingButTheTime) {
    WorkFolder folder;
    folder.write("ask.sl", kAsk);
    folder.write("waves.sl", kWaves);
    const auto [moves, levels] = GetParam();
    folder.write("a.rib", std::string(levels ? "Option \"trace\" \"int levels\" 2 " : "") +
                              "Shutter 0 1 Option \"searchpath\" \"string shader\" [\"" +
                              folder.path().string() + "\"] " + scene(moves));
    const std::string path = (folder / "a.rib").string();
    RenderSettings settings;
    const auto whole = render_scene(path, settings);
    ASSERT_EQ(whole.size(), 1u);
    const FrameStats& all = whole[0].stats;
    ASSERT_EQ(all.ray_micropolygons_made, all.ray_micropolygons) << "all is kept";
    ASSERT_GT(all.ray_micropolygons, 100000u);
    // Into a fiftieth lists of subpatches do not fit either.
    for (const auto& [threads, part] : {std::pair{1, 20u}, {2, 20u}, {2, 3u}, {1, 50u}, {2, 50u}}) {
        SCOPED_TRACE(part);
        settings.memory_bytes = all.ray_bytes / part;
        const auto parts = render_scene(path, settings, threads);
        ASSERT_EQ(parts.size(), 1u);
        EXPECT_TRUE(same_bits(whole[0].image, parts[0].image));
        EXPECT_GT(parts[0].stats.ray_micropolygons_made, all.ray_micropolygons);
        EXPECT_LE(parts[0].stats.ray_bytes, settings.memory_bytes) << "of which half is for bricks";
    }
}

INSTANTIATE_TEST_SUITE_P(MotionAndLevels, RayBudget,
                         ::testing::Combine(::testing::Bool(), ::testing::Bool()));

}  // namespace
}  // namespace trapeze::testing
