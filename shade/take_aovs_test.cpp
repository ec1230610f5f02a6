#include "shade/take_aovs.h"

#include "shade/materials/shader_folder_harness.h"
#include "shade/shading_harness.h"

namespace trapeze {
namespace {

using testing::number;
using testing::shader;
using testing::ShaderFolder;
using testing::ShadingScene;

/// A scene whose surface is this source, named test.
struct AovScene : ShadingScene {
    ShaderFolder folder;

    explicit AovScene(const std::string& source, std::vector<Parameter> parameters = {}) {
        folder.write("test", source);
        scene.options.search_paths["shader"] = {folder.path()};
        surface("test", std::move(parameters));
    }
    AovScene& wants(std::string name, ValueType type) {
        Display display;
        display.variable = DisplayVariable{std::move(name), type};
        scene.options.displays.push_back(display);
        return *this;
    }
};

TEST(TakeAovs, ParametersAndWhatGridsHave) {
    AovScene scene(
        "surface test(float k = 3; output varying color lit = 0; output float half = 0; output color unset = "
        "color(1, 2, 3);) { lit = color(s, t, k); half = k / 2; Ci = Cs; Oi = 1; }",
        {number("k", 5)});
    scene.wants("lit", ValueType::Color).wants("half", ValueType::Float).wants("unset", ValueType::Color);
    scene.wants("k", ValueType::Float).wants("P", ValueType::Point).wants("N", ValueType::Normal);
    scene.wants("t", ValueType::Float).wants("Ci", ValueType::Color);
    const ShadingGrid grid = scene.shaded();
    EXPECT_TRUE(scene.reported.empty());
    const size_t count = grid.vertex_count();
    ASSERT_EQ(grid.aovs.size(), 3u + 1 + 3 + 1 + 3 + 3 + 1 + 3);
    for (const std::vector<float>& plane : grid.aovs) ASSERT_EQ(plane.size(), count);
    for (size_t i = 0; i < count; ++i) {
        const auto triple_at = [&](size_t channel) {
            return V3f(grid.aovs[channel][i], grid.aovs[channel + 1][i], grid.aovs[channel + 2][i]);
        };
        EXPECT_EQ(triple_at(0), V3f(grid.s[i], grid.t[i], 5));
        EXPECT_EQ(grid.aovs[3][i], 2.5f);
        EXPECT_EQ(triple_at(4), V3f(1, 2, 3));
        EXPECT_EQ(grid.aovs[7][i], 5);
        EXPECT_EQ(triple_at(8), grid.P[0].at(i));
        EXPECT_EQ(triple_at(11), V3f(0, 0, -1));
        EXPECT_EQ(grid.aovs[14][i], grid.t[i]);
        EXPECT_EQ(triple_at(15), V3f(0.8f, 0.4f, 0.2f));
    }
}

TEST(TakeAovs, OutputsOfDisplacementsAndOfEarlierLayers) {
    AovScene scene(
        "surface test(float k = 3; output varying float both = 1;) { both = s; Ci = Cs; Oi = 1; }");
    scene.folder.write("bump",
                       "displacement bump(float own = 5; output varying float height = 0, both = 7;"
                       "                  output varying color k = 0;) { height = t; k = color(s, t, 1); }");
    scene.folder.write("first", "surface first(output varying float early = 0;) { early = s + t; }");
    scene.displacement("bump");
    const auto first = std::make_shared<ShaderInstance>(shader("first"));
    const auto last = std::make_shared<ShaderInstance>(*scene.attributes->surface);
    first->layer = "a", last->layer = "b";
    last->earlier_layers = {first};
    scene.attributes->surface = last;
    scene.wants("height", ValueType::Float).wants("both", ValueType::Float).wants("early", ValueType::Float);
    scene.wants("k", ValueType::Color).wants("own", ValueType::Float);
    const ShadingGrid grid = scene.shaded();
    ASSERT_EQ(scene.reported.size(), 1u);  // "own" is no output
    EXPECT_NE(scene.reported[0].text.find("\"own\""), std::string::npos) << scene.reported[0].text;
    for (size_t i = 0; i < grid.vertex_count(); ++i) {
        EXPECT_EQ(grid.aovs[0][i], grid.t[i]);
        EXPECT_EQ(grid.aovs[1][i], grid.s[i]);  // the surface's comes first
        EXPECT_EQ(grid.aovs[2][i], grid.s[i] + grid.t[i]);
        EXPECT_EQ(grid.aovs[3][i], grid.s[i]);
        EXPECT_EQ(grid.aovs[4][i], grid.t[i]);
        EXPECT_EQ(grid.aovs[6][i], 0);
    }
}

TEST(TakeAovs, WhatIsMissingIsZeroAndWarnedOfOnce) {
    AovScene scene("surface test(output varying float foo = 7;) { Ci = 1; Oi = 1; }");
    scene.wants("foo", ValueType::Color).wants("bar", ValueType::Float).wants("bar", ValueType::Float);
    scene.scene.options.displays[0].location = {scene.diagnostics.add_source("scene.rib"), 4, 1};
    const ShadingGrid grid = scene.shaded();
    ASSERT_EQ(grid.aovs.size(), 4u);
    for (const std::vector<float>& plane : grid.aovs)
        for (const float value : plane) EXPECT_EQ(value, 0);
    ASSERT_EQ(scene.reported.size(), 3u);  // foo is no colour; there is no bar, which two Displays ask for
    EXPECT_EQ(scene.reported[0].severity, Severity::Warning);
    EXPECT_EQ(scene.reported[0].place, "scene.rib:4:1");
    EXPECT_NE(scene.reported[0].text.find("\"foo\""), std::string::npos);
    EXPECT_NE(scene.reported[1].text.find("\"bar\""), std::string::npos);
    EXPECT_NE(scene.reported[2].text.find("\"bar\""), std::string::npos);
}

TEST(TakeAovs, ScratchGridsForgetThoseOfLargerGrids) {
    AovScene scene("surface test(output varying color foo = 0;) { foo = color(s, t, 1); Ci = 1; Oi = 1; }");
    scene.wants("foo", ValueType::Color);
    const Shading shading(scene.context);
    ShadeScratch scratch;
    ShadeStats stats;
    ShadingGrid grid = scene.grid(16, 16);
    shading.shade(grid, scratch, stats);
    ShadingGrid small = scene.grid(1, 1);
    small.aovs = grid.aovs;  // as a thread's grid has them from the last one
    shading.shade(small, scratch, stats);
    ASSERT_EQ(small.aovs.size(), 3u);
    for (size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(small.aovs[0][i], small.s[i]);
        EXPECT_EQ(small.aovs[1][i], small.t[i]);
    }
    EXPECT_EQ(small.aovs[0].size(), 4u);
}

TEST(TakeAovs, NothingIsTakenWhenNothingIsAskedFor) {
    AovScene scene("surface test(output varying color foo = 0;) { Ci = 1; Oi = 1; }");
    EXPECT_TRUE(scene.shaded().aovs.empty());
}

}  // namespace
}  // namespace trapeze
