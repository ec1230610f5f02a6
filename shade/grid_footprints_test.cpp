#include "shade/grid_footprints.h"

#include "shade/shading_harness.h"
#include "shade/vm/run_shader_harness.h"

namespace trapeze {
namespace {

using testing::ShaderRun;
using testing::ShadingScene;

/// So that the test grid's steps of 1/4 along u and 1/2 along v, at z = 4, are this many pixels.
void set_pixels(ShadingScene& scene, float along_u, float along_v) {
    scene.context.camera.plane_scale_x = 1.0f / 4 / 4 / along_u;
    scene.context.camera.plane_scale_y = -1.0f / 2 / 4 / along_v;
}

struct OneGrid {
    ShadingScene scene;
    ShadingGrid grid = scene.grid(4, 2);
    const ShadingGrid* list[1] = {&grid};
    vm::Footprint at(float pixels_u, float pixels_v) {
        set_pixels(scene, pixels_u, pixels_v);
        footprints = std::make_unique<GridFootprints>(list, scene.context.camera);
        return footprints->get();
    }
    std::unique_ptr<GridFootprints> footprints;
};

TEST(GridFootprints, AreTheMicropolygonWhereThatIsLargeEnough) {
    OneGrid one;
    const vm::Footprint f = one.at(1, 1.2f);
    for (size_t i = 0; i < one.grid.vertex_count(); ++i) {
        EXPECT_NEAR(f.du[i], 0.25f, 1e-5f);
        EXPECT_NEAR(f.dv[i], 0.5f, 1e-5f);
        EXPECT_NEAR(f.v_of_a[i], 0, 1e-5f);
        EXPECT_NEAR(f.widening[i], 1, 1e-4f);
    }
}

/// A polygon's first corner tells which way its grid runs, and nothing else may come of that.
TEST(GridFootprints, AreAsLongWhereParametersFallAlongAxes) {
    OneGrid one;
    for (std::vector<float>* values : {&one.grid.u, &one.grid.v})
        for (float& value : *values) value = 1 - value;
    const vm::Footprint f = one.at(1, 1.2f);
    for (size_t i = 0; i < one.grid.vertex_count(); ++i) {
        EXPECT_NEAR(f.du[i], 0.25f, 1e-5f);
        EXPECT_NEAR(f.dv[i], 0.5f, 1e-5f);
    }
}

TEST(GridFootprints, ReachOverAPixelWhereMicropolygonsAreThin) {
    OneGrid one;
    const vm::Footprint f = one.at(1, 0.05f);
    for (size_t i = 0; i < one.grid.vertex_count(); ++i) {
        EXPECT_NEAR(f.du[i], 0.25f, 1e-4f);
        EXPECT_NEAR(f.dv[i], 0.5f * 20, 1e-3f);
        EXPECT_NEAR(f.widening[i], 20, 1e-2f);
    }
    // Less of a pixel when the shading rate asks for less.
    one.scene.attributes->shading_rate = 0.04f;
    EXPECT_NEAR(one.at(1, 0.05f).dv[3], 0.5f * 4, 1e-3f);
}

/// A floor whose lines run aslant: both parameters are seen along nearly the same line.
TEST(GridFootprints, AreStretchedAcrossLinesThatMeetAtASlant) {
    OneGrid one;
    one.grid.dPdu.fill(one.grid.vertex_count(), V3f(1, 0.02f, 0));
    one.grid.dPdv.fill(one.grid.vertex_count(), V3f(0.5f, -0.02f, 0));
    const vm::Footprint f = one.at(1, 2);
    // A unit of the grid's plane is 4 pixels across and up.
    const auto height = [&](float u, float v) { return std::abs(u * 0.02f - v * 0.02f) * 4; };
    // Of the ellipse, up the picture, in pixels.
    const float pixels = std::hypot(height(f.u_of_a[0], f.v_of_a[0]), height(f.u_of_b[0], f.v_of_b[0]));
    const float of_micropolygon = std::hypot(height(0.25f, 0), height(0, 0.5f));
    EXPECT_LT(of_micropolygon, 0.1f);
    EXPECT_GT(pixels, 0.9f);
    EXPECT_LT(pixels, 1.1f);
}

/// One that is seen edge-on, one through the eye and one with values that are no numbers.
TEST(GridFootprints, AreFiniteWhateverTheGrid) {
    for (const V3f& along_v : {V3f(0, 0, 1), V3f(0, 0, 0), V3f(INFINITY, 0, 0), V3f(NAN, 0, 0)}) {
        OneGrid one;
        one.grid.P.front().set(0, V3f(0, 0, 0)), one.grid.P.front().set(1, V3f(0, 0, -1));
        one.grid.dPdv.fill(one.grid.vertex_count(), along_v);
        const vm::Footprint f = one.at(1, 1);
        for (size_t i = 0; i < one.grid.vertex_count(); ++i) {
            EXPECT_TRUE(std::isfinite(f.du[i]) && std::isfinite(f.dv[i]) && std::isfinite(f.widening[i]));
            EXPECT_GE(f.du[i], 0.2499f);
        }
    }
}

/// What headers make of du and dv, what filterstep() takes, and area(): one footprint.
TEST(GridFootprints, AreWhatShadersFilterOver) {
    ShaderRun run(
        "surface test(output varying float width = 0, step = 0, own = 0, a = 0, b = 0;) {"
        "  width = abs(Du(t) * du) + abs(Dv(t) * dv);"
        "  step = filterstep(.4, t); own = clamp((t + width / 2 - .4) / width, 0, 1);"
        "  a = area(P); b = length((Du(P) * du) ^ (Dv(P) * dv)); }",
        true, 4, 2);
    set_pixels(run.scene(), 1, 0.05f);
    run.run();
    ASSERT_EQ(run.messages(), "");
    for (size_t i = 0; i < run.vertices(); ++i) {
        EXPECT_NEAR(run.at("width", i), 10, 1e-3f);
        EXPECT_NEAR(run.at("step", i), run.at("own", i), 1e-4f);
        EXPECT_NEAR(run.at("a", i), run.at("b", i), 1e-4f);
        EXPECT_NEAR(run.at("a", i), 0.25f * 10, 1e-3f);
    }
}

}  // namespace
}  // namespace trapeze
