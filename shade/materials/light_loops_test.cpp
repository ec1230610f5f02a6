// Shaders that ask each other: illuminance by category and cone, jumps out of it, illuminate and solar,
// messages between the shaders of a grid.
#include <cmath>

#include "shade/grid_messages.h"
#include "shade/materials/shader_folder_harness.h"
#include "shade/shading_harness.h"
#include "shade/vm/run_shader_harness.h"

namespace trapeze {
namespace {

using testing::number;
using testing::ShaderFolder;
using testing::ShadingScene;
using testing::text;

/// A scene whose surface is the body given, under lights of one shader with parameters.
class LitProbe {
  public:
    /// Light comes from z < 0, as seen from the grid, unless `axis` says something else.
    LitProbe() {
        folder_.write(
            "tagged",
            "light tagged(float level = 1, tilt = 0; string __category = \"\"; output float flag = 0.5;) {"
            "  solar(vector \"shader\" (sin(tilt), 0, cos(tilt)), 0) { Cl = level; flag = level * 2; } }");
        scene_.scene.options.search_paths["shader"] = {folder_.path()};
    }

    void light(float level, std::string category, float tilt = 0) {
        scene_.light("tagged",
                     {number("level", level), number("tilt", tilt), text("__category", std::move(category))});
    }

    ShadingScene& scene() { return scene_; }
    const ShaderFolder& folder() const { return folder_; }

    /// Red of Ci at each vertex.
    std::vector<float> shade(const std::string& body) {
        folder_.write("probe", "surface probe() { Oi = 1; Ci = 0; " + body + " }");
        scene_.surface("probe");
        const ShadingGrid grid = scene_.shaded();
        for (const Diagnostic& d : scene_.reported) ADD_FAILURE() << to_string(d);
        return grid.Ci.c[0];
    }

    void expect(const std::string& body, float value) {
        for (const float red : shade(body)) EXPECT_NEAR(red, value, 1e-4f * std::abs(value)) << body;
    }

