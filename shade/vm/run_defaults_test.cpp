// Defaults of parameters that read predefined variables, for every kind of shader.
#include "shade/vm/run_defaults.h"

#include "shade/imager.h"
#include "shade/materials/shader_folder_harness.h"
#include "shade/vm/run_shader_harness.h"

namespace trapeze::vm {
namespace {

using testing::color;
using testing::expect_near_triple;
using testing::shader;
using testing::ShaderFolder;
using testing::ShaderRun;
using testing::ShadingScene;

TEST(RunDefaults, FollowThePoint) {
    for (const bool optimised : {false, true}) {
        ShaderRun run(
            "float twice(float x) { return 2 * x; }"
            "surface test(varying vector along = dPdu; varying float a = twice(s), b = a + 1;"
            "             varying color c = Cs * t; float k = 3; varying float two[2] = {u, v};"
            "             output varying float r = 0; output varying color d = c + k;) {"
            "  r = 1000 * xcomp(along) + 10 * b + two[0] - two[1]; }",
            optimised);
        run.run();
        EXPECT_TRUE(run.messages().empty()) << run.messages();
        for (size_t i = 0; i < run.vertices(); ++i) {
            const ShadingGrid& grid = run.grid();
            EXPECT_FLOAT_EQ(run.at("r", i), 1000 + 10 * (2 * grid.s[i] + 1) + grid.u[i] - grid.v[i]) << i;
            for (int k = 0; k < 3; ++k)
                EXPECT_FLOAT_EQ(run.at("d", i, k), grid.Cs.c[k][i] * grid.t[i] + 3) << i;
        }
    }
}

TEST(RunDefaults, AreOnlyThoseThatAskWhatIsAroundTheRun) {
    const ShaderRun run(
        "surface test(varying point p = P; float one = 1, two = one + 1; varying float far = length(p);"
        "             point origin = point \"shader\" (0, 0, 0), inside = point \"object\" (0, 0, 0);"
        "             varying float noisy = random(); color seen = texture(\"x.tex\", 0.5, 0.5);) {}");
    const std::vector<bool> expected = {true, false, false, true, false, true, true, true};
    EXPECT_EQ(has_run_default(run.program()), expected);
}

TEST(RunDefaults, AUniformParameterBecomesVarying) {
    ShaderRun run("surface test(color c = Cs; output varying float r = 0;) { r = comp(c, 1); }");
    run.run();
    EXPECT_TRUE(run.is_varying("c"));
    EXPECT_NE(run.messages().find("becomes varying"), std::string::npos) << run.messages();
    EXPECT_EQ(run.at("r", 2), 0.4f);
}

/// A scene that finds its shaders in a folder.
struct FolderScene {
    ShadingScene test;
    ShaderFolder folder;

    FolderScene() { test.scene.options.search_paths["shader"] = {folder.path()}; }
    void write(const std::string& name, const std::string& source) { folder.write(name, source); }
};

TEST(RunDefaults, ValuesOfTheInstanceAndPrimitiveVariablesReplaceThem) {
    FolderScene scene;
    scene.write("show", "surface show(varying color c = Cs; varying float f = s;) { Ci = c + f; Oi = 1; }");
    scene.test.surface("show", {color("c", V3f(1, 2, 3))});
    scene.test.declare("f", {StorageClass::Varying, ValueType::Float, 1});
    ShadingGrid grid = scene.test.grid();
    GridVariable& f = grid.variables.emplace_back();
    f.name = "f";
    f.declaration = {StorageClass::Varying, ValueType::Float, 1};
    f.planes = {std::vector<float>(grid.vertex_count(), 10)};
    grid = scene.test.shaded(grid);
    for (size_t i = 0; i < grid.vertex_count(); ++i) EXPECT_EQ(grid.Ci.at(i), V3f(11, 12, 13));
}

TEST(RunDefaults, OfDisplacementsAndOfSurfacesBehindThem) {
    FolderScene scene;
    scene.test.attributes->displacement_bound = 10;
    scene.write("move", "displacement move(varying point to = P + N * s;) { P = to; }");
    scene.write("show", "surface show(varying point at = P;) { Ci = color(at); Oi = 1; }");
    scene.test.displacement("move");
    scene.test.surface("show");
    const ShadingGrid before = scene.test.grid(), grid = scene.test.shaded(before);
    for (size_t i = 0; i < grid.vertex_count(); ++i) {
        expect_near_triple(grid.P[0].at(i), before.P[0].at(i) + V3f(0, 0, -before.s[i]), 1e-6f);
        EXPECT_EQ(grid.Ci.at(i), grid.P[0].at(i));
    }
}

TEST(RunDefaults, OfLightsAndAtmospheres) {
    FolderScene scene;
    scene.write("lamp", "light lamp(varying float x = xcomp(Ps);) { Cl = x; }");
    scene.write("air", "volume air(varying float away = length(I);) { Ci += away; }");
    scene.write("show", "surface show() { Ci = ambient(); Oi = 1; }");
    scene.test.light("lamp");
    scene.test.surface("show");
    const auto air = std::make_shared<ShaderInstance>(shader("air"));
    scene.test.attributes->atmosphere = air;
    const ShadingGrid grid = scene.test.shaded();
    for (size_t i = 0; i < grid.vertex_count(); ++i)
        EXPECT_FLOAT_EQ(grid.Ci.at(i).x, grid.P[0].at(i).x + grid.P[0].at(i).length()) << i;
}

TEST(RunDefaults, OfImagers) {
    FolderScene scene;
    scene.write("show", "imager show(varying float x = xcomp(P);) { Ci = x; }");
    scene.test.scene.options.imager = std::make_shared<ShaderInstance>(shader("show"));
    const Imager imager(scene.test.context);
    float pixel[4] = {};
    imager.run(7, 0, 1, pixel);
    EXPECT_EQ(pixel[0], 7.5f);
}

TEST(RunDefaults, ConnectedParametersTakeTheConnection) {
    FolderScene scene;
    scene.write("first", "surface first(output varying float out = 0;) { out = 2 * t; }");
    scene.write("last", "surface last(varying float in = s;) { Ci = in; Oi = 1; }");
    const auto first = std::make_shared<ShaderInstance>(shader("first"));
    const auto last = std::make_shared<ShaderInstance>(shader("last"));
    first->layer = "a", last->layer = "b";
    last->earlier_layers = {first};
    last->connections = {{"a", "out", "b", "in"}};
    scene.test.attributes->surface = last;
    const ShadingGrid grid = scene.test.shaded();
    for (size_t i = 0; i < grid.vertex_count(); ++i) EXPECT_EQ(grid.Ci.at(i).x, 2 * grid.t[i]);
}

}  // namespace
}  // namespace trapeze::vm
