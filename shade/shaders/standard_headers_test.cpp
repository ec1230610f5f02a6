/// The files that shaders include by custom: shaders that use them, and values known from elsewhere.
#include <gtest/gtest.h>

#include "shade/shader_folder_harness.h"
#include "shade/shaders/standard_shaders.h"
#include "shade/test_scene.h"

namespace trapeze {
namespace {

/// What a surface shader of these statements gives, at one point; no message must come.
V3f result_of(const std::string& headers, const std::string& statements) {
    TestScene scene;
    const ShaderFolder folder;
    folder.write("tried", headers + "\nsurface tried() { float a = 0, b = 0, c = 0;\n" + statements +
                              "\nCi = color(a, b, c); Oi = 1; }\n");
    scene.scene.options.search_paths["shader"] = {folder.path()};
    scene.surface("tried");
    const ShadingGrid grid = scene.shaded();
    for (const Diagnostic& d : scene.reported) ADD_FAILURE() << to_string(d);
    return grid.Ci.at(0);
}

void expect_near(const V3f& got, const V3f& expected) {
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(got[k], expected[k], 1e-5f) << k;
}

TEST(StandardHeaders, PatternsAreAveragesOverTheFilter) {
    const std::string header = "#include \"patterns.h\"";
    // |x| over -1..3: (1/2 + 9/2) / 4. A wide filter sees the mean: half of the smoothstep's range, 3/4 of a
    // train.
    expect_near(result_of(header,
                          "a = filteredabs(1, 4); b = filteredsmoothstep(0, 1, 0.5, 8);"
                          "c = filteredpulsetrain(0.5, 2, 1.3, 4);"),
                V3f(1.25f, 0.5f, 0.75f));
    expect_near(
        result_of(header, "a = pulse(1, 2, 1.5); b = pulse(1, 2, 2.5); c = filteredpulse(0, 1, 1, 1);"),
        V3f(1, 0, 0.5f));
    expect_near(result_of(header, "a = pulsetrain(0.5, 1, 3.7); b = pulsetrain(0.5, 1, 3.2); c = sqr(3);"),
                V3f(1, 0, 9));
    expect_near(result_of(header,
                          "float row, column; basicbrick(2.5, 1.25, 1, 0.5, 0.5, 0, 0, 0, column, row, a, b);"
                          "c = column + 10 * row;"),
                V3f(0.5f, 0.5f, 22));  // column 2 of row 2, staggered by mod(0.5 * 2, 1) = 0
}

TEST(StandardHeaders, RaysMeetSpheresTwiceOrOnceOrNever) {
    const std::string header = "#include <raysphere.h>";
    expect_near(result_of(header, "c = raysphere(point(0, 0, -5), vector(0, 0, 1), 2, 0.001, a, b);"),
                V3f(3, 7, 2));
    expect_near(result_of(header, "c = raysphere(point(0, 0, 0), vector(0, 1, 0), 2, 0.001, a, b);"),
                V3f(2, 2, 1));
    expect_near(result_of(header, "c = raysphere(point(0, 3, -5), vector(0, 0, 1), 2, 0.001, a, b);"),
                V3f(0, 0, 0));
}

TEST(StandardHeaders, NoisesAreSignedAndFadeOut) {
    const std::string header = "#include \"noises.h\"";
    const V3f fade = result_of(header,
                               "point q = point(0.3, 0.7, 0.1);"
                               "a = fBm(q, 0.01, 1, 2, 0.5) - snoise(q); b = fBm(q, 10, 4, 2, 0.5);"
                               "c = turbulence(q, 0.01, 1, 2, 0.5) - abs(snoise(q));");
    EXPECT_NEAR(fade.x, 0, 1e-5f);
    EXPECT_EQ(fade.y, 0);
    EXPECT_NEAR(fade.z, 0, 1e-3f);
    // Without jitter the points are the middles of cells.
    expect_near(result_of(header,
                          "float f1, f2; point p1, p2;"
                          "voronoi_f1f2_3d(point(0.5, 0.75, 0.5), 0, f1, p1, f2, p2);"
                          "a = f1; b = f2; voronoi_f1_2d(2.5, 3.1, 0, c, f1, f2);"),
                V3f(0.25f, 0.75f, 0.4f));
}

TEST(StandardHeaders, MasksAndTiles) {
    const std::string header = "#include \"rmannotes.sl\"";
    expect_near(
        result_of(header,
                  "a = union(0.5, 0.5); b = intersection(0.5, complement(0.75)); c = blend(1, 3, 0.5);"),
        V3f(0.75f, 0.125f, 2));
    expect_near(
        result_of(header, "a = repeat(0.35, 10); b = whichtile(0.35, 10); if (odd(b) && !even(b)) c = 1;"),
        V3f(0.5f, 3, 1));
    expect_near(result_of(header, "rotate2d(1, 0, PI / 2, 0, 0, a, b); c = pulse(0.2, 0.6, 0.1, 0.4);"),
                V3f(0, 1, 1));
}

TEST(StandardHeaders, AFolderOfOnesOwnComesFirst) {
    EXPECT_TRUE(standard_header("nosuch.h").empty());
    const ShaderFolder folder;
    std::ofstream(folder.path() + "/patterns.h") << "#define sqr(x) 7\n";
    folder.write("mine", "#include \"patterns.h\"\nsurface mine() { Ci = sqr(2); Oi = 1; }");
    TestScene scene;
    scene.scene.options.search_paths["shader"] = {folder.path()};
    scene.surface("mine");
    EXPECT_EQ(scene.shaded().Ci.at(0), V3f(7));
}

}  // namespace
}  // namespace trapeze
