#include "shade/displace.h"

#include <cmath>
#include <filesystem>

#include "shade/materials/shader_folder_harness.h"
#include "shade/shading_harness.h"

namespace trapeze {
namespace {

using testing::expect_near_triple;
using testing::finite;
using testing::number;
using testing::ShaderFolder;
using testing::ShadingScene;

V3f moved(const ShadingGrid& after, const ShadingGrid& before, size_t i, int key = 0) {
    return after.P[key].at(i) - before.P[key].at(i);
}

TEST(Displacement, SineWavesFollowTheirFormulaInShaderSpace) {
    ShadingScene scene;
    scene.attributes->displacement_bound = 1;
    ShaderInstance& waves =
        scene.displacement("sinewaves", {number("amplitude", 0.3f), number("frequency", 2)});
    waves.camera_from_shader.setScale(V3f(2));
    waves.camera_from_shader[3][0] = 0.1f;
    const ShadingGrid before = scene.grid(), after = scene.shaded(before);
    for (size_t i = 0; i < before.vertex_count(); ++i) {
        const V3f p = (before.P[0].at(i) - V3f(0.1f, 0, 0)) / 2;
        const auto wave = [](float x) { return std::sin(2 * M_PI * 2 * x); };
        const double height = 2 * 0.3 * (wave(p.x) + wave(p.y) + wave(p.z)) / 3;
        expect_near_triple(moved(after, before, i), V3f(0, 0, -static_cast<float>(height)), 2e-6f);
    }
    EXPECT_TRUE(after.displaced);
}

TEST(Displacement, NormalsFollowTheMovedSurface) {
    ShadingScene scene;
    scene.attributes->displacement_bound = 1;
    scene.displacement("sinewaves", {number("amplitude", 0.1f), number("frequency", 1)});
    const ShadingGrid after = scene.shaded(scene.grid(16, 16));
    for (int j = 1; j < 16; ++j)
        for (int i = 1; i < 16; ++i) {
            const V3f p = scene.grid(16, 16).P[0].at(after.shape.row_index(i, j));
            // z = 4 - a (sin 2 pi x + sin 2 pi y + sin 8 pi) / 3, seen from negative z.
            const float slope = 0.1f * 2 * static_cast<float>(M_PI) / 3;
            const V3f expected = V3f(-slope * std::cos(2 * static_cast<float>(M_PI) * p.x),
                                     -slope * std::cos(2 * static_cast<float>(M_PI) * p.y), -1)
                                     .normalized();
            expect_near_triple(after.N.at(after.shape.row_index(i, j)), expected, 0.01f);
            EXPECT_EQ(after.Ng.at(after.shape.row_index(i, j)), after.N.at(after.shape.row_index(i, j)));
        }
}

TEST(Displacement, OrientationIsKept) {
    ShadingScene scene;
    scene.attributes->displacement_bound = 1;
    scene.displacement("dented");
    ShadingGrid inside = scene.grid(8, 8);
    inside.reverse_orientation = true;
    inside.N.fill(inside.vertex_count(), V3f(0, 0, 1));
    const ShadingGrid outside = scene.shaded(scene.grid(8, 8));
    inside = scene.shaded(inside);
    for (size_t i = 0; i < inside.vertex_count(); ++i) {
        EXPECT_GT(inside.N.at(i).z, 0.3f);
        EXPECT_LT(outside.N.at(i).z, -0.3f);
    }
}

/// Two grids side by side with different rates that share three vertices of an edge at all keys.
TEST(Displacement, SharedVerticesStayShared) {
    for (const char* name : {"dented", "sinewaves"}) {
        ShadingScene scene;
        scene.attributes->displacement_bound = 10;
        scene.displacement(name, {number("amplitude", 0.7f), number("frequency", 3.3f)});
        M44f turn;
        turn.setAxisAngle(V3f(0.3f, 1, 0.2f).normalized(), 0.8f);
        scene.scene.primitives[0].camera_from_object = {M44f(), turn, turn * turn};
        ShadingGrid left = scene.grid(4, 2, 3), right = scene.grid(7, 2, 3);
        for (int key = 0; key < 3; ++key)
            for (int j = 0; j <= 2; ++j) {
                const V3f shared(1.1f, 0.37f * static_cast<float>(j + key), 3.9f);
                left.P[key].set(left.shape.row_index(4, j), shared);
                right.P[key].set(right.shape.row_index(0, j), shared);
                const V3f normal = V3f(0.3f, 0.1f * static_cast<float>(j), -1).normalized();
                left.N.set(left.shape.row_index(4, j), normal);
                right.N.set(right.shape.row_index(0, j), normal);
            }
        const ShadingGrid before = left;
        left = scene.shaded(left), right = scene.shaded(right);
        for (int key = 0; key < 3; ++key)
            for (int j = 0; j <= 2; ++j) {
                const size_t at = left.shape.row_index(4, j);
                EXPECT_EQ(left.P[key].at(at), right.P[key].at(right.shape.row_index(0, j)));
                EXPECT_NE(left.P[key].at(at), before.P[key].at(at));
            }
    }
}

TEST(Displacement, TurnsWithThePrimitive) {
    ShadingScene scene;
    scene.attributes->displacement_bound = 10;
    scene.displacement("dented", {number("amplitude", 0.5f)});
    M44f quarter;
    quarter.setAxisAngle(V3f(0, 1, 0), static_cast<float>(M_PI) / 2);  // z to x
    scene.scene.primitives[0].camera_from_object = {M44f(), quarter};
    const ShadingGrid before = scene.grid(4, 4, 2), after = scene.shaded(before);
    for (size_t i = 0; i < before.vertex_count(); ++i) {
        const V3f first = moved(after, before, i), last = moved(after, before, i, 1);
        expect_near_triple(last, V3f(first.z, 0, 0), 1e-6f);
    }
}

/// Bent along u, and turned in deforming, which a pose turns once more; the way turns along, also about the
/// normal, and stays as long where the surface grows.
TEST(Displacement, TurnsWithWhatDeforms) {
    ShadingScene scene;
    ShaderFolder folder;
    folder.write("aside", "displacement aside() { P += .3 * normalize(N) + .2 * normalize(dPdu) + .1 * s; }");
    scene.scene.options.search_paths["shader"] = {folder.path()};
    scene.attributes->displacement_bound = 10;
    scene.displacement("aside");
    Primitive& primitive = scene.scene.primitives[0];
    primitive.shape_keys = {std::make_shared<Shape>(), std::make_shared<Shape>()};
    M44f deformed, pose;
    deformed.setAxisAngle(V3f(1, 2, 3).normalized(), 1.2f);
    pose.setAxisAngle(V3f(3, 1, 0).normalized(), 0.7f);
    for (const float size : {1.0f, 1.5f}) {
        primitive.camera_from_object = {M44f(), pose};
        ShadingGrid before = scene.grid(6, 5, 2);
        for (size_t i = 0; i < before.vertex_count(); ++i) {
            const V3f flat = before.P[0].at(i), bent = flat + V3f(0, 0, 0.3f * flat.x * flat.x);
            before.P[0].set(i, bent);
            before.P[1].set(i, bent * size * deformed * pose);
        }
        const ShadingGrid after = scene.shaded(before);
        for (size_t i = 0; i < before.vertex_count(); ++i) {
            const V3f first = moved(after, before, i), last = moved(after, before, i, 1);
            EXPECT_GT(first.length(), 0.2f);
            expect_near_triple(last, first * deformed * pose, 3e-6f);
        }
    }
}

TEST(Displacement, KeysBetweenPosesAreInterpolated) {
    ShadingScene scene;
    scene.attributes->displacement_bound = 10;
    scene.displacement("sinewaves", {number("amplitude", 0.5f)});
    M44f larger;
    larger.setScale(V3f(3));
    scene.scene.primitives[0].camera_from_object = {M44f(), larger};
    const ShadingGrid before = scene.grid(4, 4, 3), after = scene.shaded(before);
    for (size_t i = 0; i < before.vertex_count(); ++i) {
        expect_near_triple(moved(after, before, i, 1), moved(after, before, i) * 2.0f, 1e-6f);
        expect_near_triple(moved(after, before, i, 2), moved(after, before, i) * 3.0f, 1e-6f);
    }
}

TEST(Displacement, BeyondItsBoundIsReportedWithTheBoundNeeded) {
    ShadingScene scene;
    scene.attributes->displacement_bound = 0.2f;
    scene.attributes->user.set("displacementbound", number("sphere", 0.1f));
    scene.displacement("sinewaves", {number("amplitude", 0.5f), number("frequency", 0.25f)});
    const ShadingGrid before = scene.grid(8, 8), after = scene.shaded(before);
    float farthest = 0;
    for (size_t i = 0; i < before.vertex_count(); ++i)
        farthest = std::max(farthest, moved(after, before, i).length());
    ASSERT_EQ(scene.reported.size(), 1u);
    char needed[64];
    std::snprintf(needed, sizeof needed, "\"sphere\" %.4g is needed", farthest / 2);
    EXPECT_NE(scene.reported[0].text.find(needed), std::string::npos) << scene.reported[0].text << needed;

    scene.reported.clear();
    scene.attributes->displacement_bound = 0.5f;
    scene.shaded(before);
    EXPECT_TRUE(scene.reported.empty());
}

TEST(Displacement, NullAndZeroNormalsMoveNothing) {
    ShadingScene scene;
    scene.displacement("null");
    const ShadingGrid before = scene.grid(), after = scene.shaded(before);
    EXPECT_EQ(after.P[0].c, before.P[0].c);
    EXPECT_EQ(after.N.c, before.N.c);
    EXPECT_FALSE(after.displaced);

    scene.displacement("dented");
    ShadingGrid flat = scene.grid();
    flat.N.fill(flat.vertex_count(), V3f(0));
    EXPECT_EQ(scene.shaded(flat).P[0].c, before.P[0].c);
}

/// A scene whose surface shader lifts P.
struct MovingSurface : ShadingScene {
    ShaderFolder folder;

