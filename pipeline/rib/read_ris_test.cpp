/// The path tracer's surfaces and lights (RIS), as the shading language's.
#include <cmath>

#include "pipeline/rib/reading_harness.h"

namespace trapeze::testing {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::string kBall = "Sphere 1 -1 1 360\n";

ReadOutcome read_ris_world(const std::string& text) {
    ReadOutcome outcome = read_text("WorldBegin\n" + text + "WorldEnd\n");
    EXPECT_LE(outcome.messages.size(), 1u);  // that surfaces of RIS are not run
    EXPECT_EQ(outcome.worlds.size(), 1u);
    return outcome;
}

std::vector<float> numbers(const ShaderInstance& shader, const char* name) {
    const Parameter* found = shader.parameters.find(name);
    return found ? found->floats : std::vector<float>{};
}

std::string text_of(const ShaderInstance& shader, const char* name) {
    return shader.parameters.string_or(name, "");
}

TEST(ReadRis, PatternsGiveTheMeanOfTheirColours) {
    const ReadOutcome r = read_ris_world(
        "Pattern \"PxrMix\" \"m\" \"color color1\" [1 0 0] \"color color2\" [0 0 1] \"float mix\" [.5]\n"
        "Pattern \"PxrHSL\" \"h\" \"reference color inputRGB\" [\"m:resultRGB\"]\n"
        "Bxdf \"PxrDisney\" \"b\" \"reference color baseColor\" [\"h:resultRGB\"]\n" +
        kBall + "Bxdf \"PxrDiffuse\" \"b\" \"reference color diffuseColor\" [\"nowhere:resultRGB\"]\n" +
        kBall +
        "Pattern \"PxrBump\" \"loop\" \"reference color a\" [\"loop:result\"] \"color c\" [.2 .4 .6]\n"
        "Bxdf \"PxrDiffuse\" \"b\" \"reference color diffuseColor\" [\"loop:result\"]\n" +
        kBall);
    EXPECT_EQ(r.attributes(0).color, V3f(0.5f, 0, 0.5f));
    EXPECT_EQ(r.attributes(1).color, V3f(0.5f, 0.5f, 0.5f));
    EXPECT_NEAR(r.attributes(2).color.y, 0.4f, 1e-6f);
}

TEST(ReadRis, TexturesAreThoseOfPatterns) {
    const ReadOutcome r = read_ris_world(
        "Pattern \"PxrManifold2D\" \"m\" \"float scaleS\" [4] \"float scaleT\" [2]\n"
        "Pattern \"PxrTexture\" \"t\" \"string filename\" [\"wood.tex\"] \"int linearize\" [1] "
        "\"reference struct manifold\" [\"m:result\"]\n"
        "Pattern \"PxrColorCorrect\" \"c\" \"reference color inputRGB\" [\"t:resultRGB\"]\n"
        "Bxdf \"PxrSurface\" \"b\" \"reference color diffuseColor\" [\"c:resultRGB\"]\n" +
        kBall);
    EXPECT_EQ(text_of(*r.attributes().surface, "texturename"), "wood.tex");
    EXPECT_EQ(text_of(*r.attributes().surface, "colorspace"), "srgb");
    EXPECT_EQ(numbers(*r.attributes().surface, "scales"), (std::vector<float>{4}));
    EXPECT_EQ(numbers(*r.attributes().surface, "scalet"), (std::vector<float>{2}));
    EXPECT_EQ(r.attributes().color, V3f(1, 1, 1));
}

TEST(ReadRis, MetalsHaveTheColourThatTheyReflect) {
    const ReadOutcome r = read_ris_world(
        "Bxdf \"PxrSurface\" \"gold\" \"float diffuseGain\" [0] \"color specularFaceColor\" [1 .75 .25]\n" +
        kBall +
        "Bxdf \"PxrSurface\" \"silver\" \"float diffuseGain\" [0] \"int specularFresnelMode\" [1] "
        "\"color specularEdgeColor\" [1 1 1] \"color specularIor\" [3 3 3] "
        "\"color specularExtinctionCoeff\" [0 0 0]\n" +
        kBall);
    EXPECT_NEAR(r.attributes(0).color.y, 0.6f, 1e-6f);
    // ((3 - 1) / (3 + 1))^2 = 1/4
    EXPECT_EQ(numbers(*r.attributes(1).surface, "specularcolor"), (std::vector<float>{.25f, .25f, .25f}));
}

TEST(ReadRis, WhatIsReflectedMayBeAPatterns) {
    const ReadOutcome r = read_ris_world(
        "Pattern \"PxrMix\" \"B\" \"color color1\" [1 .75 .25]\n"
        "Bxdf \"PxrSurface\" \"gold\" \"float diffuseGain\" [0] \"reference color specularFaceColor\" "
        "[\"B:resultRGB\"]\n" +
        kBall +
        "Bxdf \"PxrSurface\" \"lamp\" \"float glowGain\" [2] \"reference color glowColor\" [\"B:resultRGB\"]\n" +
        kBall);
    EXPECT_NEAR(r.attributes(0).color.y, 0.6f, 1e-6f);
    EXPECT_EQ(numbers(*r.attributes(1).surface, "emission"), (std::vector<float>{2, 1.5f, .5f}));
}

/// As RenderMan for Maya writes it: the second names the first.
TEST(ReadRis, MaterialsAreKnownByTheirIds) {
    const ReadOutcome r = read_ris_world(
        "AttributeBegin Bxdf \"PxrSurface\" \"s\" \"color diffuseColor\" [.1 .2 .3] "
        "\"string __materialid\" [\"s1SG\"] AttributeEnd\n"
        "Bxdf \"PxrSurface\" \"s\" \"string __materialid\" [\"s1SG\"]\n" +
        kBall);
    EXPECT_EQ(r.attributes().color, V3f(0.1f, 0.2f, 0.3f));
}

TEST(ReadRis, LayersAreTheMeanOfWhatTheyAreMadeOf) {
    const ReadOutcome r = read_ris_world(
        "Bxdf \"LamaDiffuse\" \"d\" \"color color\" [0 .5 0]\n"
        "Bxdf \"LamaSurface\" \"s\" \"reference bxdf materialFront\" [\"d\"]\n" +
        kBall);
    EXPECT_EQ(r.attributes().color, V3f(0, 0.5f, 0));
}

TEST(ReadRis, LightsShineOnAllOfTheWorld) {
    const ReadOutcome r =
        read_ris_world("Bxdf \"PxrDiffuse\" \"b\"\n" + kBall +
                       "AttributeBegin Translate 0 5 0 Rotate 90 1 0 0 Light \"PxrRectLight\" "
                       "\"key\" \"float exposure\" [3] "
                       "\"intensity\" [2] \"color lightColor\" [1 .5 .25] AttributeEnd\n" +
                       kBall);
    for (size_t i = 0; i < 2; ++i) {
        ASSERT_EQ(r.attributes(i).lights.size(), 1u);
        const ShaderInstance& light = r.attributes(i).lights[0]->shader;
        EXPECT_EQ(light.name, "rislight");
        EXPECT_EQ(numbers(light, "lightcolor"), (std::vector<float>{16, 8, 4}));
        EXPECT_EQ(r.attributes(i).lights[0]->shape->kind, LightShape::Kind::Rect);
        EXPECT_EQ(light.camera_from_shader.translation(), V3f(0, 5, 0));
    }
}

TEST(ReadRis, IlluminateSwitchesLightsOff) {
    const ReadOutcome r =
        read_ris_world("Light \"PxrRectLight\" \"key\" Light \"PxrSphereLight\" \"rim\" Surface \"matte\"\n" +
                       kBall + "AttributeBegin Illuminate \"key\" 0\n" + kBall + "Illuminate \"key\" 1\n" +
                       kBall + "AttributeEnd\n" + kBall + "ObjectBegin 1 Illuminate \"rim\" 0\n" + kBall +
                       "ObjectEnd ObjectInstance 1\n");
    std::vector<std::string> lit;
    for (size_t i = 0; i < r.count(); ++i) {
        if (r.attributes(i).surface->name == "rislightsurface") continue;
        std::string& names = lit.emplace_back();
        for (const auto& light : r.attributes(i).lights) names += light->handle + ' ';
    }
    EXPECT_EQ(lit, (std::vector<std::string>{"key rim ", "rim ", "key rim ", "key rim ", "key "}));
}

TEST(ReadRis, ALightOfAnObjectShinesWhereItIsPlaced) {
    const ReadOutcome r = read_ris_world(
        "Bxdf \"PxrDiffuse\" \"b\"\n" + kBall +
        "ObjectBegin \"lamp\" Translate 0 1 0 Light \"PxrSphereLight\" \"l\" ObjectEnd\n"
        "AttributeBegin Translate 7 0 0 ObjectInstance \"lamp\" AttributeEnd\n"
        "AttributeBegin Attribute \"lighting\" \"int mute\" [1] Light \"PxrDistantLight\" \"off\" "
        "AttributeEnd\n");
    ASSERT_EQ(r.attributes().lights.size(), 1u);
    EXPECT_EQ(r.attributes().lights[0]->shader.camera_from_shader.translation(), V3f(7, 1, 0));
}

/// By itself, with the object that it belongs to, or by both.
TEST(ReadRis, ALightMovesWithItsSpace) {
    const std::string right = "MotionBegin [0 1] Translate 0 0 0 Translate 4 0 0 MotionEnd ";
    const std::string up = "MotionBegin [0 1] Translate 0 0 0 Translate 0 8 0 MotionEnd ";
    const auto end_of = [&](const std::string& lights) {
        const ReadOutcome r =
            read_text("Shutter 0 1 WorldBegin Bxdf \"PxrDiffuse\" \"b\" " + kBall + lights + "WorldEnd");
        const std::vector<M44f>& keys = r.attributes().lights[0]->moving_space;
        EXPECT_TRUE(keys.empty() || keys.front() == r.attributes().lights[0]->shader.camera_from_shader);
        return keys.empty() ? V3f(-1) : keys.back().translation();
    };
    const std::string light = " Light \"PxrSphereLight\" \"l\" ";
    EXPECT_EQ(end_of(light), V3f(-1));
    EXPECT_EQ(end_of(right + light), V3f(4, 0, 0));
    EXPECT_EQ(end_of("ObjectBegin \"o\"" + light + "ObjectEnd " + up + "ObjectInstance \"o\" "),
              V3f(0, 8, 0));
    EXPECT_EQ(end_of("ObjectBegin \"o\" " + right + light + "ObjectEnd " + up + "ObjectInstance \"o\" "),
              V3f(4, 8, 0));
}

/// As paths do: each has its time.
TEST(ReadRis, RaysOfBxdfsMeetWhatMovesWhereverItGoes) {
    const auto samples_motion = [&](const std::string& before) {
        return read_text(before + "WorldBegin Bxdf \"PxrDiffuse\" \"b\" " + kBall + "WorldEnd")
            .attributes()
            .rays.sample_motion;
    };
    EXPECT_FALSE(samples_motion(""));
    EXPECT_TRUE(samples_motion("Shutter 0 1 "));
    EXPECT_FALSE(samples_motion("Shutter 0 1 Attribute \"trace\" \"int samplemotion\" [0] "));
    EXPECT_FALSE(read_text("Shutter 0 1 WorldBegin Surface \"matte\" " + kBall + "WorldEnd")
                     .attributes()
                     .rays.sample_motion);
}

TEST(ReadRis, LightsOfUnknownNamesAreReportedAndDoNotShine) {
    const ReadOutcome r = read_ris_world(
        "Light \"PxrNoSuchLight\" \"a\"\nLight \"PxrNoSuchLight\" \"b\"\n"
        "Light \"PxrCylinderLight\" \"c\"\n" +
        kBall);
    ASSERT_EQ(r.attributes().lights.size(), 1u);
    EXPECT_EQ(r.attributes().lights[0]->handle, "c");
    EXPECT_EQ(r.attributes().lights[0]->shape->kind, LightShape::Kind::Cylinder);
    EXPECT_THAT(r.messages,
                ElementsAre(AllOf(HasSubstr("2:1: warning"), HasSubstr("no light \"PxrNoSuchLight\""))));
}

/// Intensity is the radiance of a disk: half a right angle to each side of the direction has sin^2 = 1/2.
TEST(ReadRis, DistantLightsAreDisksInTheSky) {
    const auto brightness = [](const std::string& parameters) {
        const ReadOutcome r = read_ris_world("Light \"PxrDistantLight\" \"sun\" " + parameters +
                                             " Bxdf \"PxrDiffuse\" \"b\"\n" + kBall);
        EXPECT_EQ(r.attributes().lights.size(), 1u);
        return numbers(r.attributes().lights[0]->shader, "lightcolor")[0];
    };
    EXPECT_NEAR(brightness(""), 1.07f, 0.01f);
    EXPECT_NEAR(brightness("\"float exposure\" [1]"), 2.14f, 0.02f);
    EXPECT_NEAR(brightness("\"float intensity\" [3] \"float angleExtent\" [90]"), 1.5f, 1e-5f);
    EXPECT_NEAR(brightness("\"float angleExtent\" [90] \"int areaNormalize\" [1]"), 1.07f, 0.01f);
    EXPECT_EQ(brightness("\"float angleExtent\" [0]"), 0);
    EXPECT_EQ(brightness("\"float intensity\" [2]"), 2);
    const ReadOutcome r =
        read_ris_world("Light \"PxrDistantLight\" \"sun\" \"float angleExtent\" [90] \n" + kBall);
    EXPECT_EQ(r.attributes().lights[0]->shape->kind, LightShape::Kind::Distant);
    EXPECT_NEAR(r.attributes().lights[0]->shape->angle, 0.785398f, 1e-6f);
}

TEST(ReadRis, LightsSayHowManySamplesAndShadowsTheyHave) {
    const ReadOutcome r = read_ris_world(
        "Light \"PxrDiskLight\" \"a\" \"int fixedSampleCount\" [9] \"int enableShadows\" [0]\n"
        "Attribute \"light\" \"int nsamples\" [40] Light \"PxrSphereLight\" \"b\"\n" +
        kBall);
    ASSERT_EQ(r.attributes().lights.size(), 2u);
    EXPECT_EQ(r.attributes().lights[0]->shape->samples, 9);
    EXPECT_EQ(numbers(r.attributes().lights[0]->shader, "traceshadows"), (std::vector<float>{0}));
    EXPECT_EQ(r.attributes().lights[1]->shape->samples, 40);
}

/// In path tracers all is in the way of light; so are Bxdfs here, unless they say otherwise.
TEST(ReadRis, BxdfsCastShadowsOfAreaLights) {
    const std::string light = "Light \"PxrSphereLight\" \"l\"\n", bxdf = "Bxdf \"PxrDiffuse\" \"b\"\n";
    const auto is_in_the_way = [](const std::string& world) {
        return read_ris_world(world).attributes().rays.transmission;
    };
    EXPECT_TRUE(is_in_the_way(light + bxdf + kBall));
    EXPECT_FALSE(is_in_the_way(bxdf + kBall)) << "nothing asks for rays";
    EXPECT_FALSE(is_in_the_way(light + kBall)) << "no Bxdf";
    EXPECT_FALSE(is_in_the_way(light + bxdf + "Attribute \"visibility\" \"int transmission\" [0]\n" + kBall));
    // Behind all else, so that what is random elsewhere stays.
    EXPECT_FALSE(read_ris_world(light + bxdf + kBall).attributes(1).rays.seen()) << "no ray meets the light";
}

TEST(ReadRis, DomesAreTheSkyWithTheirMaps) {
    const ReadOutcome r = read_ris_world(
        "Light \"PxrDomeLight\" \"d\" \"float intensity\" [2] \"string lightColorMap\" [\"sky.tex\"]\n"
        "Bxdf \"PxrDiffuse\" \"b\"\n" +
        kBall);
    const auto& lights = r.attributes().lights;
    ASSERT_EQ(lights.size(), 1u);
    EXPECT_EQ(lights[0]->shader.name, "rislight");
    EXPECT_EQ(numbers(lights[0]->shader, "lightcolor"), (std::vector<float>{2, 2, 2}));
    EXPECT_EQ(numbers(lights[0]->shader, "isdistant"), (std::vector<float>{1}));
    EXPECT_EQ(lights[0]->shape->kind, LightShape::Kind::Dome);
    EXPECT_EQ(lights[0]->shape->map, "sky.tex");
}

TEST(ReadRis, AreaLightsOfFarGeometryShineFromAfar) {
    const ReadOutcome dome = read_ris_world(
        "AttributeBegin AreaLightSource \"PxrStdAreaLight\" \"a\" \"float exposure\" [1]\n"
        "Scale 2 2 2 Geometry \"envsphere\" AttributeEnd\n"
        "Bxdf \"PxrDiffuse\" \"b\"\n" +
        kBall);
    const auto& lights = dome.attributes().lights;
    ASSERT_EQ(lights.size(), 1u);
    EXPECT_EQ(lights[0]->shape->kind, LightShape::Kind::Dome);
    EXPECT_EQ(numbers(lights[0]->shader, "lightcolor"), (std::vector<float>{2, 2, 2}));

    const ReadOutcome sun = read_ris_world(
        "AttributeBegin AreaLightSource \"PxrStdAreaLight\" \"a\" \"color lightColor\" [1 .5 0]\n"
        "Geometry \"distantlight\" AttributeEnd\n"
        "Bxdf \"PxrDiffuse\" \"b\"\n" +
        kBall);
    ASSERT_EQ(sun.attributes().lights.size(), 1u);
    const ShaderInstance& light = sun.attributes().lights[0]->shader;
    EXPECT_EQ(sun.attributes().lights[0]->shape->kind, LightShape::Kind::Distant);
    EXPECT_EQ(numbers(light, "lightcolor"), (std::vector<float>{1, 0.5f, 0}));
    EXPECT_EQ(light.camera_from_shader[2][2], -1) << "it shines along -z of its geometry";

    const ReadOutcome disk = read_ris_world(
        "AttributeBegin AreaLightSource \"PxrStdAreaLight\" \"a\" \"float intensity\" [20]\n"
        "Geometry \"distantlight\" \"constant float anglesubtended\" [90] AttributeEnd\n"
        "Bxdf \"PxrDiffuse\" \"b\"\n" +
        kBall);
    EXPECT_NEAR(numbers(disk.attributes().lights[0]->shader, "lightcolor")[0], 10, 1e-5f);
}

/// The light of older versions, and its geometry: a square at (3, 2, 0) in the plane y = 2.
TEST(ReadRis, AreaLightsShineFromTheirGeometry) {
    const ReadOutcome r = read_ris_world(
        "AttributeBegin AreaLightSource \"PxrStdAreaLight\" \"a\" \"float exposure\" [1]\n"
        "Bxdf \"PxrLightEmission\" \"e\" Translate 3 2 0\n"
        "Polygon \"P\" [-1 0 -1  1 0 -1  1 0 1  -1 0 1]\n" +
        kBall +
        "AttributeEnd\n"
        "Bxdf \"PxrDiffuse\" \"b\"\n" +
        kBall);
    ASSERT_EQ(r.attributes(2).lights.size(), 1u);
    const LightInstance& light = *r.attributes(2).lights[0];
    EXPECT_EQ(light.shape->kind, LightShape::Kind::Mesh);
    EXPECT_TRUE(light.shape->two_sided) << "for it is flat";
    EXPECT_EQ(r.scene().primitives[0].emitter.get(), &light);
    EXPECT_EQ(r.scene().primitives[2].emitter, nullptr);
    EXPECT_EQ(r.attributes(0).surface->name, "constant");
}

/// Each instance is a light of its own, also in objects of objects.
TEST(ReadRis, AreaLightsOfObjectsShineFromTheirInstances) {
    const ReadOutcome r = read_ris_world(
        "ObjectBegin \"lamp\" Translate 3 2 0\n"
        "AreaLightSource \"PxrStdAreaLight\" \"a\" Polygon \"P\" [-1 0 -1  1 0 -1  1 0 1  -1 0 1]\n"
        "ObjectEnd ObjectBegin \"pair\" ObjectInstance \"lamp\" " +
        kBall +
        "ObjectEnd AttributeBegin Translate 1 0 0 ObjectInstance \"lamp\" AttributeEnd\n"
        "ObjectInstance \"pair\" Bxdf \"PxrDiffuse\" \"b\"\n" +
        kBall);
    ASSERT_EQ(r.scene().primitives.size(), 4u);
    const auto& lights = r.attributes(3).lights;
    ASSERT_EQ(lights.size(), 2u);
    for (const auto& light : lights) {
        EXPECT_EQ(light->shape->kind, LightShape::Kind::Mesh);
        EXPECT_TRUE(light->shape->two_sided) << "for it is flat";
    }
    EXPECT_EQ(r.scene().primitives[0].emitter, lights[0]);
    EXPECT_EQ(r.scene().primitives[1].emitter, lights[1]);
    EXPECT_EQ(r.scene().primitives[2].emitter, nullptr);
    EXPECT_EQ(r.scene().primitives[3].emitter, nullptr);
}

TEST(ReadRis, WhereNothingLightsBxdfsTheEyeDoes) {
    const ReadOutcome r = read_ris_world(kBall + "Bxdf \"PxrDiffuse\" \"b\"\n" + kBall);
    EXPECT_THAT(r.attributes(0).lights, IsEmpty());
    ASSERT_EQ(r.attributes(1).lights.size(), 1u);
    EXPECT_EQ(r.attributes(1).lights[0]->shader.name, "distantlight");
}

/// Each pattern asks for the one before it a hundred times: 100^8 ways to its colour.
TEST(ReadRis, NetworksThatBranchEverywhereEnd) {
    std::string text = "Pattern \"PxrColor\" \"p0\" \"color c\" [1 .5 0]\n";
    for (int i = 1; i < 8; ++i) {
        text += "Pattern \"PxrMix\" \"p" + std::to_string(i) + "\"";
        for (int k = 0; k < 100; ++k)
            text += " \"reference color c" + std::to_string(k) + "\" [\"p" + std::to_string(i - 1) + ":x\"]";
        text += "\n";
    }
    const ReadOutcome r = read_ris_world(
        text + "Bxdf \"PxrDiffuse\" \"b\" \"reference color diffuseColor\" [\"p7:x\"]\n" + kBall);
    EXPECT_NEAR(r.attributes().color.y, 0.5f, 1e-5f);
}

TEST(ReadRis, ThereIsAnEndOfLights) {
    std::string text = "ObjectBegin \"o\"\n";
    for (int i = 0; i < 100; ++i) text += "Light \"PxrSphereLight\" \"l" + std::to_string(i) + "\"\n";
    text += "ObjectEnd\n";
    for (int i = 0; i < 100; ++i) text += "ObjectInstance \"o\"\n";
    const ReadOutcome r = read_text("WorldBegin " + text + "Bxdf \"PxrDiffuse\" \"b\" " + kBall + "WorldEnd");
    EXPECT_EQ(r.attributes().lights.size(), 64u);
    ASSERT_EQ(r.messages.size(), 2u);
    EXPECT_THAT(r.messages[0], HasSubstr("more than 64 lights"));
}

TEST(ReadRis, LightsBeyondThatEndAreNotSeenEither) {
    std::string text;
    for (int i = 0; i < 66; ++i) text += "Light \"PxrSphereLight\" \"l" + std::to_string(i) + "\"\n";
    const ReadOutcome r = read_world(text + "Bxdf \"PxrDiffuse\" \"b\"\n" + kBall);
    EXPECT_EQ(r.attributes(0).lights.size(), 64u);
    ASSERT_EQ(r.count(), 1u + 64u);
    EXPECT_EQ(r.attributes(0).surface->name, "rissurface");
    EXPECT_EQ(r.attributes(64).surface->name, "rislightsurface");
}

/// Lights shine, which nothing has to be said about.
TEST(ReadRis, LightsAloneAreNoCauseForWarnings) {
    EXPECT_THAT(read_ris_world("Light \"PxrRectLight\" \"l\" \"float intensity\" [2]\n" + kBall).messages,
                IsEmpty());
}

TEST(ReadRis, WhatLightsIgnoreIsWarnedOf) {
    EXPECT_THAT(read_ris_world("Light \"PxrRectLight\" \"l\" \"string lightColorMap\" [\"sky.tex\"]\n"
                               "Light \"PxrRectLight\" \"m\" \"string lightColorMap\" [\"\"]\n" +
                               kBall)
                    .messages,
                ElementsAre(HasSubstr("only domes have a \"lightColorMap\": \"PxrRectLight\" shines")));
    const ReadOutcome day = read_ris_world("Light \"PxrEnvDayLight\" \"l\"\n" + kBall);
    EXPECT_THAT(day.messages, ElementsAre(HasSubstr("sun and sky of \"PxrEnvDayLight\" are not known")));
    EXPECT_EQ(day.attributes().lights[0]->shape->kind, LightShape::Kind::Dome);
}

TEST(ReadRis, BxdfsAreShadedOnceAPixelAtLeast) {
    const ReadOutcome r = read_ris_world("ShadingRate 20\n" + kBall + "Bxdf \"PxrDiffuse\" \"b\"\n" + kBall +
                                         "ShadingRate .25\n" + kBall);
    EXPECT_EQ(r.attributes(0).shading_rate, 20);
    EXPECT_EQ(r.attributes(1).shading_rate, 1);
    EXPECT_EQ(r.attributes(2).shading_rate, 0.25f);
}

TEST(ReadRis, OddParametersAreNoErrors) {
    const ReadOutcome r = read_ris_world(
        "Bxdf \"PxrSurface\" \"s\" \"int[] utilityPattern\" [] \"float presence\" 1 \"x\" [\"y\"] "
        "\"color diffuseColor\" .1 .2 .3 \"color specularFaceColor\" [0]\n" +
        kBall);
    EXPECT_THAT(r.messages, ElementsAre(HasSubstr("RIS shading is not supported")));
    EXPECT_EQ(r.attributes().color, V3f(0.1f, 0.2f, 0.3f));
    EXPECT_THAT(read_text("WorldBegin Bxdf \"PxrSurface\" \"s\" \"color x\" WorldEnd").messages,
                ElementsAre(HasSubstr("\"color x\" has no value")));
}

}  // namespace
}  // namespace trapeze::testing
