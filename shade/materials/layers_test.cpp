#include "shade/materials/layers.h"

#include "shade/materials/shader_folder_harness.h"
#include "shade/shading_harness.h"

namespace trapeze {
namespace {

using testing::expect_near_triple;
using testing::number;
using testing::ShaderFolder;
using testing::ShadingScene;

/// A surface of two layers, of which the first computes a pattern.
struct LayeredScene {
    ShadingScene test;
    ShaderFolder folder;
    std::shared_ptr<ShaderInstance> first = std::make_shared<ShaderInstance>();
    std::shared_ptr<ShaderInstance> last = std::make_shared<ShaderInstance>();

    LayeredScene() {
        folder.write("pattern",
                     "surface pattern(float gain = 2; output varying float mask = 0;"
                     "                output varying color tint = 0;) {"
                     "  mask = gain * s; tint = color(s, t, 0.25); Ci = color(0.5, 0, 0); Oi = 1; }");
        folder.write("paint",
                     "surface paint(varying float amount = 7; color base = 3; uniform float fixed = 5;) {"
                     "  Ci += amount * base + color(0, 0, fixed); Oi = Os; }");
        test.scene.options.search_paths["shader"] = {folder.path()};
        first->name = "pattern", first->layer = "a";
        last->name = "paint", last->layer = "b";
        last->earlier_layers = {first};
        test.attributes->surface = last;
    }
};

TEST(Layers, OutputsBecomeParametersOfLaterLayers) {
    LayeredScene scene;
    scene.last->connections = {{"a", "mask", "b", "amount"}, {"a", "tint", "b", "base"}};
    const ShadingGrid grid = scene.test.shaded();
    for (size_t i = 0; i < grid.vertex_count(); ++i) {
        const float s = grid.s[i], t = grid.t[i], amount = 2 * s;
        // The later layer starts from the earlier one's Ci.
        expect_near_triple(grid.Ci.at(i), V3f(0.5f + amount * s, amount * t, amount * 0.25f + 5), 1e-6f);
        expect_near_triple(grid.Oi.at(i), grid.Os.at(i), 0);
    }
    EXPECT_TRUE(scene.test.reported.empty());
}

TEST(Layers, WithoutConnectionsParametersKeepTheirValues) {
    LayeredScene scene;
    const ShadingGrid grid = scene.test.shaded();
    for (size_t i = 0; i < grid.vertex_count(); ++i) expect_near_triple(grid.Ci.at(i), V3f(21.5f, 21, 26), 0);
}

TEST(Layers, TheSameShaderTwiceHasAFrameForEach) {
    LayeredScene scene;
    const auto middle = std::make_shared<ShaderInstance>(*scene.first);
    middle->layer = "c";
    middle->parameters.values = {number("gain", 100)};
    scene.last->earlier_layers = {scene.first, middle};
    scene.last->connections = {{"a", "mask", "b", "amount"}, {"c", "tint", "b", "base"}};
    const ShadingGrid grid = scene.test.shaded();
    for (size_t i = 0; i < grid.vertex_count(); ++i)
        EXPECT_NEAR(grid.Ci.at(i).x, 0.5f + 2 * grid.s[i] * grid.s[i], 1e-6f);
}

TEST(Layers, ConnectionsThatCannotBeAreReportedAndLeftOut) {
    LayeredScene scene;
    scene.last->connections = {{"x", "mask", "b", "amount"},  {"a", "mask", "y", "amount"},
                               {"b", "amount", "a", "gain"},  {"a", "nothing", "b", "amount"},
                               {"a", "mask", "b", "nothing"}, {"a", "tint", "b", "amount"}};
    const ShadingGrid grid = scene.test.shaded();
    ASSERT_EQ(scene.test.reported.size(), 6u);
    const char* expected[] = {
        "no layer \"x\"",          "no layer \"y\"",          "\"b\" does not run before",
        "no variable \"nothing\"", "no variable \"nothing\"", "different types"};
    for (size_t i = 0; i < 6; ++i)
        EXPECT_NE(scene.test.reported[i].text.find(expected[i]), std::string::npos)
            << scene.test.reported[i].text;
    expect_near_triple(grid.Ci.at(0), V3f(21.5f, 21, 26), 0);
}

TEST(Layers, PredefinedVariablesOfLaterLayersTakeOutputs) {
    LayeredScene scene;
    scene.folder.write("show",
                       "surface show(output varying color seen = 0;) {"
                       "  Ci = Cs * comp(Os, 0) + color(0, xcomp(N), 0); Oi = Os; }");
    scene.last->name = "show";
    // What the shader does not look at may be connected, too.
    scene.last->connections = {
        {"a", "tint", "b", "Cs"}, {"a", "tint", "b", "Os"}, {"a", "tint", "b", "N"}, {"a", "mask", "b", "u"}};
    const ShadingGrid grid = scene.test.shaded();
    EXPECT_TRUE(scene.test.reported.empty()) << scene.test.reported[0].text;
    for (size_t i = 0; i < grid.vertex_count(); ++i) {
        const V3f tint(grid.s[i], grid.t[i], 0.25f);
        expect_near_triple(grid.Ci.at(i), tint * tint.x + V3f(0, tint.x, 0), 1e-6f);
        expect_near_triple(grid.Oi.at(i), tint, 0);
    }
}

TEST(Layers, AMissingLayerIsReportedAndLeftOut) {
    LayeredScene scene;
    scene.first->name = "nowhere";
    const ShadingGrid grid = scene.test.shaded();
    ASSERT_EQ(scene.test.reported.size(), 1u);
    EXPECT_NE(scene.test.reported[0].text.find("ShaderLayer"), std::string::npos);
    // Nothing has set Ci before the last layer: black.
    expect_near_triple(grid.Ci.at(0), V3f(21, 21, 26), 1e-5f);
}

}  // namespace
}  // namespace trapeze
