/// Points and curves turn to the eye: they have no back for rays either, whatever Sides and Orientation say.
#include <gtest/gtest.h>

#include <fstream>

#include "core/files/temporary_folder_harness.h"
#include "tests/scene_harness.h"

namespace trapeze::testing {
namespace {

/// Of something before a wall that a light from the eye's side shines on, beside a mirror.
Image picture(const std::string& sides, const std::string& shape) {
    const TemporaryFolder folder;
    std::ofstream(folder.file("asks.sl"))
        << "surface asks() { Ci = trace(P, reflect(normalize(I), normalize(N))) + .2 * (1 - occlusion(P, "
           "faceforward(normalize(N), I), 16)); Oi = 1; }";
    const std::string path = folder.file("a.rib");
    std::ofstream(path)
        << "Format 64 48 1 Projection \"perspective\" \"fov\" [45] PixelSamples 2 2 WorldBegin\n"
           "LightSource \"shadowdistant\" 1 \"shadowname\" \"raytrace\" \"from\" [0 0 0] \"to\" [.3 0 1]\n"
           "Translate 0 0 5 Surface \"matte\"\n"
           "Patch \"bilinear\" \"P\" [-9 -9 2 0 -9 2 -9 9 2 0 9 2]\n"
           "AttributeBegin Surface \"asks\" Patch \"bilinear\" \"P\" [0 -9 2 9 -9 2 0 9 2 9 9 2] AttributeEnd\n"
           "Surface \"constant\" Attribute \"visibility\" \"int transmission\" 1 \"int specular\" 1 \"int diffuse\" 1\n"
        << sides << ' ' << shape << "\nWorldEnd\n";
    const auto frames = render_scene(path, RenderSettings());
    return frames.empty() ? Image() : frames.front().image;
}

TEST(NoBacks, OfPointsAndCurvesForRays) {
    const std::string shapes[] = {
        "Points \"P\" [-1 0 0 1 .5 0] \"constantwidth\" [1]",
        "Points \"P\" [-1 0 0 1 .5 0] \"constantwidth\" [1] \"uniform string type\" [\"sphere\"]",
        "Curves \"linear\" [2 2] \"nonperiodic\" \"P\" [-1 -1 0 -1 1 0 1 -1 0 1 1 0] \"constantwidth\" [.4]"};
    for (const std::string& shape : shapes) {
        const Image both = picture("Sides 2", shape), nothing = picture("Sides 2", "");
        EXPECT_FALSE(same_bits(both, nothing));
        for (const std::string sides :
             {"Sides 1", "Sides 1 ReverseOrientation", "Sides 1 Orientation \"rh\""})
            EXPECT_TRUE(same_bits(picture(sides, shape), both)) << sides << shape;
    }
}

/// Curves with normals are ribbons, of which rays and the camera see the same side.
TEST(NoBacks, ButOfRibbons) {
    const std::string ribbon =
        "Curves \"linear\" [2] \"nonperiodic\" \"P\" [-1 -1 0 -1 1 0] \"constantwidth\" [.4] "
        "\"N\" [0 0 -1 0 0 -1]";
    EXPECT_FALSE(same_bits(picture("Sides 1", ribbon), picture("Sides 1 ReverseOrientation", ribbon)));
}

}  // namespace
}  // namespace trapeze::testing
