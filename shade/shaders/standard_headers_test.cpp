/// The files that shaders include by custom: shaders that use them, and values known from elsewhere.
#include <gtest/gtest.h>

#include "shade/materials/shader_folder_harness.h"
#include "shade/shaders/standard_shaders.h"
#include "shade/shading_harness.h"

namespace trapeze {
namespace {

using testing::expect_near_triple;
using testing::number;
using testing::point;
using testing::ShaderFolder;
using testing::ShadingScene;

/// What a surface shader of these statements gives, at one point of a plane that faces the eye, lit by a
/// distant light from the eye; no message must come.
V3f result_of(const std::string& headers, const std::string& statements, const std::string& parameters = "") {
    ShadingScene scene;
    const ShaderFolder folder;
    folder.write("tried", headers + "\nsurface tried(" + parameters + ") { float a = 0, b = 0, c = 0;\n" +
                              statements + "\nCi = color(a, b, c); Oi = 1; }\n");
    scene.scene.options.search_paths["shader"] = {folder.path()};
    scene.attributes->displacement_bound = 1;  // for those that set P
    scene.surface("tried");
    scene.light("distantlight",
                {number("intensity", 1), point("from", V3f(0, 0, 0)), point("to", V3f(0, 0, 1))});
    const ShadingGrid grid = scene.shaded();
    for (const Diagnostic& d : scene.reported) ADD_FAILURE() << to_string(d);
    return grid.Ci.at(0);
}

void expect_near_triple(const V3f& got, const V3f& expected) {
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(got[k], expected[k], 1e-5f) << k;
}

TEST(StandardHeaders, PatternsAreAveragesOverTheFilter) {
    const std::string header = "#include \"patterns.h\"";
    // |x| over -1..3: (1/2 + 9/2) / 4. A wide filter sees the mean: half of the smoothstep's range, 3/4 of a
    // train.
    expect_near_triple(result_of(header,
                                 "a = filteredabs(1, 4); b = filteredsmoothstep(0, 1, 0.5, 8);"
                                 "c = filteredpulsetrain(0.5, 2, 1.3, 4);"),
                       V3f(1.25f, 0.5f, 0.75f));
    expect_near_triple(
        result_of(header, "a = pulse(1, 2, 1.5); b = pulse(1, 2, 2.5); c = filteredpulse(0, 1, 1, 1);"),
        V3f(1, 0, 0.5f));
    expect_near_triple(
        result_of(header, "a = pulsetrain(0.5, 1, 3.7); b = pulsetrain(0.5, 1, 3.2); c = sqr(3);"),
        V3f(1, 0, 9));
    expect_near_triple(
        result_of(header,
                  "float row, column; basicbrick(2.5, 1.25, 1, 0.5, 0.5, 0, 0, 0, column, row, a, b);"
                  "c = column + 10 * row;"),
        V3f(0.5f, 0.5f, 22));  // column 2 of row 2, staggered by mod(0.5 * 2, 1) = 0
}

TEST(StandardHeaders, RaysMeetSpheresTwiceOrOnceOrNever) {
    const std::string header = "#include <raysphere.h>";
    expect_near_triple(result_of(header, "c = raysphere(point(0, 0, -5), vector(0, 0, 1), 2, 0.001, a, b);"),
                       V3f(3, 7, 2));
    expect_near_triple(result_of(header, "c = raysphere(point(0, 0, 0), vector(0, 1, 0), 2, 0.001, a, b);"),
                       V3f(2, 2, 1));
    expect_near_triple(result_of(header, "c = raysphere(point(0, 3, -5), vector(0, 0, 1), 2, 0.001, a, b);"),
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
    expect_near_triple(result_of(header,
                                 "float f1, f2; point p1, p2;"
                                 "voronoi_f1f2_3d(point(0.5, 0.75, 0.5), 0, f1, p1, f2, p2);"
                                 "a = f1; b = f2; voronoi_f1_2d(2.5, 3.1, 0, c, f1, f2);"),
                       V3f(0.25f, 0.75f, 0.4f));
}

TEST(StandardHeaders, MasksAndTiles) {
    const std::string header = "#include \"rmannotes.sl\"";
    expect_near_triple(
        result_of(header,
                  "a = union(0.5, 0.5); b = intersection(0.5, complement(0.75)); c = blend(1, 3, 0.5);"),
        V3f(0.75f, 0.125f, 2));
    expect_near_triple(
        result_of(header, "a = repeat(0.35, 10); b = whichtile(0.35, 10); if (odd(b) && !even(b)) c = 1;"),
        V3f(0.5f, 3, 1));
    expect_near_triple(
        result_of(header, "rotate2d(1, 0, PI / 2, 0, 0, a, b); c = pulse(0.2, 0.6, 0.1, 0.4);"),
        V3f(0, 1, 1));
}

constexpr const char* kFacing = "normal Nf = faceforward(normalize(N), I); vector V = -normalize(I);\n";

TEST(StandardHeaders, LocalIlluminationHasItsLimits) {
    // Smooth facets are diffuse; rough ones seen from the light are as bright at grazing angles.
    const V3f clay = result_of("#include \"locillum.h\"",
                               std::string(kFacing) +
                                   "a = comp(LocIllumOrenNayar(Nf, V, 0), 0); b = comp(diffuse(Nf), 0);"
                                   "c = comp(LocIllumOrenNayar(normalize(Nf + vector(2, 0, 0)), V, 1), 0) /"
                                   "    comp(LocIllumOrenNayar(normalize(Nf + vector(2, 0, 0)), V, 0), 0);");
    EXPECT_GT(clay.x, 0.9f);
    EXPECT_NEAR(clay.x, clay.y, 1e-5f);
    EXPECT_GT(clay.z, 1.1f);
    // A highlight turned by a right angle is one with its roughnesses exchanged; its middle is 1 / (4 a b).
    const V3f brushed = result_of(
        "#include \"locillum.h\"",
        "normal Nf = normal(0, 0, -1), tilted = normalize(normal(0.1, 0.2, -1)); vector V = vector(0, 0, -1);"
        "a = comp(LocIllumWardAnisotropic(tilted, V, vector(1, 0, 0), 0.4, 0.2), 0);"
        "b = comp(LocIllumWardAnisotropic(tilted, V, vector(0, 1, 0), 0.2, 0.4), 0);"
        "c = comp(LocIllumWardAnisotropic(Nf, V, vector(1, 0, 0), 0.5, 0.25), 0);");
    EXPECT_GT(brushed.x, 0.1f);
    EXPECT_NEAR(brushed.x, brushed.y, 2e-2f * brushed.x);
    EXPECT_NEAR(brushed.z, 2, 1e-3f);
    // A sharp gloss is 1 inside and 0 outside.
    expect_near_triple(result_of("#include \"locillum.h\"",
                                 "vector V = vector(0, 0, -1);"
                                 "a = comp(LocIllumGlossy(normal(0, 0, -1), V, 0.1, 1), 0);"
                                 "b = comp(LocIllumGlossy(normalize(normal(1, 0, -1)), V, 0.1, 1), 0);"),
                       V3f(1, 0, 0));
}

TEST(StandardHeaders, MaterialsAreSumsOfTheirParts) {
    const std::string header = "#include \"material.h\"";
    const std::string environment = "DECLARE_DEFAULTED_ENVPARAMS";
    const V3f plain = result_of(
        header,
        std::string(kFacing) +
            "a = comp(MaterialPlastic(Nf, color(0.5, 0, 0), 1, 1, 0, 0.1), 0) - 0.5 * comp(diffuse(Nf), 0);"
            "b = comp(MaterialMatte(Nf, color(1, 1, 1), 0, 1), 1) - comp(MaterialClay(Nf, 1, 0, 1, 0), 1);"
            "c = comp(MaterialThinPlastic(-Nf, V, 1, 0, 0, 1, 0, 0.1), 0);");
    EXPECT_NEAR(plain.x, 0, 1e-5f);
    EXPECT_NEAR(plain.y, 0, 1e-5f);
    EXPECT_GT(plain.z, 0.9f);
    // Without an environment nothing is mirrored: both forms, with and without sides, are the same.
    const V3f shiny = result_of(
        header,
        std::string(kFacing) +
            "a = comp(MaterialShinyMetal(Nf, 1, 0, 1, 0, 0.1, 1, 0, ENVPARAMS), 0) - comp(diffuse(Nf), 0);"
            "b = comp(MaterialShinyPlastic(Nf, 1, 0, 1, 0, 0.1, 1, 0, 1.5, ENVPARAMS), 0) -"
            "    comp(MaterialShinyPlastic(Nf, 1, 0, 1, 0, 0.1, 1, 0, 1.5, 1, ENVPARAMS), 0);"
            "c = comp(MaterialShinyPlastic(Nf, 1, 0, 1, 0, 0.1, 1, 0, 1.5, ENVPARAMS), 0) / comp(diffuse(Nf), 0);",
        environment);
    EXPECT_NEAR(shiny.x, 0, 1e-5f);
    EXPECT_NEAR(shiny.y, 0, 1e-5f);
    EXPECT_NEAR(shiny.z, 0.96f, 5e-3f);  // the rest, ((1.5 - 1) / (1.5 + 1))^2, is mirrored
    const V3f other =
        result_of(header,
                  std::string(kFacing) +
                      "a = comp(MaterialRoughMetal(Nf, 1, 0, 0, 1, 0.1), 0) - comp(specular(Nf, V, 0.1), 0);"
                      "b = comp(MaterialBrushedMetal(Nf, 1, 0, 0, 1, vector(1, 0, 0), 0.5, 0.5), 0);"
                      "c = comp(MaterialCeramic(Nf, 1, 0, 0, 1, 1, 1), 0) +"
                      "    comp(MaterialGlass(Nf, 1, 0, 0, 0, 0.1, 1, 0, 1, 0, 1.5, 1, 0, 1, ENVPARAMS), 0);",
                  environment);
    EXPECT_NEAR(other.x, 0, 1e-5f);
    EXPECT_GT(other.y, 0.5f);
    EXPECT_NEAR(other.z, 1, 1e-5f);
}

TEST(StandardHeaders, ProjectionsCoverTheTexture) {
    const std::string header = "#include \"project.h\"";
    const std::string unit = "float m[16] = {1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1}; float ds, dt;";
    expect_near_triple(result_of(header, unit + "spherical_projection(point(0, -2, 0), a, b, ds, dt);"),
                       V3f(0.75f, 0.5f, 0));
    const V3f round = result_of(header, unit +
                                            "spherical_projection(point(1, 0, 1), a, b, ds, dt);"
                                            "float x; cylindrical_projection(point(1, 0, 5), x, c, ds, dt);");
    expect_near_triple(round, V3f(0.5f, 0.25f, 5));
    const V3f flat = result_of(
        header,
        unit +
            "point at = point(3, 4, 2);"
            "ProjectTo2D(\"perspective\", at, \"current\", array_to_mx(m), a, b, ds, dt);"
            "float x; m[13] = 10; ProjectTo2D(\"planar\", at, \"current\", array_to_mx(m), x, c, ds, dt);");
    expect_near_triple(flat, V3f(1.5f, 2, 14));
    expect_near_triple(
        result_of(header, unit + "ProjectTo2D(\"st\", P, \"current\", array_to_mx(m), a, b, ds, dt);"
                                 "a -= s; b -= t;"),
        V3f(0));
}

TEST(StandardHeaders, DisplaceMovesAndBends) {
    expect_near_triple(
        result_of("#include \"displace.h\"",
                  "point before = P; normal Nn = Displace(vector(0, 0, 1), \"current\", 0.5, 0);"
                  "a = distance(P, before); b = abs(zcomp(Nn)); c = length(Nn);"),
        V3f(0, 1, 1));
}

TEST(StandardHeaders, ShadersDeclareWhereTheyComputeTheirPattern) {
    expect_near_triple(
        result_of("#include \"pshad.h\"",
                  "GET_PSHAD; a = distance(Pshad, 2 * transform(\"shader\", P)); if (dPshad > 0) b = 1;",
                  "PSHAD_PARAMS(\"shader\", 2)"),
        V3f(0, 1, 0));
    expect_near_triple(
        result_of("#define USE_PREF 1\n#include \"pshad.h\"",
                  "GET_PSHAD; a = distance(Pshad, transform(\"shader\", P)); if (dPshad > 0) b = 1;",
                  "DEFAULT_PSHAD_PARAMS"),
        V3f(0, 1, 0));
}

TEST(StandardHeaders, WoodLiesBetweenItsLimits) {
    const V3f oak = result_of(
        "#include \"oak.h\"",
        "a = 1; b = 0; uniform float i;"
        "for (i = 0; i < 64; i += 1) {"
        "    float wood = oaktexture(point(i * 0.037, i * 0.011, i * 0.1), 0.001, 8, 0.5, 25, 0.02, 1, 0.15, 0.025,"
        "                            1, 1.5, 1, 1);"
        "    a = min(a, wood); b = max(b, wood); }");
    EXPECT_GE(oak.x, 0);
    EXPECT_LE(oak.y, 1);
    EXPECT_GT(oak.y - oak.x, 0.5f);
}

TEST(StandardHeaders, ManifoldsAreFiltered) {
    expect_near_triple(
        result_of("#include \"pxslUtil.h\"\n#include \"pxslRayUtil.h\"\n#include \"pxslRemap.h\"",
                  "point q = point(0.3, 0.4, 0.5); vector wide = 10;"
                  "a = pxslFilteredFNoise(q, wide, vector(0, 0, 10)); b = pxslBimix(1, 2, 3, 4, 0, 1);"
                  "c = pxslGainF(0.2, 0.5);"),
        V3f(0.5f, 1, 0.2f));
}

TEST(StandardHeaders, NormalsForShadingTurnToTheViewer) {
    expect_near_triple(
        result_of("#include \"normals.h\"",
                  "normal turned = shadingnormal(2 * N); a = turned . normalize(-I) > 0 ? 1 : 0;"
                  "b = length(turned); c = abs(turned . normalize(N));"),
        V3f(1, 1, 1));
}

/// Every header alone, twice and with all the others: whatever order shaders take them in.
TEST(StandardHeaders, EachStandsAloneAndBesideTheOthers) {
    std::string all;
    for (const char* name :
         {"antialiasing.h", "displace.h",  "filterwidth.h", "locillum.h",  "material.h",  "materials.h",
          "noises.h",       "normals.h",   "oak.h",         "patterns.h",  "project.h",   "pshad.h",
          "pxslRayUtil.h",  "pxslRemap.h", "pxslUtil.h",    "rayserver.h", "raysphere.h", "reflections.h",
          "textures.h",     "voronoi.h",   "wood.h"}) {
        const std::string line = "#include \"" + std::string(name) + "\"\n";
        EXPECT_EQ(result_of(line + line, "a = 1;"), V3f(1, 0, 0)) << name;
        all = line + all;
    }
    EXPECT_EQ(result_of(all, "a = 1;"), V3f(1, 0, 0));
}

TEST(StandardHeaders, AFolderOfOnesOwnComesFirst) {
    EXPECT_TRUE(standard_header("nosuch.h").empty());
    const ShaderFolder folder;
    std::ofstream(folder.path() + "/patterns.h") << "#define sqr(x) 7\n";
    folder.write("mine", "#include \"patterns.h\"\nsurface mine() { Ci = sqr(2); Oi = 1; }");
    ShadingScene scene;
    scene.scene.options.search_paths["shader"] = {folder.path()};
    scene.surface("mine");
    EXPECT_EQ(scene.shaded().Ci.at(0), V3f(7));
}

}  // namespace
}  // namespace trapeze
