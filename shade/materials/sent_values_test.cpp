// What illuminance sends to lights: "send:light:NAME", "lightcache".
#include <gtest/gtest.h>

#include <cmath>
#include <type_traits>

#include "shade/materials/shader_folder_harness.h"
#include "shade/shading_harness.h"

namespace trapeze {
namespace {

using testing::number;
using testing::ShaderFolder;
using testing::ShadingScene;

/// A scene whose surface is the body given, under lights that shine as their parameters say.
class SendingProbe {
  public:
    SendingProbe() {
        scene_.scene.options.search_paths["shader"] = {folder_.path()};
        write("told", "uniform float level = 1; output varying float heard = 0;",
              "heard = 2 * level; Cl = level;");
        write("deaf", "float other = 100;", "Cl = other;");
    }

    void write(const std::string& name, const std::string& parameters, const std::string& body) {
        folder_.write(
            name, "light " + name + "(" + parameters + ") { solar(vector (0, 0, 1), 0) { " + body + " } }");
    }
    ShadingScene& scene() { return scene_; }
    const ShaderFolder& folder() const { return folder_; }

    /// Red of Ci at each vertex.
    std::vector<float> shade(const std::string& body) {
        folder_.write("probe",
                      "surface probe(output varying float asked = 0;) { Oi = 1; Ci = 0; " + body + " }");
        scene_.surface("probe");
        return scene_.shaded().Ci.c[0];
    }

    /// `value`: of s and t, or one for all.
    template <class Value>
    void expect(const std::string& body, const Value& value) {
        const std::vector<float> red = shade(body);
        const ShadingGrid grid = scene_.grid();
        for (const Diagnostic& d : scene_.reported) ADD_FAILURE() << to_string(d);
        ASSERT_EQ(red.size(), grid.s.size());
        for (size_t i = 0; i < red.size(); ++i) {
            float wanted = 0;
            if constexpr (std::is_invocable_v<Value, float, float>)
                wanted = value(grid.s[i], grid.t[i]);
            else
                wanted = static_cast<float>(value);
            EXPECT_NEAR(red[i], wanted, 1e-5f * std::max(std::abs(wanted), 1.0f))
                << body << " at vertex " << i;
        }
    }

