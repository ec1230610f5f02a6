#include "shade/shading.h"

#include <thread>

#include "shade/materials/shader_folder_harness.h"
#include "shade/shading_harness.h"

namespace trapeze {
namespace {

using testing::expect_near_triple;
using testing::shader;
using testing::ShaderFolder;
using testing::ShadingScene;

TEST(Shading, UnknownSurfacesAreSaidOnceAndBecomeDefaultsurface) {
    ShadingScene scene;
    const ShadingGrid expected = scene.shaded();
    scene.surface("limestone");
    auto second = std::make_shared<Attributes>();
    second->surface = std::make_shared<ShaderInstance>(shader("limestone"));
    scene.scene.primitives.push_back(scene.scene.primitives[0]);
    scene.scene.primitives[1].attributes = second;
    const ShadingGrid grid = scene.shaded();
    EXPECT_EQ(grid.Ci.c, expected.Ci.c);
    ASSERT_EQ(scene.reported.size(), 1u);
    EXPECT_EQ(scene.reported[0].severity, Severity::Error);
    EXPECT_NE(scene.reported[0].text.find("\"limestone\""), std::string::npos) << scene.reported[0].text;
}

TEST(Shading, UnknownShadersAreReportedWhereTheyAreNamed) {
    ShadingScene scene;
    const uint32_t source = scene.diagnostics.add_source("scene.rib");
    scene.light("lamp").location = {source, 12, 3};
    scene.displacement("crumpled").location = {source, 15, 1};
    const ShadingGrid before = scene.grid(), after = scene.shaded(before);
    ASSERT_EQ(scene.reported.size(), 2u);
    for (const Diagnostic& d : scene.reported)
        EXPECT_EQ(d.place, d.text.find("lamp") != std::string::npos ? "scene.rib:12:3" : "scene.rib:15:1");
    EXPECT_EQ(after.P[0].c, before.P[0].c);
}

TEST(Shading, UndeclaredColoursAreWhatTheShaderSays) {
    const auto shaded = [](ValueType type, int length, std::vector<float> values, size_t warnings) {
        ShadingScene scene;
        scene.light("distantlight");
        scene.surface("plastic",
                      {{"specularcolor", {StorageClass::Uniform, type, length}, std::move(values), {}}});
        const ShadingGrid grid = scene.shaded();
        EXPECT_EQ(scene.reported.size(), warnings);
        return grid.Ci.c;
    };
    const auto declared = shaded(ValueType::Color, 1, {1, 0, 0}, 0);
    EXPECT_EQ(shaded(ValueType::Float, 3, {1, 0, 0}, 0), declared);
    EXPECT_NE(shaded(ValueType::Float, 2, {1, 0}, 1), declared);
}

TEST(Shading, ShadersOfOtherMachinesAreFoundByTheirNames) {
    ShadingScene scene;
    const ShaderFolder folder;
    folder.write("green", "surface green() { Ci = color(0, 1, 0); Oi = 1; }");
    scene.scene.options.search_paths["shader"] = {folder.path()};
    scene.surface("C:\\show\\shaders\\green");
    EXPECT_EQ(scene.shaded().Ci.at(0), V3f(0, 1, 0));
    scene.surface("/show/shaders/constant.slo");
    EXPECT_EQ(scene.shaded().Ci.at(0), scene.grid().Cs.at(0) * scene.grid().Os.at(0));
    EXPECT_TRUE(scene.reported.empty());
}

/// As RenderMan's renderers have it: a shader that sets only Oi to 0 in places shows nothing there.
TEST(Shading, ColoursStartBlackAndOpacitiesAsThePrimitives) {
    ShadingScene scene;
    const ShaderFolder folder;
    folder.write("glow", "surface glow() { if (s > 0.5) Ci = Cs; else Oi = 0; }");
    folder.write("sum", "surface sum() { float i; for (i = 0; i < 3; i += 1) Ci += Cs; }");
    scene.scene.options.search_paths["shader"] = {folder.path()};
    scene.surface("glow");
    const ShadingGrid glow = scene.shaded();
    for (size_t i = 0; i < glow.vertex_count(); ++i) {
        const bool lit = glow.s[i] > 0.5f;
        EXPECT_EQ(glow.Ci.at(i), lit ? glow.Cs.at(i) : V3f(0)) << i;
        EXPECT_EQ(glow.Oi.at(i), lit ? glow.Os.at(i) : V3f(0)) << i;
    }
    scene.surface("sum");
    const ShadingGrid sum = scene.shaded();
    expect_near_triple(sum.Ci.at(0), sum.Cs.at(0) * 3.0f, 1e-6f);
    EXPECT_EQ(sum.Oi.at(0), sum.Os.at(0));
}

TEST(Shading, EachPrimitiveHasItsOwnShaders) {
    ShadingScene scene;
    scene.surface("constant");
    scene.scene.primitives.push_back(scene.scene.primitives[0]);
    auto second = std::make_shared<Attributes>();
    second->surface = std::make_shared<ShaderInstance>(shader("plastic"));  // without lights: black
    scene.scene.primitives[1].attributes = second;
    ShadingGrid other = scene.grid();
    other.primitive_index = 1, other.primitive = &scene.scene.primitives[1];
    EXPECT_EQ(scene.shaded().Ci.at(0), scene.grid().Cs.at(0) * scene.grid().Os.at(0));
    EXPECT_EQ(scene.shaded(other).Ci.at(0), V3f(0));
}

TEST(Shading, ScratchDoesNotRememberEarlierGrids) {
    ShadingScene scene;
    scene.surface("plastic");
    scene.light("pointlight");
    const Shading shading(scene.context);
    ShadeScratch scratch;
    ShadeStats stats;
    ShadingGrid large = scene.grid(16, 16), small = scene.grid(1, 1);
    large.Cs.fill(large.vertex_count(), V3f(100));
    shading.shade(large, scratch, stats);
    shading.shade(small, scratch, stats);
    EXPECT_EQ(small.Ci.c, scene.shaded(scene.grid(1, 1)).Ci.c);
    EXPECT_EQ(stats.shaded_vertices, 289u + 4u);
}

TEST(Shading, ThreadsShadeAlike) {
    ShadingScene scene;
    scene.surface("plastic");
    scene.light("spotlight");
    scene.attributes->displacement_bound = 10;
    scene.displacement("dented");
    const Shading shading(scene.context);
    std::vector<ShadingGrid> grids(4, scene.grid(16, 16));
    std::vector<std::thread> threads;
    for (ShadingGrid& grid : grids)
        threads.emplace_back([&shading, &grid] {
            ShadeScratch scratch;
            ShadeStats stats;
            shading.shade(grid, scratch, stats);
        });
    for (std::thread& thread : threads) thread.join();
    for (const ShadingGrid& grid : grids) {
        EXPECT_EQ(grid.Ci.c, grids[0].Ci.c);
        EXPECT_EQ(grid.P[0].c, grids[0].P[0].c);
    }
}

class BatchOf : public ::testing::TestWithParam<const char*> {};

/// Grids of all sizes, primitives and uniform values, in one call: each as if it were alone.
TEST_P(BatchOf, GivesEachGridTheSameBits) {
    ShadingScene scene;
    const ShaderFolder folder;
    folder.write("placed",
                 "surface placed(string space = \"object\"; float Kd = 1;) {"
                 "  Ci = Kd * color(transform(space, P)); Oi = 1; }");
    folder.write("plain", "surface plain(float Kd = 1;) { Ci = Kd * color(transform(\"object\", P)); }");
    scene.scene.options.search_paths["shader"] = {folder.path()};
    scene.surface(GetParam());
    scene.light("spotlight"), scene.light("pointlight");
    scene.attributes->displacement_bound = 10;
    scene.displacement("dented");
    scene.declare("Kd", {StorageClass::Uniform, ValueType::Float, 1});
    scene.scene.primitives.push_back(scene.scene.primitives[0]);
    M44f moved = scene.scene.primitives[0].camera_from_object.front();
    moved[3][0] = 2;
    scene.scene.primitives[1].camera_from_object = {moved};
    std::vector<ShadingGrid> grids;
    for (uint32_t i = 0; i < 40; ++i) {
        ShadingGrid& grid = grids.emplace_back(scene.grid(1 + static_cast<int>(i * 7 % 16), 1 + i % 3));
        grid.ordinal = grid.seed = i;
        grid.primitive_index = i / 15 % 2;
        grid.primitive = &scene.scene.primitives[grid.primitive_index];
        const float Kd = i % 11 < 8 ? 0.3f : 0.9f;
        grid.variables.push_back({"Kd", {StorageClass::Uniform, ValueType::Float, 1}, true, {{Kd}}, {}});
        for (size_t v = 0; v < grid.vertex_count(); ++v)
            grid.P[0].set(v, grid.P[0].at(v) + V3f(static_cast<float>(i) / 16, 0, 0));
    }
    std::vector<ShadingGrid> alone = grids;
    const Shading shading(scene.context);
    ShadeScratch scratch;
    ShadeStats stats, alone_stats;
    std::vector<ShadingGrid*> batch;
    for (ShadingGrid& grid : grids) batch.push_back(&grid);
    shading.shade(batch, scratch, stats);
    for (ShadingGrid& grid : alone) shading.shade(grid, scratch, alone_stats);
    for (size_t i = 0; i < grids.size(); ++i) {
        EXPECT_EQ(grids[i].Ci.c, alone[i].Ci.c) << i;
        EXPECT_EQ(grids[i].Oi.c, alone[i].Oi.c) << i;
        EXPECT_EQ(grids[i].P[0].c, alone[i].P[0].c) << i;
        EXPECT_EQ(grids[i].N.c, alone[i].N.c) << i;
    }
    EXPECT_NE(grids[7].Ci.c, grids[8].Ci.c);
    EXPECT_EQ(stats.shaded_vertices, alone_stats.shaded_vertices);
}

INSTANTIATE_TEST_SUITE_P(Shading, BatchOf, ::testing::Values("brick", "plain", "placed"),
                         [](const auto& shader) { return std::string(shader.param); });

}  // namespace
}  // namespace trapeze
