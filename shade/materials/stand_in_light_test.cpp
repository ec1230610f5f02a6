#include "shade/materials/stand_in_light.h"

#include <gtest/gtest.h>

#include "shade/shading_harness.h"

namespace trapeze {
namespace {

using testing::color;
using testing::number;
using testing::point;
using testing::shader;
using testing::ShadingScene;
using testing::text;

float number_of(const ShaderInstance& instance, const char* name) {
    const Parameter* found = instance.parameters.find(name);
    return found && found->floats.size() == 1 ? found->floats[0] : -1;
}

TEST(StandInLight, TheNameTellsTheKind) {
    const auto stands_in = [](const char* name) { return stand_in_light(shader(name)).name; };
    EXPECT_EQ(stands_in("MyAmbientLight"), "ambientlight");
    EXPECT_EQ(stands_in("env_occlusion"), "ambientlight");
    EXPECT_EQ(stands_in("mtorDirectionalLight"), "distantlight");
    EXPECT_EQ(stands_in("sun"), "distantlight");
    EXPECT_EQ(stands_in("liquidpoint"), "standinlight");
    EXPECT_EQ(stands_in("key"), "standinlight");
}

TEST(StandInLight, SoDoTheParameters) {
    const ShaderInstance aimed =
        stand_in_light(shader("key", {point("from", V3f(1, 2, 3)), point("to", V3f(0))}));
    EXPECT_EQ(aimed.name, "distantlight");
    ASSERT_TRUE(aimed.parameters.find("from"));
    EXPECT_EQ(aimed.parameters.find("from")->floats, (std::vector<float>{1, 2, 3}));
    const ShaderInstance cone = stand_in_light(shader("key", {number("coneAngle", 90)}));
    EXPECT_EQ(number_of(cone, "spot"), 1);
    EXPECT_NEAR(number_of(cone, "coneangle"), 0.785398f, 1e-5f);  // 45 degrees about the axis
    EXPECT_NEAR(number_of(stand_in_light(shader("key", {number("coneangle", 0.5f)})), "coneangle"), 0.5f, 0);
}

TEST(StandInLight, HotspotAndFalloffAreWholeConesInDegrees) {
    const ShaderInstance light =
        stand_in_light(shader("lamp", {number("hotspot", 36), number("falloff", 60)}));
    EXPECT_EQ(number_of(light, "spot"), 1);
    EXPECT_NEAR(number_of(light, "coneangle"), 0.523599f, 1e-5f);       // 30 degrees
    EXPECT_NEAR(number_of(light, "conedeltaangle"), 0.209440f, 1e-5f);  // 12 degrees
    EXPECT_EQ(number_of(light, "falloff"), 0);
}

TEST(StandInLight, ExportersHaveNamesOfTheirOwnForPowerAndColour) {
    const ShaderInstance light =
        stand_in_light(shader("lamp", {number("Energy", 3), color("cl", {1, 0.5f, 0})}));
    EXPECT_EQ(number_of(light, "intensity"), 3);
    ASSERT_TRUE(light.parameters.find("lightcolor"));
    EXPECT_EQ(light.parameters.find("lightcolor")->floats, (std::vector<float>{1, 0.5f, 0}));
}

TEST(StandInLight, ShadowMapsAreTakenOver) {
    const auto map_of = [](const ShaderInstance& light) {
        const Parameter* map = light.parameters.find("shadowname");
        return map ? map->strings.at(0) : "none";
    };
    EXPECT_EQ(map_of(stand_in_light(shader("liquidspot", {text("shadowname", "a.shd")}))), "a.shd");
    EXPECT_EQ(map_of(stand_in_light(shader("MOSAIClight", {text("__shadowname", "a.shd")}))), "a.shd");
    const ShaderInstance far = stand_in_light(
        shader("key", {point("from", V3f(1, 2, 3)), point("to", V3f(0)), text("shadname", "a.shd")}));
    EXPECT_EQ(far.name, "shadowdistant");
    EXPECT_EQ(map_of(far), "a.shd");
    EXPECT_EQ(map_of(stand_in_light(shader("spot", {text("shadowname", "raytrace")}))), "none");
    EXPECT_EQ(map_of(stand_in_light(shader("spot", {text("shadowname", "")}))), "none");
}

TEST(StandInLight, LargeIntensitiesFadeWithTheDistanceUnlessToldOtherwise) {
    EXPECT_EQ(number_of(stand_in_light(shader("lamp", {number("intensity", 1)})), "falloff"), 0);
    EXPECT_EQ(number_of(stand_in_light(shader("lamp", {number("intensity", 75)})), "falloff"), 2);
    EXPECT_EQ(number_of(stand_in_light(shader("arealight", {number("intensity", 1)})), "falloff"), 2);
    EXPECT_EQ(number_of(stand_in_light(shader("lamp", {number("intensity", 75), number("decayRate", 0)})),
                        "falloff"),
              0);
    EXPECT_EQ(number_of(stand_in_light(shader("lamp", {number("falloff", 2)})), "falloff"), 2);
    EXPECT_EQ(number_of(stand_in_light(shader("lamp", {number("falloff", 45)})), "falloff"), 0);
}

TEST(StandInLight, WhatItDoesNotKnowIsLeftOut) {
    ShaderInstance missing = shader("lamp", {number("wobble", 3), text("intensity", "bright")});
    missing.camera_from_shader[3][0] = 7;
    const ShaderInstance light = stand_in_light(missing);
    EXPECT_EQ(light.parameters.values.size(), 1u);  // falloff
    EXPECT_EQ(light.camera_from_shader[3][0], 7);
}

/// The scene is lit as by a pointlight that does not fade, and said once.
TEST(StandInLight, ShinesOnSurfaces) {
    ShadingScene scene;
    scene.surface("matte", {number("Ka", 0)});
    scene.light("lamp", {number("intensity", 2)});
    const ShadingGrid grid = scene.shaded();
    ASSERT_EQ(scene.reported.size(), 1u);
    EXPECT_EQ(scene.reported[0].text, "LightSource: there is no shader \"lamp\"; standinlight is used");
    for (size_t v = 0; v < grid.vertex_count(); ++v) {
        const V3f P = grid.P[0].at(v);  // from the origin; normals are towards it
        const float expected = 2 * P.z / P.length() * grid.Cs.at(v).x;
        EXPECT_NEAR(grid.Ci.at(v).x, expected, 1e-5f);
    }
}

}  // namespace
}  // namespace trapeze