  private:
    ShaderFolder folder_;
    ShadingScene scene_;
};

TEST(SentValues, StandInPlaceOfAParameterWhereALightHasIt) {
    SendingProbe probe;
    probe.scene().light("told");
    probe.scene().light("deaf");
    probe.scene().light("told", {number("level", 10)});
    probe.expect("illuminance(P) Ci += Cl;", 111);
    probe.expect("illuminance(P, N, PI, \"send:light:level\", 3) Ci += Cl;", 106);
    probe.expect("illuminance(\"\", P, \"send:light:none\", 3) Ci += Cl;", 111);
    probe.expect(
        "illuminance(\"\", P, N, PI / 2, \"send:light:other\", 1, \"send:light:level\", 2) Ci += Cl;", 5);
    probe.expect("illuminance(P, \"send:light:level\", s * 4 + t) Ci += Cl;",
                 [](float s, float t) { return 100 + 2 * (4 * s + t); });
}

TEST(SentValues, AreOfAnyType) {
    const auto of_type = [](const char* parameter, const char* light, const char* sent, const auto& value) {
        SendingProbe probe;
        probe.write("typed", parameter, light);
        probe.scene().light("typed");
        probe.expect(std::string("float k[3] = {s, 2, 3}; string names[2] = {\"a\", \"b\"};") +
                         "illuminance(P, \"send:light:x\", " + sent + ") Ci += Cl;",
                     value);
    };
    const auto tripled = [](float s, float t) { return s + 10 * t + 300; };
    const char* const weighed = "Cl = comp(x, 0) + 10 * comp(x, 1) + 100 * comp(x, 2);";
    of_type("color x = 0", weighed, "color (s, t, 3)", tripled);
    of_type("uniform vector x = 0", "Cl = xcomp(x) + 10 * ycomp(x) + 100 * zcomp(x);", "normal (s, t, 3)",
            tripled);
    of_type("varying point x = 0", "Cl = xcomp(x) + 10 * ycomp(x) + 100 * zcomp(x);", "point (s, t, 3)",
            tripled);
    of_type("matrix x = 0", "Cl = comp(x, 0, 0) + comp(x, 3, 2);",
            "matrix (1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,s,1)", [](float s, float) { return 1 + s; });
    of_type("float x[3] = 0", "Cl = x[0] + 10 * x[1] + 100 * x[2];", "k",
            [](float s, float) { return s + 320; });
    of_type("string x = \"\"", "Cl = x == \"yes\" ? 5 : 1;", "concat(\"y\", \"es\")",
            [](float, float) { return 5.0f; });
    of_type("string x[2] = {\"\", \"\"}", "Cl = x[1] == \"b\" && x[0] == \"a\" ? 5 : 1;", "names",
            [](float, float) { return 5.0f; });
    of_type("varying float x = s + zcomp(Ps)", "Cl = x;", "t", [](float, float t) { return t; });
}

/// The light is as the surface was when it ran.
TEST(SentValues, LeaveWhatIsKeptOfLights) {
    SendingProbe probe;
    probe.write("asking", "float level = 1;", "float now = 0; surface(\"asked\", now); Cl = now * level;");
    probe.scene().light("asking");
    probe.expect("asked = 1; illuminance(P) Ci += Cl; asked = 10; illuminance(P) Ci += Cl;", 2);
    probe.expect(
        "asked = 1; illuminance(P) Ci += Cl; asked = 10;"
        "illuminance(P, \"send:light:level\", 3) Ci += Cl; illuminance(P, \"lightcache\", \"reuse\") Ci += Cl;"
        "Ci += diffuse(N);",
        1 + 30 + 1 + 1);
    probe.expect(
        "asked = 10; illuminance(P, \"send:light:level\", 3) Ci += Cl; asked = 1; illuminance(P) Ci += Cl;",
        31);
    probe.expect(
        "asked = 1; illuminance(P) Ci += Cl; asked = 10; illuminance(P, \"lightcache\", \"refresh\") Ci += Cl;"
        "asked = 100; illuminance(P) Ci += Cl;",
        1 + 10 + 10);
    probe.expect(
        "string how = shadername() == \"none\" ? \"\" : \"refresh\"; asked = 1; illuminance(P) Ci += Cl; asked = 10;"
        "illuminance(P, \"lightcache\", how) Ci += Cl;",
        11);
}

TEST(SentValues, LightsTellWhatTheyMadeOfThem) {
    SendingProbe probe;
    probe.scene().light("told");
    probe.scene().light("told", {number("level", 10)});
    probe.expect(
        "float heard = 0; illuminance(P, \"send:light:level\", s, \"light:heard\", heard) Ci += heard;",
        [](float s, float) { return 4 * s; });
    probe.expect(
        "float heard = 0; illuminance(P, \"send:light:level\", 3) {"
        " illuminance(P, \"send:light:level\", 5) { lightsource(\"heard\", heard); Ci += heard; }"
        " illuminance(P) { lightsource(\"heard\", heard); Ci += heard; }"
        " lightsource(\"heard\", heard); Ci += 1000 * heard; }",
        2 * (20 + 22 + 6000));
}

TEST(SentValues, AreThoseOfTheLoopsBeginning) {
    SendingProbe probe;
    probe.write("list", "float k[2] = {0, 0};", "Cl = k[0] + k[1];");
    probe.scene().light("told");
    probe.scene().light("told");
    probe.scene().light("list");
    probe.expect(
        "float k = 3, m[2] = {s, 4}; illuminance(P, \"send:light:level\", k, \"send:light:k\", m) {"
        " k = 100; m[1] = 100; Ci += Cl; }",
        [](float s, float) { return 6 + s + 4; });
    probe.expect("float i; for (i = 1; i < 4; i += 1) illuminance(P, \"send:light:level\", i) Ci += Cl;", 12);
}

/// Where nothing is sent the light has its own values, of which other vertices may know.
TEST(SentValues, ReachTheVerticesThatSend) {
    SendingProbe probe;
    probe.write("wide", "float level = 1;", "Cl = level + 100 * gridmax(level);");
    probe.scene().light("wide");
    probe.expect(
        "if (s > 0.5) { illuminance(P, \"send:light:level\", -s) Ci += Cl; } else { illuminance(P) Ci += Cl; }",
        [](float s, float) { return s > 0.5f ? 100 - s : 101; });
    probe.expect("if (s > 0.5) { illuminance(P, \"send:light:level\", -2) Ci += Cl; }",
                 [](float s, float) { return s > 0.5f ? -202.0f : 0.0f; });
}

/// Each sample is a light that is told, at the same places.
TEST(SentValues, ReachAllSamplesOfAreaLights) {
    SendingProbe probe;
    probe.folder().write("area",
                         "light area(float level = 2) { illuminate(P, N, PI / 2) Cl = level / (L . L); }");
    const auto light = std::make_shared<LightInstance>();
    light->shader = testing::shader("area");
    light->shader.camera_from_shader[3][2] = 2;
    light->shape.emplace();
    light->shape->kind = LightShape::Kind::Rect, light->shape->samples = 5;
    probe.scene().attributes->lights.push_back(light);
    const std::vector<float> own = probe.shade("illuminance(P) Ci += Cl;");
    const std::vector<float> told = probe.shade("illuminance(P, \"send:light:level\", 4 * s) Ci += Cl;");
    const std::vector<float> after = probe.shade(
        "illuminance(P, \"send:light:level\", 0) Ci += Cl;"
        "illuminance(P) Ci += Cl;");
    const ShadingGrid grid = probe.scene().grid();
    for (size_t i = 0; i < own.size(); ++i) {
        EXPECT_GT(own[i], 0);
        EXPECT_NEAR(told[i], own[i] * 2 * grid.s[i], 1e-5f);
        EXPECT_EQ(after[i], own[i]);
    }
}

/// Lights ask for rays where they are told to, though their own values would not.
TEST(SentValues, MayMakeLightsAskForRays) {
    const auto asks_rays = [](const std::string& body) {
        SendingProbe probe;
        probe.write(
            "shaded", "float traces = 0; string map = \"\";",
            "Cl = 1; if (traces > 0) Cl *= transmission(Ps, Ps - L); if (map != \"\") Cl *= 1 - shadow(map, Ps);");
        probe.folder().write("probe", "surface probe() { illuminance(P" + body + ") Ci += Cl; }");
        probe.scene().light("shaded");
        probe.scene().surface("probe");
        return Shading(probe.scene().context).asks_rays();
    };
    EXPECT_FALSE(asks_rays(""));
    EXPECT_FALSE(asks_rays(", \"send:light:other\", 1, \"send:light:map\", \"flat.shd\""));
    EXPECT_TRUE(asks_rays(", \"send:light:traces\", 1"));
    EXPECT_TRUE(asks_rays(", \"send:light:map\", \"raytrace\""));
}

TEST(SentValues, OfOtherTypesAreReportedAndNotTaken) {
    SendingProbe probe;
    probe.write("typed", "color level = 2; string name = \"\"; float list[2] = 0;", "Cl = level;");
    probe.scene().light("typed");
    for (const float red : probe.shade("illuminance(P, \"send:light:level\", 3, \"send:light:name\", 2,"
                                       " \"send:light:list\", 1) Ci += Cl;"))
        EXPECT_EQ(red, 2);
    ASSERT_EQ(probe.scene().reported.size(), 3u);
    EXPECT_NE(
        to_string(probe.scene().reported[0])
            .find(
                "probe.sl:1:66: warning: light shader \"typed\" declares \"level\" as another type than what "
                "illuminance sends, and does not take it"),
        std::string::npos)
        << to_string(probe.scene().reported[0]);
}

}  // namespace
}  // namespace trapeze