    MovingSurface() {
        folder.write("lift",
                     "surface lift() { point before = P; P += 0.5 * s * normalize(N);"
                     "  Ci = color(P - before); Oi = 1; }");
        scene.options.search_paths["shader"] = {folder.path()};
        surface("lift");
    }
};

/// A class of RSL 2 that shades and displaces.
struct MovingClass : ShadingScene {
    ShaderFolder folder;

    MovingClass() {
        folder.write("both",
                     "class both(float Km = .5;) {"
                     "  public void displacement(output point P; output normal N) { P += high(); }"
                     "  private vector high() { return Km * s * normalize(N); }"
                     "  public void surface(output color Ci, Oi) { Ci = color(comp(P, 2)); Oi = 1; }"
                     "}");
        scene.options.search_paths["shader"] = {folder.path()};
        surface("both", {number("Km", 0.25f)});
    }
};

TEST(Displacement, BySurfacesThatAreClassesWithinTheBound) {
    MovingClass scene;
    scene.attributes->displacement_bound = 0.5f;
    const ShadingGrid before = scene.grid(), after = scene.shaded(before);
    EXPECT_TRUE(scene.reported.empty());
    for (size_t i = 0; i < before.vertex_count(); ++i) {
        expect_near_triple(moved(after, before, i), V3f(0, 0, -0.25f * before.s[i]), 1e-6f);
        EXPECT_EQ(after.Ci.at(i), V3f(after.P[0].at(i).z));  // it shades what has moved
    }
    EXPECT_TRUE(after.displaced);
    EXPECT_TRUE(Shading(scene.context).displacing_surfaces()(0));
}

/// Classes that shade and displace, within a bound of .5.
struct DisplacingClasses : ShadingScene {
    ShaderFolder folder;

