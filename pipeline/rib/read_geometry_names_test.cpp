/// Geometry: shapes by name.
#include "pipeline/rib/reading_harness.h"
#include "pipeline/rib/requests/teapot.h"

namespace trapeze::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(ReadGeometryNames, ThreeAreKnown) {
    const ReadOutcome r = read_world(
        "Geometry \"sphere\" Geometry \"cube\" \"constant color Cs\" [1 0 0] "
        "Geometry \"teapot\" \"uniform float k\" 3");
    EXPECT_THAT(r.messages, IsEmpty());
    ASSERT_EQ(r.count(), 34u);
    EXPECT_EQ(std::get<Quadric>(r.primitive(0).shape().topology).theta_max(), 360);
    EXPECT_EQ(r.primitive(1).shape().variables.find("P")->floats.size(), 24u);
    for (size_t i = 2; i < 34; ++i) {
        EXPECT_TRUE(std::get<PatchMesh>(r.primitive(i).shape().topology).bicubic);
        EXPECT_EQ(r.primitive(i).shape().variables.find("k")->floats[0], 3);
    }
}

TEST(ReadGeometryNames, SphereLightsHaveTheirRadius) {
    const ReadOutcome r =
        read_world("Geometry \"spherelight\" \"constant float radius\" [3] Geometry \"spherelight\"");
    EXPECT_THAT(r.messages, IsEmpty());
    ASSERT_EQ(r.count(), 2u);
    EXPECT_EQ(std::get<Quadric>(r.primitive(0).shape().topology).values[2], 3);
    EXPECT_EQ(std::get<Quadric>(r.primitive(1).shape().topology).values[2], 0.5f);
}

TEST(ReadGeometryNames, OthersAreSaidOnceAndLeftOut) {
    const ReadOutcome r = read_world("Geometry \"dragon\"\nGeometry \"dragon\"\nSphere 1 -1 1 360");
    ASSERT_EQ(r.messages.size(), 1u);
    EXPECT_THAT(r.messages[0], HasSubstr("a.rib:2:1: warning: Geometry: no geometry \"dragon\""));
    EXPECT_EQ(r.count(), 1u);
    const ReadOutcome moving =
        read_world("MotionBegin [0 1] Geometry \"teapot\" Geometry \"teapot\" MotionEnd");
    ASSERT_GE(moving.messages.size(), 1u);
    EXPECT_THAT(moving.messages[0], HasSubstr("does not deform"));
}

/// Volume inside by the divergence theorem: each side of the cube adds a third of its area, half a unit away.
TEST(ReadGeometryNames, CubesFaceOutwards) {
    const ReadOutcome r = read_world("Geometry \"cube\"");
    const auto& mesh = std::get<PolygonMesh>(r.primitive().shape().topology);
    const std::vector<float>& P = r.primitive().shape().variables.find("P")->floats;
    const auto corner = [&](size_t i) {
        const size_t v = 3 * static_cast<size_t>(mesh.vertices[i]);
        return V3f(P[v], P[v + 1], P[v + 2]);
    };
    float volume = 0;
    for (size_t i = 0; i < 24; i += 4) {
        const V3f area = (corner(i + 1) - corner(i)).cross(corner(i + 3) - corner(i));
        volume += area.dot(corner(i)) / 3;
    }
    EXPECT_FLOAT_EQ(volume, 1);
}

TEST(Teapot, HasItsSizeAndSymmetry) {
    const auto patches = rib::teapot_patches();
    ASSERT_EQ(patches.size(), 32u);
    V3f least(9, 9, 9), most(-9, -9, -9);
    for (const auto& patch : patches)
        for (const V3f& p : patch)
            for (int k = 0; k < 3; ++k)
                least[k] = std::min(least[k], p[k]), most[k] = std::max(most[k], p[k]);
    EXPECT_EQ(least, V3f(-3, -2, 0));
    EXPECT_EQ(most, V3f(3.525f, 2, 3.15f));
    // The body (the second and third patch, four times each) turns outwards.
    for (size_t i = 4; i < 12; ++i) {
        const auto& p = patches[i];
        const V3f out = (p[1] - p[0]).cross(p[4] - p[0]);
        EXPECT_GT(out.x * p[0].x + out.y * p[0].y, 0) << i;
    }
}

}  // namespace
}  // namespace trapeze::testing
