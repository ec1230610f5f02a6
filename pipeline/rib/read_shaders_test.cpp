/// Shaders in layers, area lights.
#include "pipeline/rib/reading_harness.h"

namespace trapeze::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(ReadShaders, LayersAreGatheredInOrder) {
    const ReadOutcome r = read_world(
        "Surface \"matte\" "
        "ShaderLayer \"surface\" \"pattern\" \"a\" \"float freq\" [3] "
        "Translate 1 0 0 "
        "ShaderLayer \"surface\" \"noise\" \"b\" "
        "ConnectShaderLayers \"surface\" \"a\" \"mask\" \"b\" \"amount\" "
        "ShaderLayer \"surface\" \"paint\" \"c\" "
        "ConnectShaderLayers \"surface\" \"b\" \"out\" \"c\" \"in\" " +
        kSphere);
    EXPECT_THAT(r.messages, IsEmpty());
    const ShaderInstance& last = *r.attributes().surface;
    EXPECT_EQ(last.name, "paint");
    EXPECT_EQ(last.layer, "c");
    ASSERT_EQ(last.earlier_layers.size(), 2u);
    EXPECT_EQ(last.earlier_layers[0]->name, "pattern");
    EXPECT_THAT(last.earlier_layers[0]->parameters.find("freq")->floats, ElementsAre(3));
    EXPECT_EQ(last.earlier_layers[0]->camera_from_shader, M44f());
    EXPECT_EQ(last.earlier_layers[1]->layer, "b");
    EXPECT_EQ(last.earlier_layers[1]->camera_from_shader.translation(), V3f(1, 0, 0));
    EXPECT_TRUE(last.earlier_layers[1]->connections.empty());
    ASSERT_EQ(last.connections.size(), 2u);
    EXPECT_EQ(last.connections[0].from_variable, "mask");
    EXPECT_EQ(last.connections[1].from_layer, "b");
    EXPECT_EQ(last.connections[1].to_layer, "c");
    EXPECT_EQ(last.connections[1].to_variable, "in");
}

TEST(ReadShaders, ALayerOfTheSameNameIsReplacedAndBlocksRestoreLayers) {
    const ReadOutcome r = read_world(
        "ShaderLayer \"displacement\" \"one\" \"a\" AttributeBegin "
        "ShaderLayer \"displacement\" \"two\" \"b\" ShaderLayer \"displacement\" \"three\" \"a\" " +
        kSphere + "AttributeEnd " + kSphere + "Displacement \"plain\" " + kSphere);
    EXPECT_THAT(r.messages, IsEmpty());
    const ShaderInstance& inner = *r.attributes(0).displacement;
    EXPECT_EQ(inner.name, "three");
    ASSERT_EQ(inner.earlier_layers.size(), 1u);
    EXPECT_EQ(inner.earlier_layers[0]->name, "two");
    EXPECT_EQ(r.attributes(1).displacement->name, "one");
    EXPECT_TRUE(r.attributes(2).displacement->earlier_layers.empty());
}

TEST(ReadShaders, NullAndNoNameAreNoShader) {
    const ReadOutcome r = read_world(
        "Displacement \"dented\" Atmosphere \"fog\" Surface \"matte\" AttributeBegin "
        "Displacement \"null\" Atmosphere \"null\" Surface \"null\" " +
        kSphere + "AttributeEnd Displacement \"\" Surface \"\" " + kSphere);
    EXPECT_THAT(r.messages, IsEmpty());
    EXPECT_FALSE(r.attributes(0).displacement);
    EXPECT_FALSE(r.attributes(0).atmosphere);
    EXPECT_EQ(r.attributes(0).surface->name, "null");
    EXPECT_FALSE(r.attributes(1).displacement);
    EXPECT_FALSE(r.attributes(1).surface);
    EXPECT_EQ(r.attributes(1).atmosphere->name, "fog");
}