    DisplacingClasses() {
        scene.options.search_paths["shader"] = {folder.path()};
        attributes->displacement_bound = 0.5f;
    }
};

/// What displacement() leaves in the class's members the methods that shade find there.
TEST(Displacement, LeavesMembersOfClassesToTheirSurfaces) {
    DisplacingClasses scene;
    scene.folder.write(
        "both",
        "class both() {"
        "  varying float high = 0; varying color tint = 0; uniform float k = 3; string word = \"none\";"
        "  public void begin() { high = 9; k = 4; }"
        "  public void displacement(output point P; output normal N) {"
        "    high = .25 * s; tint = color(s, t, 1); word = \"moved\"; k += 1; P += high * normalize(N); }"
        "  public void surface(output color Ci, Oi) {"
        "    Oi = 1; Ci = color(high, comp(tint, 1), k + (word == \"moved\" ? 10 : 0)); }"
        "}");
    scene.surface("both");
    const ShadingGrid before = scene.grid(), after = scene.shaded(before);
    EXPECT_TRUE(scene.reported.empty());
    for (size_t i = 0; i < before.vertex_count(); ++i)
        expect_near_triple(after.Ci.at(i), V3f(.25f * before.s[i], before.t[i], 15), 1e-6f);
}

TEST(Displacement, ByAnotherClassLeavesMembersAsTheyAre) {
    DisplacingClasses scene;
    for (const char* name : {"one", "two"})
        scene.folder.write(
            name, "class " + std::string(name) +
                      "(output varying float told = 2;) { varying float high = 0;"
                      "  public void begin() { high = 9; }"
                      "  public void displacement(output point P; output normal N) {"
                      "    high = .25; told = 3; P += high * normalize(N); }"
                      "  public void surface(output color Ci, Oi) { Oi = 1; Ci = color(high, told, 0); } }");
    scene.surface("one");
    EXPECT_EQ(scene.shaded(scene.grid()).Ci.at(0), V3f(.25f, 3, 0));
    scene.displacement("two");
    EXPECT_EQ(scene.shaded(scene.grid()).Ci.at(0), V3f(9, 2, 0));
    EXPECT_TRUE(scene.reported.empty());
}

/// Files may hold a shader under another name.
TEST(Displacement, ByAClassInAFileOfAnotherName) {
    MovingClass scene;
    std::filesystem::rename(scene.folder.path() + "/both.sl", scene.folder.path() + "/other.sl");
    scene.surface("other");
    scene.attributes->displacement_bound = 0.5f;
    const ShadingGrid before = scene.grid(), after = scene.shaded(before);
    EXPECT_TRUE(scene.reported.empty());
    for (size_t i = 0; i < before.vertex_count(); ++i)
        expect_near_triple(moved(after, before, i), V3f(0, 0, -0.5f * before.s[i]), 1e-6f);
}

/// The request's own parameters hold, and nothing moves twice.
TEST(Displacement, ByAClassThatIsNamedForItToo) {
    for (const float bound : {0.0f, 0.5f}) {
        MovingClass scene;
        scene.attributes->displacement_bound = bound;
        scene.displacement("both", {number("Km", 0.125f)});
        const ShadingGrid before = scene.grid(), after = scene.shaded(before);
        for (size_t i = 0; i < before.vertex_count(); ++i)
            expect_near_triple(moved(after, before, i), V3f(0, 0, -0.125f * before.s[i]), 1e-6f);
    }
}

TEST(Displacement, ByClassesWithoutABoundIsMissedAloud) {
    MovingClass scene;
    const ShadingGrid before = scene.grid(), after = scene.shaded(before);
    for (size_t i = 0; i < before.vertex_count(); ++i) EXPECT_EQ(after.P[0].at(i), before.P[0].at(i));
    ASSERT_EQ(scene.reported.size(), 1u);
    EXPECT_NE(scene.reported[0].text.find("displacementbound"), std::string::npos);
}

TEST(Displacement, BySurfaceShadersWithinTheBound) {
    MovingSurface scene;
    scene.attributes->displacement_bound = 0.5f;
    const ShadingGrid before = scene.grid(), after = scene.shaded(before);
    EXPECT_TRUE(scene.reported.empty()) << scene.reported.front().text;
    for (size_t i = 0; i < before.vertex_count(); ++i) {
        expect_near_triple(moved(after, before, i), V3f(0, 0, -0.5f * before.s[i]), 1e-6f);
        expect_near_triple(after.Ci.at(i), V3f(0, 0, -0.5f * before.s[i]), 1e-6f);
    }
    EXPECT_TRUE(after.displaced);
    EXPECT_TRUE(Shading(scene.context).displacing_surfaces()(0));

    scene.attributes->displacement_bound = 0.25f;
    scene.shaded(before);
    ASSERT_EQ(scene.reported.size(), 1u);
    EXPECT_NE(scene.reported[0].text.find("Surface \"lift\" moves the surface beyond"), std::string::npos)
        << scene.reported[0].text;
}

TEST(Displacement, SurfaceShadersWithoutABoundAreWarnedOf) {
    MovingSurface scene;
    const ShadingGrid before = scene.grid(), after = scene.shaded(before);
    EXPECT_EQ(after.P[0].c, before.P[0].c);
    EXPECT_NEAR(after.Ci.at(3).z, -0.5f * before.s[3], 1e-6f);
    ASSERT_EQ(scene.reported.size(), 1u);
    EXPECT_NE(scene.reported[0].text.find("Surface \"lift\" sets P"), std::string::npos);
    EXPECT_FALSE(Shading(scene.context).displacing_surfaces()(0));
}

/// As Displace(.., truedisp) of shaders that may move P, and bump N alone for now.
TEST(Displacement, SurfaceShadersThatLeavePAreNotWarnedOf) {
    MovingSurface scene;
    scene.folder.write("bumpy",
                       "surface bumpy(float truedisp = 0) { P += truedisp * normalize(N);"
                       "  N = calculatenormal(P); Ci = Cs; Oi = 1; }");
    scene.surface("bumpy");
    scene.shaded(scene.grid());
    EXPECT_TRUE(scene.reported.empty()) << scene.reported.front().text;
}

TEST(Displacement, ToNowhereStays) {
    ShadingScene scene;
    scene.displacement("sinewaves", {number("amplitude", 3e38f)}).camera_from_shader.setScale(V3f(10));
    const ShadingGrid before = scene.grid(), after = scene.shaded(before);
    EXPECT_EQ(after.P[0].c, before.P[0].c);
    EXPECT_TRUE(finite(after.N) && finite(after.Ci));
}

}  // namespace
}  // namespace trapeze
