#include "shade/light_layers.h"

#include "core/scene/light_groups.h"
#include "shade/materials/shader_folder_harness.h"
#include "shade/shading_harness.h"

namespace trapeze {
namespace {

using testing::number;
using testing::point;
using testing::ShaderFolder;
using testing::ShadingScene;
using testing::text;

/// A lit, glowing surface under a light of each of two groups and an ambient one of none.
struct LitScene : ShadingScene {
    ShaderFolder folder;

    explicit LitScene(std::vector<std::string> groups) {
        folder.write("test",
                     "surface test() { normal n = faceforward(normalize(N), I); Oi = Os;"
                     "Ci = Os * Cs * (ambient() + diffuse(n) + specular(n, -normalize(I), .3)) + .125; }");
        scene.options.search_paths["shader"] = {folder.path(), "&"};
        surface("test");
        light("distantlight",
              {point("to", {1, -1, 2}), number("intensity", .75f), text("lightgroup", "key")});
        light("pointlight", {point("from", {2, 2, 1}), number("intensity", 3), text("lightgroup", "rim")});
        light("ambientlight", {number("intensity", .25f)});
        for (const std::string& group : groups) {
            Display display;
            display.variable = DisplayVariable{std::string(kLightGroupPrefix) + group, ValueType::Color};
            scene.options.displays.push_back(display);
        }
    }
};

V3f layer_at_vertex(const ShadingGrid& grid, size_t layer, size_t vertex) {
    return {grid.aovs[3 * layer][vertex], grid.aovs[3 * layer + 1][vertex], grid.aovs[3 * layer + 2][vertex]};
}

TEST(LightLayers, GroupsAddUpToTheWhole) {
    LitScene scene({"key", "rim", "default", "unlit"});
    EXPECT_EQ(light_groups(scene.scene), (std::vector<std::string>{"default", "key", "rim"}));
    const ShadingGrid grid = scene.shaded();
    EXPECT_TRUE(scene.reported.empty());
    LitScene plain({});
    const ShadingGrid whole = plain.shaded();
    ASSERT_EQ(grid.aovs.size(), 12u);
    for (size_t i = 0; i < grid.vertex_count(); ++i) {
        EXPECT_EQ(grid.Ci.at(i), whole.Ci.at(i)) << "the picture is the same";
        EXPECT_EQ(grid.Oi.at(i), whole.Oi.at(i));
        EXPECT_EQ(layer_at_vertex(grid, 3, i), V3f(.125f));
        V3f sum(0);
        for (size_t layer = 0; layer < 4; ++layer) sum += layer_at_vertex(grid, layer, i);
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(sum[c], whole.Ci.at(i)[c], 1e-5);
            EXPECT_GT(layer_at_vertex(grid, 0, i)[c], .01f);
        }
    }
}

TEST(LightLayers, AGroupIsThePictureOfItsLightsAlone) {
    LitScene scene({"rim", "unlit"});
    const ShadingGrid grid = scene.shaded();
    LitScene alone({});
    alone.attributes->lights.erase(alone.attributes->lights.begin());
    alone.attributes->lights.pop_back();
    const ShadingGrid expected = alone.shaded();
    for (size_t i = 0; i < grid.vertex_count(); ++i)
        EXPECT_EQ(layer_at_vertex(grid, 0, i), expected.Ci.at(i) - layer_at_vertex(grid, 1, i));
}

TEST(LightLayers, GroupsThatAreNotThereAreTold) {
    LitScene scene({"nobody", "unlit"});
    const ShadingGrid grid = scene.shaded();
    ASSERT_EQ(scene.reported.size(), 1u);
    EXPECT_NE(scene.reported[0].text.find("no light of the scene is of the group \"nobody\""),
              std::string::npos);
    for (size_t i = 0; i < grid.vertex_count(); ++i) EXPECT_EQ(layer_at_vertex(grid, 0, i), V3f(0));
}

TEST(LightLayers, AreColoursAlone) {
    EXPECT_FALSE(light_group_asked({"lightgroup:key", 1, 0}));
    EXPECT_FALSE(light_group_asked({"key", 3, 0}));
    EXPECT_EQ(light_group_asked({"lightgroup:key", 3, 0}), "key");
}

}  // namespace
}  // namespace trapeze