TEST(ReadShaders, WrongLayersAreReported) {
    const ReadOutcome r = read_world(
        "ShaderLayer \"light\" \"spot\" \"a\"\n"
        "ConnectShaderLayers \"surface\" \"a\" \"b\" \"c\" \"d\"\n"
        "ShaderLayer \"surface\" \"matte\"\n" +
        kSphere);
    ASSERT_EQ(r.messages.size(), 3u);
    EXPECT_THAT(r.messages[0], HasSubstr("\"light\" shaders have no layers"));
    EXPECT_THAT(r.messages[1], HasSubstr("a.rib:3"));
    EXPECT_THAT(r.messages[1], HasSubstr("no layers to connect"));
    EXPECT_THAT(r.messages[2], HasSubstr("a.rib:4"));
    EXPECT_EQ(r.count(), 1u);
}

TEST(ReadShaders, LayersEndSomewhere) {
    std::string text;
    for (int i = 0; i < 80; ++i) text += "ShaderLayer \"surface\" \"matte\" \"" + std::to_string(i) + "\"\n";
    const ReadOutcome r = read_world(text + kSphere);
    EXPECT_EQ(r.attributes().surface->earlier_layers.size(), 63u);
    EXPECT_FALSE(r.messages.empty());
}

TEST(ReadShaders, AreaLightsShineFromTheShapesThatFollow) {
    const ReadOutcome r = read_world(
        "AttributeBegin Translate 0 2 0 AreaLightSource \"pointlight\" 5 \"intensity\" [3] "
        "Polygon \"P\" [0 0 0  4 0 0  4 2 0] " +
        kSphere + "AttributeEnd Illuminate 5 1 AreaLightSource \"\" 6 " + kSphere +
        "AreaLightSource \"pointlight\" 7 \"from\" [1 2 3] Translate 5 5 5 " + kSphere);
    EXPECT_THAT(r.messages, IsEmpty());
    ASSERT_EQ(r.attributes(2).lights.size(), 1u);
    const LightInstance& light = *r.attributes(2).lights[0];
    EXPECT_EQ(light.shader.camera_from_shader.translation(), V3f(0, 2, 0));
    ASSERT_TRUE(light.shape.has_value());
    EXPECT_EQ(light.shape->kind, LightShape::Kind::Mesh);
    EXPECT_TRUE(light.shape->two_sided);
    EXPECT_EQ(light.shape->samples, 16);
    EXPECT_EQ(light.shape->camera_from_middle.translation(), V3f(2, 3, 0)) << "of the first shape";
    const auto& primitives = r.scene().primitives;
    EXPECT_EQ(primitives[0].emitter.get(), &light);
    EXPECT_EQ(primitives[1].emitter.get(), &light);
    EXPECT_EQ(primitives[2].emitter, nullptr) << "the attributes ended";
    ASSERT_EQ(r.attributes(3).lights.size(), 2u);
    EXPECT_EQ(r.attributes(3).lights[1]->shape->camera_from_middle.translation(), V3f(0, 0, 0));
}

TEST(ReadShaders, AreaLightsTakeTheirSamplesFromAttributes) {
    const auto samples = [](const std::string& attribute) {
        return read_world(attribute + " Sides 1 AreaLightSource \"arealight\" 5 " + kSphere + kSphere);
    };
    const ReadOutcome given = samples("Attribute \"light\" \"int nsamples\" [64]");
    EXPECT_THAT(given.messages, IsEmpty());
    EXPECT_EQ(given.attributes(1).lights[0]->shape->samples, 64);
    EXPECT_FALSE(given.attributes(1).lights[0]->shape->two_sided);
    EXPECT_EQ(samples("Attribute \"light\" \"int samples\" [3]").attributes(1).lights[0]->shape->samples, 3);
    for (const char* wrong : {"0", "-7", "100000"}) {
        const ReadOutcome r = samples(std::string("Attribute \"light\" \"int nsamples\" [") + wrong + "]");
        EXPECT_THAT(r.messages, ElementsAre(HasSubstr("must be 1 to 2048; 16 are used")));
        EXPECT_EQ(r.attributes(1).lights[0]->shape->samples, 16);
    }
}

