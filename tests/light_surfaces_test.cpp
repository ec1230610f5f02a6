/// What the camera sees of the path tracer's lights: as bright as their closed forms, on the sides that
/// shine, and where Attribute "visibility" lets it.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "core/files/temporary_folder_harness.h"
#include "tests/scene_harness.h"

namespace trapeze::testing {
namespace {

constexpr int kSize = 64;

/// An orthographic picture of 2 by 2 of what stands at z = 5.
Image picture(const std::string& world) {
    const TemporaryFolder folder;
    const std::string path = folder.file("a.rib");
    std::ofstream(path)
        << "Format 64 64 1 Projection \"orthographic\" ScreenWindow -1 1 -1 1 PixelSamples 8 8\n"
           "PixelFilter \"box\" 1 1 Translate 0 0 5 WorldBegin\n"
        << world << "\nWorldEnd\n";
    const auto frames = render_scene(path, RenderSettings());
    return frames.empty() ? Image() : frames.front().image;
}

std::array<float, 4> pixel(const Image& image, int x, int y) {
    const float* p = image.rgba.data() + (static_cast<size_t>(y) * kSize + static_cast<size_t>(x)) * 4;
    return {p[0], p[1], p[2], p[3]};
}
std::array<float, 4> middle(const Image& image) {
    return pixel(image, kSize / 2, kSize / 2);
}

/// Of the picture's 4 units of area.
double covered(const Image& image) {
    double sum = 0;
    for (size_t i = 3; i < image.rgba.size(); i += 4) sum += static_cast<double>(image.rgba[i]);
    return sum * 4 / (kSize * kSize);
}

std::string light(const std::string& kind, const std::string& more = "") {
    return "Light \"Pxr" + kind + "Light\" \"key\" \"color lightColor\" [1 .5 .25] \"float intensity\" [3] " +
           more;
}

/// A half turn, as what shines along +z shows its back to the camera.
const std::string kTurned = "Rotate 180 0 1 0 ";

TEST(LightSurfaces, AreTheShapesAsBrightAsTheLight) {
    const std::pair<const char*, double> kinds[] = {
        {"Rect", 1}, {"Disk", std::numbers::pi / 4}, {"Sphere", std::numbers::pi / 4}, {"Cylinder", 1}};
    for (const auto& [kind, area] : kinds) {
        const Image seen = picture(kTurned + light(kind));
        EXPECT_EQ(middle(seen), (std::array<float, 4>{3, 1.5f, .75f, 1})) << kind;
        EXPECT_EQ(pixel(seen, 2, 2), (std::array<float, 4>{0, 0, 0, 0})) << kind;
        EXPECT_NEAR(covered(seen), area, .01) << kind;
    }
}

/// Of half floats, which grids' colours are.
constexpr double kRounding = 1.0 / 2048;

TEST(LightSurfaces, OfNormalizedLightsAreAsDarkAsTheyAreLarge) {
    const std::string large = kTurned + "Scale 1.5 2 1 ";
    EXPECT_EQ(middle(picture(large + light("Rect", "\"int areaNormalize\" [1]")))[0], 1);
    EXPECT_NEAR(middle(picture(large + light("Disk", "\"int areaNormalize\" [1]")))[0], 4 / std::numbers::pi,
                kRounding);
    EXPECT_NEAR(middle(picture("Scale 2 2 2 " + light("Sphere", "\"int areaNormalize\" [1]")))[0],
                3 / (4 * std::numbers::pi), kRounding);
    // A spheroid of radii .5, .5 and 2: 2 pi a^2 (1 + c / (a e) asin(e)).
    const double e = std::sqrt(1 - .25 * .25);
    const double spheroid = 2 * std::numbers::pi * .25 * (1 + 2 / (.5 * e) * std::asin(e));
    EXPECT_NEAR(middle(picture("Scale 1 1 4 " + light("Sphere", "\"int areaNormalize\" [1]")))[0],
                3 / spheroid, 2 * kRounding);
    EXPECT_NEAR(middle(picture("Scale 1.5 2 2 " + light("Cylinder", "\"int areaNormalize\" [1]")))[0],
                3 / (3 * std::numbers::pi), kRounding);
}

TEST(LightSurfaces, HaveNoBacks) {
    for (const std::string kind : {"Rect", "Disk"}) {
        EXPECT_EQ(covered(picture(light(kind))), 0) << kind;
        // A mirrored space does not turn it, whatever the orientation is.
        for (const std::string odd :
             {"Scale -1 1 1 ", "Scale 1 1 -1 ", "ReverseOrientation ", "Orientation \"inside\" "}) {
            const bool turns = odd == "Scale 1 1 -1 ";
            EXPECT_EQ(covered(picture(kTurned + odd + light(kind))) > .5, !turns) << kind << odd;
            EXPECT_EQ(covered(picture(odd + light(kind))) > .5, turns) << kind << odd;
        }
    }
}

TEST(LightSurfaces, AreBrightInTheCone) {
    const std::string askew = kTurned + "Rotate 60 0 1 0 ";
    EXPECT_NEAR(middle(picture(askew + light("Rect", "\"float emissionFocus\" [2]")))[0], 3 * .25f, 1e-4f);
    EXPECT_EQ(middle(picture(askew + light("Rect", "\"float coneAngle\" [50]")))[0], 0);
    EXPECT_EQ(middle(picture(askew + light("Rect", "\"float coneAngle\" [70]")))[0], 3);
}

/// Nor are they in the way of their own light, or of any ray.
TEST(LightSurfaces, AreSeenWhereTheirAttributesSay) {
    const std::string floor =
        "AttributeBegin Translate 0 0 2 Bxdf \"PxrDiffuse\" \"grey\" "
        "Patch \"bilinear\" \"P\" [-2 -2 0 2 -2 0 -2 2 0 2 2 0] AttributeEnd\n";
    const std::string lamp =
        "AttributeBegin Scale .5 .5 .5 " + light("Sphere", "\"float exposure\" [3]") + " AttributeEnd\n";
    const Image seen = picture(floor + lamp),
                hidden = picture(floor + "Attribute \"visibility\" \"int camera\" [0]\n" + lamp);
    EXPECT_EQ(middle(seen)[0], 24);
    EXPECT_GT(middle(hidden)[0], 0);
    EXPECT_LT(middle(hidden)[0], 12);
    for (int y : {4, 32, 60})
        for (int x : {4, 60}) EXPECT_EQ(pixel(seen, x, y), pixel(hidden, x, y)) << x << " " << y;
}

TEST(LightSurfaces, OfObjectsAreSeenWhereTheyArePlaced) {
    const Image seen =
        picture("ObjectBegin \"lamp\" " + light("Sphere") +
                " ObjectEnd AttributeBegin Translate -.5 0 0 Scale .5 .5 .5 ObjectInstance \"lamp\" "
                "AttributeEnd AttributeBegin Translate .5 0 0 Scale .5 .5 .5 ObjectInstance \"lamp\" "
                "AttributeEnd");
    EXPECT_EQ(pixel(seen, 16, 32)[0], 3);
    EXPECT_EQ(pixel(seen, 48, 32)[0], 3);
    EXPECT_EQ(middle(seen)[0], 0);
}

/// A mesh light that waits for its shape does not take that of another light.
TEST(LightSurfaces, AreNoShapesOfMeshLights) {
    const Image seen = picture("Light \"PxrMeshLight\" \"mesh\" \"float intensity\" [8] " + light("Sphere") +
                               " Translate 0 0 1 Bxdf \"PxrDiffuse\" \"grey\" Disk 0 .8 360");
    EXPECT_EQ(middle(seen)[0], 3);
    const Image alone = picture(
        "Light \"PxrMeshLight\" \"mesh\" \"float intensity\" [8] "
        "Attribute \"visibility\" \"int camera\" [0] " +
        light("Sphere") +
        " Translate 0 0 1 Bxdf \"PxrDiffuse\" \"grey\" Attribute \"visibility\" \"int camera\" [1] "
        "Disk 0 .8 360");
    EXPECT_EQ(pixel(seen, 32, 10), pixel(alone, 32, 10));
}

}  // namespace
}  // namespace trapeze::testing
