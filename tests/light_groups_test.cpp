/// Light groups, and the normals beside them, in whole frames.
#include <gtest/gtest.h>

#include <fstream>

#include "core/files/temporary_folder_harness.h"
#include "core/scene/light_groups.h"
#include "tests/scene_harness.h"

namespace trapeze::testing {
namespace {

/// What rounding of grids' colours to halves may come to, of values about 1.
constexpr float kHalves = 1e-3f;

/// A floor under a sphere, by a shader of its own, with lights; displays of the groups' variables.
FrameResult lit_floor(const std::string& shading, const std::string& lights) {
    const TemporaryFolder folder;
    std::ofstream(folder.file("lit.sl"))
        << "surface lit() { normal n = faceforward(normalize(N), I); Oi = Os; Ci = " << shading << "; }";
    std::ofstream(folder.file("a.rib"))
        << "Option \"searchpath\" \"string shader\" [\"" << folder.file("") << ":&\"] Format 24 24 1\n"
        << "Display \"x\" \"exr\" \"rgba\" Display \"+x\" \"exr\" \"color lightgroup:key\" "
        << "Display \"+x\" \"exr\" \"color lightgroup:fill\" Display \"+x\" \"exr\" \"color lightgroup:unlit\"\n"
        << "Projection \"perspective\" \"fov\" 45 Translate 0 0 6 Rotate -30 1 0 0 WorldBegin " << lights
        << "Attribute \"visibility\" \"int diffuse\" 1 Surface \"constant\" Sphere 1 -1 1 360 Surface \"lit\"\n"
        << "Polygon \"P\" [-3 -1.2 -3 -3 -1.2 3 3 -1.2 3 3 -1.2 -3] WorldEnd\n";
    return render_scene(folder.file("a.rib"), {}, 2).at(0);
}

void expect_sum(const FrameResult& frame, const std::string& what) {
    const Image& image = frame.image;
    ASSERT_EQ(image.aov_channels, 9) << what;
    const size_t pixels = image.rgba.size() / 4;
    float most = 0;
    for (size_t i = 0; i < pixels; ++i)
        for (size_t c = 0; c < 3; ++c) {
            const float* const groups = &image.aovs[9 * i];
            EXPECT_NEAR(groups[c] + groups[3 + c] + groups[6 + c], image.rgba[4 * i + c], kHalves) << what;
            EXPECT_GE(std::min(groups[c], groups[3 + c]), -1e-5f) << what;
            most = std::max(most, std::min(groups[c], groups[3 + c]));
        }
    EXPECT_GT(most, .01f) << what << ": both groups are seen somewhere";
}

/// Each group is rendered by a run of its own: with the random numbers of the run of all.
TEST(LightGroups, AddUpToThePictureWhereShadersAndLightsTakeSamples) {
    const std::string key =
        "LightSource \"distantlight\" 1 \"from\" [0 0 0] \"to\" [0 -1 0] \"string lightgroup\" "
        "\"key\" ";
    const std::string fill =
        "LightSource \"distantlight\" 2 \"from\" [0 0 0] \"to\" [1 -1 0] \"string lightgroup\" "
        "\"fill\" ";
    const std::string soft =
        "AttributeBegin AreaLightSource \"arealight\" \"r\" \"intensity\" 5 \"string lightgroup\" "
        "\"fill\" Translate -1 1 0 Sphere .5 -.5 .5 360 AttributeEnd Illuminate \"r\" 1 ";
    expect_sum(lit_floor("diffuse(n) + (1 - occlusion(P, n, 4))", key + fill), "occlusion");
    expect_sum(
        lit_floor(
            "0; uniform float i; for (i = 0; i < 2; i += 1) { illuminance(P, n, PI / 2) Ci += Cl * random();"
            " Ci *= random(); }",
            key + fill),
        "random numbers");
    expect_sum(lit_floor("Os * Cs * diffuse(n)", key + soft), "area light behind");
    expect_sum(lit_floor("Os * Cs * diffuse(n)", soft + key), "area light in front");
}

/// Three layers of opacity .1 cover .271 of a pixel, and have so much of a normal.
TEST(NormalLayer, IsAsLongAsItsSurfacesCover) {
    const TemporaryFolder folder;
    std::ofstream(folder.file("a.rib"))
        << "Format 3 3 1 Display \"x\" \"exr\" \"rgba\" Display \"+x\" \"exr\" \"normal N\" WorldBegin "
           "Surface \"constant\" Opacity [.1 .1 .1] Polygon \"P\" [-9 -9 1 9 -9 1 9 9 1 -9 9 1] "
           "Polygon \"P\" [-9 -9 2 9 -9 2 9 9 2 -9 9 2] Polygon \"P\" [-9 -9 3 9 -9 3 9 9 3 -9 9 3] WorldEnd\n";
    const Image image = render_scene(folder.file("a.rib"), {}, 1).at(0).image;
    EXPECT_NEAR(image.rgba[4 * 4 + 3], .271f, kHalves);
    EXPECT_NEAR(std::abs(image.aovs[3 * 4 + 2]), .271f, kHalves);
}

/// Behind what lets through other shares of red, green and blue, a direction fades as a float does, and stays
/// a direction.
TEST(NormalLayer, FadesAsAWholeBehindColoredGlass) {
    const TemporaryFolder folder;
    std::ofstream(folder.file("tells.sl"))
        << "surface tells(output varying vector way = 0; output varying color tint = 0; output varying float f = 0;) {"
           " way = vector(1, 1, 1); tint = 1; f = 1; Oi = Os; Ci = Oi; }";
    std::ofstream(folder.file("a.rib"))
        << "Option \"searchpath\" \"string shader\" [\"" << folder.file("") << ":&\"] Format 3 3 1 "
        << "Display \"x\" \"exr\" \"rgba\" Display \"+x\" \"exr\" \"normal N\" Display \"+x\" \"exr\" \"vector way\" "
           "Display \"+x\" \"exr\" \"color tint\" Display \"+x\" \"exr\" \"float f\" WorldBegin "
           "Surface \"null\" Opacity [0 .25 .5] Polygon \"P\" [-9 -9 1 9 -9 1 9 9 1 -9 9 1] "
           "Surface \"tells\" Opacity [1 1 1] Polygon \"P\" [-9 -9 2 9 -9 2 9 9 2 -9 9 2] WorldEnd\n";
    const Image image = render_scene(folder.file("a.rib"), {}, 1).at(0).image;
    ASSERT_EQ(image.aov_channels, 10);
    const float* const values = &image.aovs[10 * 4];
    EXPECT_NEAR(std::abs(values[2]), 1, kHalves);  // .25 of the one in front and .75 of the one behind
    for (size_t c = 3; c < 6; ++c) EXPECT_NEAR(values[c], .75f, kHalves);
    for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(values[6 + c], 1 - .25f * static_cast<float>(c), kHalves);
    EXPECT_NEAR(values[9], .75f, kHalves);
}

}  // namespace
}  // namespace trapeze::testing