TEST(ReadShaders, AreaLightsThatNothingSwitchesShineOnAll) {
    const std::string block = "AttributeBegin AreaLightSource \"pointlight\" 5 " + kSphere + "AttributeEnd ";
    const ReadOutcome stray = read_world(block + kSphere +
                                         "AttributeBegin AreaLightSource \"pointlight\" 6 "
                                         "AttributeEnd");
    EXPECT_EQ(stray.attributes(0).lights.size(), 1u);
    ASSERT_EQ(stray.attributes(1).lights.size(), 1u);  // the second light has no shape
    EXPECT_EQ(stray.attributes(1).lights[0]->handle, "5");
    EXPECT_THAT(stray.messages, ElementsAre(HasSubstr("light \"5\" is of a block")));

    const ReadOutcome switched =
        read_world(block + kSphere + "AttributeBegin Illuminate 5 1 " + kSphere + "AttributeEnd");
    EXPECT_EQ(switched.attributes(1).lights.size(), 0u);
    EXPECT_EQ(switched.attributes(2).lights.size(), 1u);
    const ReadOutcome open = read_world(kSphere + "AreaLightSource \"pointlight\" 5 " + kSphere + kSphere);
    EXPECT_EQ(open.attributes(0).lights.size(), 0u);
    EXPECT_EQ(open.attributes(2).lights.size(), 1u);
}

/// BMRT's, as others have it.
TEST(ReadShaders, LightsCastShadowsWhereAttributesSaySo) {
    const ReadOutcome r = read_world(
        "LightSource \"distantlight\" 1 Attribute \"light\" \"shadows\" \"on\" "
        "LightSource \"distantlight\" 2 \"intensity\" 3 LightSource \"pointlight\" 3 LightSource \"spotlight\" 4 "
        "LightSource \"own\" 5 " +
        kSphere + "Attribute \"render\" \"casts_shadows\" \"none\" " + kSphere +
        "Attribute \"render\" \"casts_shadows\" \"shade\" " + kSphere +
        "Attribute \"light\" \"shadows\" \"off\" LightSource \"spotlight\" 6 " + kSphere);
    EXPECT_TRUE(r.messages.empty());
    std::vector<std::string> names;
    for (const auto& light : r.attributes(3).lights) names.push_back(light->shader.name);
    EXPECT_THAT(
        names, ElementsAre("distantlight", "shadowdistant", "shadowpoint", "shadowspot", "own", "spotlight"));
    const ParameterList& traced = r.attributes(3).lights[1]->shader.parameters;
    EXPECT_EQ(traced.string_or("shadowname", ""), "raytrace");
    EXPECT_EQ(traced.float_or("intensity", 0), 3);
    EXPECT_EQ(r.attributes(3).lights[2]->shader.parameters.string_or("sfny", ""), "raytrace");
    EXPECT_TRUE(r.attributes(0).rays.transmission);
    EXPECT_EQ(r.attributes(0).rays.transmission_hits, RayAttributes::HitMode::Primitive);
    EXPECT_FALSE(r.attributes(1).rays.transmission);
    EXPECT_EQ(r.attributes(2).rays.transmission_hits, RayAttributes::HitMode::Shader);
}

TEST(ReadShaders, LightsMayLackHandles) {
    const ReadOutcome r = read_world(
        "LightSource \"pointlight\" \"intensity\" 3 \"from\" [1 2 3] "
        "LightSource \"ambientlight\" \"intensity\" [2] "
        "LightSource \"distantlight\" \"fill\" \"intensity\" [4] "
        "LightSource \"spotlight\" \"rim\" " +
        kSphere);
    EXPECT_THAT(r.messages, ElementsAre(HasSubstr("LightSource: the light has no handle")));
    const auto& lights = r.attributes().lights;
    ASSERT_EQ(lights.size(), 4u);
    EXPECT_EQ(lights[0]->shader.parameters.float_or("intensity", 0), 3);
    EXPECT_THAT(lights[0]->shader.parameters.find("from")->floats, ElementsAre(1, 2, 3));
    EXPECT_EQ(lights[1]->shader.parameters.float_or("intensity", 0), 2);
    EXPECT_EQ(lights[2]->handle, "fill");
    EXPECT_EQ(lights[2]->shader.parameters.float_or("intensity", 0), 4);
    EXPECT_EQ(lights[3]->handle, "rim");
}

}  // namespace
}  // namespace trapeze::testing
