#include "shade/made_variables.h"

#include "shade/materials/shader_folder_harness.h"
#include "shade/shading_harness.h"

namespace trapeze {
namespace {

using testing::ShaderFolder;
using testing::ShadingScene;

TEST(MadeVariables, AlbedoIsTheColourWithoutLightUnlessAShaderSaysAnother) {
    for (const bool says : {false, true}) {
        ShaderFolder folder;
        folder.write("test", says ? "surface test(output varying color albedo = 0;)"
                                    "{ albedo = color(s, t, .5); Ci = 7; Oi = Os; }"
                                  : "surface test() { Ci = 7; Oi = Os; }");
        ShadingScene scene;
        scene.scene.options.search_paths["shader"] = {folder.path()};
        scene.surface("test", {});
        Display display;
        display.variable = DisplayVariable{"albedo", ValueType::Color};
        scene.scene.options.displays = {display};
        const ShadingGrid grid = scene.shaded();
        EXPECT_TRUE(scene.reported.empty());
        ASSERT_EQ(grid.aovs.size(), 3u);
        for (size_t i = 0; i < grid.vertex_count(); ++i) {
            const V3f expected = says ? V3f(grid.s[i], grid.t[i], .5f) : grid.Cs.at(i) * grid.Os.at(i);
            EXPECT_EQ(V3f(grid.aovs[0][i], grid.aovs[1][i], grid.aovs[2][i]), expected);
        }
    }
}

TEST(MadeVariables, MotionIsInPixelsFromOpenToClose) {
    Options options;
    options.width = 40, options.height = 30;
    options.projection = "perspective", options.fov = 90, options.near_clip = .1f;
    const Camera camera = make_camera(options);
    ShadingGrid grid;
    grid.shape = {1, 0};
    grid.key_count = 3;
    grid.P.resize(3);
    for (Triples& places : grid.P) places.resize(2);
    grid.P[0].set(0, {0, 0, 2}), grid.P[1].set(0, {50, 50, 2}), grid.P[2].set(0, {1, .5f, 1});
    grid.P[0].set(1, {0, 0, -1}), grid.P[2].set(1, {0, 0, 2});
    const Aov motion{"motion", 3, 0};
    grid.aovs.resize(3);
    ASSERT_TRUE(is_made_variable(motion));
    make_variable(motion, camera, grid);
    // 30 rows are 90 degrees: 15 pixels for each unit at depth 1; up is up.
    EXPECT_NEAR(grid.aovs[0][0], 15, 1e-4);
    EXPECT_NEAR(grid.aovs[1][0], 7.5, 1e-4);
    EXPECT_EQ(grid.aovs[2][0], -1);
    for (int c = 0; c < 3; ++c) EXPECT_EQ(grid.aovs[c][1], 0) << "behind the lens";
    grid.P.resize(1);
    make_variable(motion, camera, grid);
    for (int c = 0; c < 3; ++c) EXPECT_EQ(grid.aovs[c][0], 0) << "stands still";
}

TEST(MadeVariables, OfThreeNumbersAlone) {
    EXPECT_FALSE(is_made_variable({"albedo", 1, 0}));
    EXPECT_FALSE(is_made_variable({"N", 3, 0}));
}

}  // namespace
}  // namespace trapeze