  private:
    ShaderFolder folder_;
    ShadingScene scene_;
};

TEST(Illuminance, ChoosesLightsByCategory) {
    const std::pair<const char*, float> expected[] = {{"", 1111},     {"a", 11},    {"b", 10},
                                                      {"a,b", 11},    {"b,c", 110}, {"-a", 1100},
                                                      {"-a,c", 1000}, {"other", 0}, {"-other", 1111}};
    for (const auto& [wanted, sum] : expected) {
        LitProbe probe;
        probe.light(1, "a"), probe.light(10, "a,b"), probe.light(100, "c"), probe.light(1000, "");
        probe.expect("illuminance(\"" + std::string(wanted) + "\", P) { Ci += Cl; }", sum);
    }
}

TEST(Illuminance, ReachesAmbientLightsByTheirName) {
    LitProbe probe;
    probe.folder().write("gloom", "light gloom(string __category = \"far\") { Cl = 100; }");
    probe.scene().light("gloom");
    probe.light(1, "a");
    probe.expect("illuminance(P) Ci += Cl;", 1);
    probe.expect("illuminance(\"-b\", P) Ci += Cl;", 1);
    probe.expect("illuminance(\"far\", P) Ci += Cl;", 0);
    probe.expect("illuminance(\"ambient\", P, N, 0.1) if (L == vector 0) Ci += Cl;", 100);
    probe.expect(
        "illuminance(\"ambient,diffuse\", P) { Ci += Cl + 1000 * islightcategory(\"far\"); "
        "if (L == vector 0) Ci += 10000; }",
        11101);
    probe.expect("illuminance(\"ambient&-far,diffuse&-b\", P) Ci += Cl;", 1);
}

TEST(Illuminance, ChoosesLightsByCone) {
    const auto within = [](const std::string& cone, float sum) {
        LitProbe probe;
        probe.light(1, "", 0), probe.light(10, "", 0.5f), probe.light(100, "", 1.4f),
            probe.light(1000, "", 2);
        probe.expect("illuminance(P" + cone + ") { Ci += Cl; }", sum);
    };
    within("", 1111);
    within(", N, PI", 1111);
    within(", N, PI / 2", 111);
    within(", N, 0.6", 11);
    within(", N, 0.4", 1);
    within(", -N, PI / 2", 1000);
    within(", vector (-sin(0.5), 0, -cos(0.5)), 0.1", 10);
}

TEST(Illuminance, KeepsItsConeInEachTurn) {
    // The axis and the angle are computed, and the body needs registers of its own, and changes what the
    // angle was made from.
    LitProbe probe;
    probe.light(1, "", 0), probe.light(10, "", 0.5f), probe.light(100, "", 1.4f), probe.light(1000, "", 2);
    probe.expect(
        "float angle = 0.3 * (s + 2) / (s + 2); vector x = 0; illuminance(P, normalize(N * (t + 1)), angle * "
        "2) {"
        " angle = 0; x = normalize(L + I * s); x = x * length(x ^ I) + vector (s, t, 1); Ci += Cl + 0 * x . "
        "x; }",
        11);
    LitProbe changed;
    changed.light(1, "", 0), changed.light(10, "", 0.5f), changed.light(100, "", 1.4f);
    changed.expect("float angle = 0.6 + 0 * s; illuminance(P, N, angle) { angle = 3; Ci += Cl; }", 11);
}

TEST(Illuminance, IsALoopThatJumpsLeave) {
    const auto of_four = [](const std::string& body, float value) {
        LitProbe probe;
        for (const float level : {1.0f, 10.0f, 100.0f, 1000.0f}) probe.light(level, "");
        probe.expect(body, value);
    };
    of_four("illuminance(P) { if (comp(Cl, 0) == 10) continue; Ci += Cl; }", 1101);
    of_four("illuminance(P) { Ci += Cl; if (comp(Cl, 0) == 100) break; }", 111);
    of_four(
        "float n = 0; illuminance(P) { float i; for (i = 0; i < 5; i += 1) { n += 1; if (i == 2) break 2; } "
        "n += "
        "100; } Ci = n;",
        3);
    of_four(
        "float n = 0; illuminance(P) { float i; for (i = 0; i < 5; i += 1) { n += 1; if (i == 2) continue 2; "
        "} n "
        "+= 100; } Ci = n;",
        12);
    of_four(
        "float i; for (i = 0; i < 3; i += 1) illuminance(P) { Ci += Cl; if (comp(Cl, 0) == 10) break 2; }",
        11);
    of_four(
        "color all() { extern point P; extern color Cl; color sum = 0; illuminance(P) { sum += Cl; if "
        "(comp(Cl, 0) "
        "== 10) return sum; } return -1; } Ci = all();",
        11);
}

TEST(Illuminance, WithinAnotherLeavesItsLightAndDirection) {
    const auto of_three = [](const std::string& body, float value) {
        LitProbe probe;
        probe.light(1, "", 0), probe.light(10, "", 0.5f), probe.light(100, "", 1.4f);
        probe.expect(body, value);
    };
    of_three("illuminance(P) { float n = 0; illuminance(P) n += 1; Ci += n * Cl; }", 333);
    of_three("illuminance(P) { illuminance(P) { illuminance(P, N, 0.1) ; } Ci += Cl; }", 111);
    of_three("illuminance(P) { illuminance(P) ; if (normalize(L) . N > 0.99) Ci += 7; }", 7);
    // Only some lanes look at all lights again, and leave by a jump.
    of_three("illuminance(P) { if (s >= 0) illuminance(P) if (comp(Cl, 0) == 10) break; Ci += Cl; }", 111);
    of_three("illuminance(P) { illuminance(P) if (comp(Cl, 0) == 10) continue 2; Ci += Cl; }", 0);
}

TEST(Illuminance, LanesJumpApart) {
    LitProbe probe;
    for (const float level : {1.0f, 10.0f, 100.0f, 1000.0f}) probe.light(level, "");
    const std::vector<float> red = probe.shade(
        "illuminance(P) { if (s > 0.5 && comp(Cl, 0) > 50) break; if (t > 0.7) continue; Ci += Cl; }");
    const ShadingGrid grid = probe.scene().grid();
    for (size_t i = 0; i < red.size(); ++i)
        EXPECT_FLOAT_EQ(red[i], grid.t[i] > 0.7f ? 0 : grid.s[i] > 0.5f ? 11 : 1111) << i;
}

TEST(Illuminance, LAndClMayBeChangedForATurn) {
    LitProbe probe;
    probe.light(1, ""), probe.light(10, "");
    probe.expect("illuminance(P) { L = normalize(L) * 2; Cl *= 3; Ci += Cl * length(L); }", 66);
}

TEST(Illuminance, TellsTheCategoryOfItsTurn) {
    LitProbe probe;
    probe.light(1, "key,rim"), probe.light(10, "fill"), probe.light(100, "");
    probe.expect(
        "illuminance(P) { if (islightcategory(\"rim\") == 1) Ci += Cl; if (islightcategory(\"-fill\") == 1) "
        "Ci += 2 * Cl; } Ci += 1000 * islightcategory(\"key\");",
        1 + 2 + 200);
}

TEST(Messages, GoBetweenLightsAndSurfaces) {
    LitProbe probe;
    probe.light(1, ""), probe.light(10, "");
    probe.expect(
        "float flag = 7, none = 5; illuminance(P) { Ci += lightsource(\"flag\", flag) * 100 + flag; } Ci += "
        "lightsource(\"nothing\", none) * 1000 + none;",
        200 + 2 + 20 + 5);
    probe.expect(
        "float flag = 7; illuminance(P, N, PI, \"light:flag\", flag, \"lightcache\", \"reuse\") Ci += flag;",
        2 + 20);
    LitProbe asking;
    asking.folder().write(
        "asking",
        "light asking() { float k = 3; solar(vector (0, 0, 1), 0) { Cl = surface(\"Kq\", k) * 10 + k; "
        "} }");
    asking.folder().write("asked",
                          "surface asked(float Kq = 0.25) { Oi = 1; Ci = 0; illuminance(P) Ci += Cl; }");
    asking.scene().light("asking");
    asking.scene().surface("asked", {number("Kq", 0.5f)});
    const ShadingGrid grid = asking.scene().shaded();
    for (const float red : grid.Ci.c[0]) EXPECT_FLOAT_EQ(red, 10.5f);
}

TEST(Messages, DisplacementsTellSurfacesWhatTheyDid) {
    LitProbe probe;
    probe.folder().write("raised",
                         "displacement raised(output varying float height = 0) { height = s * 2; }");
    probe.scene().displacement("raised");
    const std::vector<float> red =
        probe.shade("float height = 9; Ci = displacement(\"height\", height) * 10; Ci += height;");
    const ShadingGrid grid = probe.scene().grid();
    for (size_t i = 0; i < red.size(); ++i) EXPECT_NEAR(red[i], 10 + grid.s[i] * 2, 1e-5f);
}

TEST(Messages, WhereThereIsNoShaderTheValueStays) {
    LitProbe probe;
    probe.expect(
        "float a = 1, b = 2, c = 3, d = 4; Ci = (atmosphere(\"k\", a) + incident(\"k\", b) + opposite(\"k\", "
        "c) + "
        "displacement(\"k\", d)) * 100 + a + b + c + d;",
        10);
}

TEST(Messages, IncidentIsTheAtmosphere) {
    testing::ShaderRun volume(
        "volume fog(float density = 0.25; output varying float depth = 0;) { depth = s; }");
    volume.run();
    ShadingScene scene;
    GridMessages messages(scene.context);
    std::vector<float> plane(kLanes, -1);
    vm::Operand out;
    out.data = plane.data();
    const rsl::Type number_type{rsl::Base::Float, 0};
    EXPECT_FALSE(messages.find(rsl::Op::IncidentMessage, "density", number_type, out, {}, nullptr));
    messages.atmosphere = &volume.registers();
    EXPECT_TRUE(messages.find(rsl::Op::IncidentMessage, "density", number_type, out, {}, nullptr));
    EXPECT_EQ(plane[0], 0.25f);
    EXPECT_FALSE(messages.find(rsl::Op::OppositeMessage, "density", number_type, out, {}, nullptr));
    EXPECT_FALSE(messages.find(rsl::Op::IncidentMessage, "nothing", number_type, out, {}, nullptr));
}

/// Runs a light over the grid as its own surface.
void expect_light(const std::string& body, const std::function<float(const V3f& Ps)>& red,
                  const std::function<bool(const V3f& Ps)>& is_lit) {
    testing::ShaderRun run("light test(output varying float r = 0;) { " + body + " r = comp(Cl, 0); }");
    std::vector<float> L(3 * padded_size(run.vertices()));
    std::vector<uint32_t> lit(padded_size(run.vertices()), 0);
    vm::LightOutput output{L.data(), lit.data()};
    vm::Context context;
    context.light_output = &output;
    run.run(context);
    EXPECT_EQ(run.messages(), "");
    for (size_t i = 0; i < run.vertices(); ++i) {
        const V3f Ps = run.grid().P[0].at(i);
        EXPECT_EQ(lit[i] != 0, is_lit(Ps)) << body << " at vertex " << i;
        EXPECT_NEAR(run.at("r", i), is_lit(Ps) ? red(Ps) : 0, 1e-5f) << body << " at vertex " << i;
    }
}

TEST(Illuminate, LightsFromAPointWithinACone) {
    const V3f from(0.5f, 0.5f, 3);
    expect_light(
        "illuminate(point (0.5, 0.5, 3)) { Cl = 1 / (L . L); }",
        [&](const V3f& Ps) { return 1 / (Ps - from).length2(); }, [](const V3f&) { return true; });
    // Vertices of the grid lie 1/6, 1/2 (and 0, 1/2 across) from its middle, one ahead.
    expect_light(
        "illuminate(point (0.5, 0.5, 3), vector (0, 0, 1), atan(0.3)) { Cl = 2; }",
        [](const V3f&) { return 2.0f; },
        [&](const V3f& Ps) { return std::hypot(Ps.x - 0.5f, Ps.y - 0.5f) < 0.3f; });
    expect_light(
        "illuminate(point (0.5, 0.5, 3), vector (0, 0, -1), PI / 2) { Cl = 2; }",
        [](const V3f&) { return 2.0f; }, [](const V3f&) { return false; });
}

TEST(Illuminate, NormalsTurnToTheEye) {
    LitProbe probe;
    probe.folder().write("facing", "light facing() { illuminate(Ps + faceforward(Ns, I)) { Cl = 1; } }");
    probe.folder().write("probe", "surface probe() { Oi = 1; Ci = 0; illuminance(P) Ci += -zcomp(L); }");
    probe.scene().light("facing");
    probe.scene().surface("probe");
    for (const float z : {-1.0f, 1.0f}) {
        ShadingGrid grid = probe.scene().grid();
        grid.N.fill(grid.vertex_count(), V3f(0, 0, z));
        const ShadingGrid shaded = probe.scene().shaded(grid);
        for (const float red : shaded.Ci.c[0]) EXPECT_FLOAT_EQ(red, 1);
    }
}

TEST(Solar, LightsAlongAnAxisOrFromAllSides) {
    expect_light(
        "solar(vector (0, 3, 4), 0) { Cl = ycomp(L) / length(L); }", [](const V3f&) { return 0.6f; },
        [](const V3f&) { return true; });
    // Light from all sides comes against the normal, (0, 0, -1).
    LitProbe probe;
    probe.folder().write("sky", "light sky() { solar() { Cl = 3 * zcomp(L); } }");
    probe.scene().light("sky");
    probe.expect("illuminance(P) { Ci += Cl * -zcomp(L); }", 3);
}

TEST(Gather, TakesTheOtherHalfForEachRayThatMisses) {
    for (const bool optimised : {false, true}) {
        testing::ShaderRun run(
            "surface test(output varying float r = 0, left = 0, none = 0;) { color c = 0; float n = 6;"
            "gather(\"illuminance\", P, N, 0.5, n, \"surface:Ci\", c) { r += 100; } else { r += 1; }"
            "gather(\"illuminance\", P, N, 0.5, n, \"surface:Ci\", c) { left += 100; }"
            "else { left += 1; if (left > 2 && s > 0.5) break; left += 10; }"
            "gather(\"illuminance\", P, N, 0.5, 0, \"surface:Ci\", c) { none += 1; } else { none += 1; }"
            "gather(\"illuminance\", P, N, 0.5, 4, \"surface:Ci\", c) { none += 1; } }",
            optimised);
        run.run();
        for (size_t i = 0; i < run.vertices(); ++i) {
            EXPECT_EQ(run.at("r", i), 6);
            EXPECT_EQ(run.at("left", i), run.grid().s[i] > 0.5f ? 12 : 66);
            EXPECT_EQ(run.at("none", i), 0);
        }
    }
}

/// A map is named by a parameter, as lights have it.
TEST(Gather, OfAMapAsksForNoRays) {
    const auto asks_rays = [](const std::string& category) {
        LitProbe probe;
        probe.folder().write("sky", "light sky(string map = \"\") { color c = 0; Cl = 0; gather(concat(" +
                                        category +
                                        ", map), 0, 0, 0, 4, \"environment:color\", c) Cl += c; }");
        probe.folder().write("probe", "surface probe() { Ci = ambient(); }");
        probe.scene().light("sky", {text("map", "none.tx")});
        probe.scene().surface("probe");
        return Shading(probe.scene().context).asks_rays();
    };
    EXPECT_FALSE(asks_rays("\"environment:\""));
    EXPECT_TRUE(asks_rays("\"illuminance\""));
}

}  // namespace
}  // namespace trapeze
