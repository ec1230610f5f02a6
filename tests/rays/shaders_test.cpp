/// Standard shaders and lights that trace, next to closed forms.
#include <gtest/gtest.h>

#include "tests/rays/rays_harness.h"

namespace trapeze::testing {
namespace {

std::string depth_option(int bounces) {
    return "Attribute \"trace\" \"int maxspeculardepth\" [" + std::to_string(bounces) + "] ";
}

/// Light that passes the standard glass is weakened at both sides by what Fresnel's formulas reflect there,
/// which is the same from within.
TEST(RayGlass, TheStandardGlassIsAsBrightAsFresnelSays) {
    Case c;
    c.asker = depth_option(4);
    c.things = depth_option(4) + "Surface \"glass\" \"Kr\" 0 \"Ks\" 0 \"Ka\" 0 " + sphere("0 0 3", ".5") +
               "Surface \"constant\" " + wall("-20") + wall("2");
    expect_told(c.render("vector d = vector(0, 0, -1), R, T; float kr, kt;"
                         "float r2 = xcomp(P) * xcomp(P) + ycomp(P) * ycomp(P);"
                         "vector n = normalize(vector(xcomp(P), ycomp(P), sqrt(max(.25 - r2, 0))));"
                         "fresnel(d, normal n, 1 / 1.5, kr, kt, R, T); color k = trace(P, d);"
                         "Ci = told(comp(k, 1), kt * kt, r2 < .15 ? 1 : 0);"),
                3e-3f, 400);
}

/// Mirrors and shiny metal show what trace() does, blurred by a cone as it is asked for.
TEST(RayShaders, ReflectorsTrace) {
    Case c;
    const std::string things = kSeen + kHidden + "Surface \"constant\" Color .25 .5 1 ";
    const auto shine = [&](const std::string& surface, const std::string& thing) {
        c.things = things + thing;
        // The camera looks at the reflector itself.
        c.asks = "Surface \"" + surface + " " + kAsker;
        return mean(c.render("Ci = 0;"), [](const Pixel& p) { return static_cast<double>(p.green); });
    };
    EXPECT_NEAR(shine("mirror\" \"Ks\" 0", wall("-3")), 0.5, 1e-3);
    EXPECT_NEAR(shine("shinymetal\" \"Ks\" 0 \"Ka\" 0 \"texturename\" \"raytrace\"", wall("-3")), 0.5, 1e-3);
    EXPECT_NEAR(shine("mirror\" \"Ks\" 0 \"texturename\" \"raytrace\"", wall("-3")), 0.5, 1e-3);
    EXPECT_NEAR(shine("metal\" \"Ks\" 0 \"Ka\" 0 \"Kr\" .5", wall("-3")), 0.25, 1e-3);
    // Without a map it is metal, and asks for no rays: nobody is told that there are none to meet.
    EXPECT_EQ(shine("shinymetal\" \"Ks\" 0 \"Ka\" 0", wall("-3")), 0);
    EXPECT_EQ(shine("metal\" \"Ks\" 0 \"Ka\" 0", wall("-3")), 0);
    // A half plane: under a cone its edge is half as bright.
    const std::string half = "Polygon \"P\" [0 -99 -3 99 -99 -3 99 99 -3 0 99 -3] ";
    for (const char* surface : {"mirror\" \"Ks\" 0", "metal\" \"Ks\" 0 \"Ka\" 0 \"Kr\" 1",
                                "shinymetal\" \"Ks\" 0 \"Ka\" 0 \"texturename\" \"raytrace\""}) {
        c.things = things + half;
        c.asks = std::string("Surface \"") + surface + " \"samples\" 64 \"blur\" .2 " + kAsker;
        const std::vector<Pixel> all = pixels(c.render("Ci = 0;"));
        double middle = 0, left = 0, right = 0;
        for (size_t y = 0; y < 64; ++y) {
            for (const size_t x : {31u, 32u}) middle += static_cast<double>(all[y * 64 + x].green) / 128;
            left += static_cast<double>(all[y * 64].green) / 64;
            right += static_cast<double>(all[y * 64 + 63].green) / 64;
        }
        EXPECT_NEAR(middle, 0.25, 0.01);
        // The cone at a distance of 8 has a radius of 1.62: of a disk, 1 from its middle, a segment is left.
        const double d = 1 - 1.0 / 64, r = 8 * std::tan(0.2);
        const double share = (std::acos(d / r) - d / r * std::sqrt(1 - d * d / r / r)) / M_PI;
        EXPECT_NEAR(left, 0.5 * share, 0.01);
        EXPECT_NEAR(right, 0.5 * (1 - share), 0.01);
    }
}

/// The light from all around is what occlusion() leaves: of a sphere its form factor. It is ambient light.
TEST(RayShaders, TheOcclusionLightIsWhatIsOpen) {
    Case c;
    c.things = "Surface \"constant\" " + sphere("0 0 3", ".5");
    const std::string light = "LightSource \"occlusionlight\" 1 \"samples\" 64 ";
    c.asks = light + kAsker;
    const std::string formula =
        "vector m = point(0, 0, 3) - P; float d2 = m . m; float open = 1 - .25 / d2 * (2 / sqrt(d2)); ";
    const Image image = c.render(formula + "color a = ambient(); Ci = color(comp(a, 0), open, 1);");
    EXPECT_NEAR(mean_red(image), mean_found(image), 1e-3);
    for (const Pixel& p : pixels(image)) {
        const double hidden = 1 - static_cast<double>(p.green);
        ASSERT_NEAR(p.red, p.green, 5 * std::sqrt(hidden * (1 - hidden) / 64));
    }
    c.asks = "LightSource \"occlusionlight\" 1 \"samples\" 16 \"maxdist\" 1 \"intensity\" .5 " + kAsker;
    expect_told(c.render("color a = ambient(); Ci = told(comp(a, 0), .5, 1);"), 1e-6f, 64 * 64);
}

/// Shadows of coloured glass have its colour; a float tells their mean.
TEST(RayShaders, ShadowsOfStandardLightsAreColored) {
    Case c;
    c.things = "Opacity .75 .5 .125 Surface \"constant\" " + wall("3");
    c.functions =
        "color lit() { color sum = 0; illuminance(P, normal(0, 0, -1), PI) sum += Cl; return sum; }";
    for (const std::string light : {"\"shadowpoint\" 1 \"sfpz\" \"raytrace\"",
                                    "\"shadowspot\" 1 \"coneangle\" 1 \"shadowname\" \"raytrace\"",
                                    "\"shadowdistant\" 1 \"shadowname\" \"raytrace\"",
                                    "\"uberlight\" 1 \"width\" 9 \"height\" 9 \"shadowmap\" \"raytrace\""}) {
        c.asker = "LightSource " + light + " ";
        const Image image = c.render("color k = lit(); Ci = told(comp(k, 1) / comp(k, 0), 2, 1);");
        expect_told(image, 1e-4f, 64 * 64, 1e-4f);
        expect_told(c.render("color k = lit(); Ci = told(comp(k, 2) / comp(k, 0), 3.5, 1);"), 1e-4f, 64 * 64,
                    1e-4f);
    }
    c.asker = "";
    expect_told(
        c.render("float open = visibility(P, point(0, 0, 0)); Ci = told(open, (.25 + .5 + .875) / 3, 1);"),
        1e-5f, 64 * 64, 1e-5f);
    c.shaders["grey"] =
        "light grey() { solar(vector \"world\" (0, 0, 1), 0) { float hidden = shadow(\"raytrace\", Ps); Cl = hidden; } }";
    c.asker = "LightSource \"grey\" 1 ";
    expect_told(c.render("Ci = told(comp(lit(), 0), (.75 + .5 + .125) / 3, 1);"), 1e-5f, 64 * 64, 1e-5f);
}

/// Standard lights whose maps are "raytrace" cast the shadows that transmission() finds.
TEST(RayShaders, StandardLightsTraceTheirShadows) {
    Case c;
    c.things = "Surface \"constant\" " + sphere("0 0 3", ".3");
    for (const char* light :
         {"\"shadowpoint\" 1 \"from\" [.3 .2 0] \"sfpz\" \"raytrace\"",
          "\"shadowspot\" 1 \"from\" [.3 .2 0] \"to\" [.3 .2 5] \"coneangle\" 1 \"shadowname\" "
          "\"raytrace\""}) {
        SCOPED_TRACE(light);
        c.asks = std::string("LightSource ") + light + " " + kAsker;
        const Image image = c.render(
            "point from = point(.3, .2, 0); vector way = normalize(from - P), m = point(0, 0, 3) - P;"
            "float passes = length(m - (m . way) * way), lit = 0;"
            "illuminance(P) { lit = comp(Cl, 0) > 0 ? 1 : 0; }"
            "Ci = told(lit, passes > .3 ? 1 : 0, abs(passes - .3) > .01 ? 1 : 0);");
        expect_told(image, 0, 3500);
        EXPECT_LT(mean_found(image), 0.99);
    }
    // An uberlight lies at its origin and shines along z.
    c.asks =
        "TransformBegin Translate .3 .2 0 LightSource \"uberlight\" 1 \"width\" 9 \"height\" 9 \"shadowmap\" "
        "\"raytrace\" TransformEnd " +
        kAsker;
    expect_told(
        c.render("point from = point(.3, .2, 0); vector way = normalize(from - P), m = point(0, 0, 3) - P;"
                 "float passes = length(m - (m . way) * way), lit = 0;"
                 "illuminance(P) { lit = comp(Cl, 0) > 0 ? 1 : 0; }"
                 "Ci = told(lit, passes > .3 ? 1 : 0, abs(passes - .3) > .06 ? 1 : 0);"),
        0, 3000);
}

/// Their "blur" is the half angle of the cone over which rays to the light are spread: a ball that is seen
/// under another angle hides all, nothing, or where its rim goes through the cone's middle about half of it.
TEST(RayShaders, StandardLightsBlurTheirShadows) {
    Case c;
    c.things = "Surface \"constant\" " + sphere("0 0 3", ".3");
    const std::string from = "\"from\" [.3 .2 0] ", to = "\"to\" [.3 .2 5] ";
    for (const auto& [light, shadow, way] :
         {std::tuple("\"shadowpoint\" %d " + from, "\"sfpz\" \"raytrace\" \"blur\" .05 ", "from - P"),
          {"\"shadowspot\" %d " + from + to + "\"coneangle\" 1 ",
           "\"shadowname\" \"raytrace\" \"blur\" .05 \"samples\" 64 ", "from - P"},
          {"\"shadowdistant\" %d \"from\" [0 0 0] \"to\" [0 0 1] ",
           "\"shadowname\" \"raytrace\" \"blur\" .05 ", "vector(0, 0, -1)"},
          {"\"uberlight\" %d \"width\" 9 \"height\" 9 ", "\"shadowmap\" \"raytrace\" \"shadowblur\" .05 ",
           "from - P"}}) {
        SCOPED_TRACE(light);
        const std::string open = std::string(light).replace(light.find("%d"), 2, "2");
        const std::string shaded = std::string(light).replace(light.find("%d"), 2, "1") + shadow;
        const bool placed = light.find("uber") != std::string::npos;
        c.asks = std::string("TransformBegin ") + (placed ? "Translate .3 .2 0 " : "") + "LightSource " +
                 shaded + " LightSource " + open + " TransformEnd " + kAsker;
        const std::string asks =
            "point from = point(.3, .2, 0); vector way = normalize(" + std::string(way) +
            "), m = point(0, 0, 3) - P; float off = acos(way . normalize(m)) - asin(.3 / length(m)), "
            "lit = -1, all = 0; illuminance(P) { if (lit < 0) lit = comp(Cl, 0); else all = comp(Cl, 0); }";
        // The uberlight's surface is its plane, so that its rays may begin elsewhere.
        expect_told(c.render(asks + "Ci = told(lit / all, off > 0 ? 1 : 0, abs(off) > .054 ? 1 : 0);"), 1e-5f,
                    1500);
        const Image rim = c.render(asks + "Ci = told(lit / all, .5, abs(off) < .004 ? 1 : 0);");
        expect_told(rim, .2f, 20, .5f);
    }
}

/// In an illuminance block the light of the turn casts the shadow: from where it is, past nothing behind it,
/// or from infinitely far.
TEST(RayShaders, ShadowsOfSurfacesAreOfTheLightOfTheTurn) {
    const std::string point_light = "LightSource \"pointlight\" 1 \"from\" [.3 .2 0] ",
                      sun = "LightSource \"distantlight\" 2 \"from\" [0 0 0] \"to\" [.1 0 1] ";
    const std::string asks =
        "float hidden = -1; illuminance(P) { color k = shadow(\"raytrace\", P); hidden = comp(k, 1); }";
    const std::string by_point =
        "point from = point(.3, .2, 0); vector way = normalize(from - P), m = point(0, 0, 3) - P;";
    const std::string by_sun = "vector way = normalize(vector(-.1, 0, -1)), m = point(0, 0, 3) - P;";
    const std::string tells =
        "float passes = length(m - (m . way) * way);"
        "Ci = told(hidden, passes > .3 ? 0 : 1, abs(passes - .3) > .01 ? 1 : 0);";
    Case c;
    const std::string ball = "Surface \"constant\" " + sphere("0 0 3", ".3"), behind = wall("-1");
    c.things = ball + behind;
    c.asker = point_light;
    const Image image = c.render(by_point + asks + tells);
    expect_told(image, 0, 3500);
    EXPECT_GT(mean_found(image), 0.01);
    c.things = ball, c.asker = sun;
    expect_told(c.render(by_sun + asks + tells), 0, 3500);
    c.things = ball + behind;
    expect_told(c.render(asks + "Ci = told(hidden, 1, 1);"), 0, 64 * 64);
    // Of two lights each has its own, also behind another block within the turn.
    c.things = ball, c.asker = sun + point_light;
    const std::string both =
        "float sum = 0, n = 0; illuminance(P) { float own = length(L) < 9 && xcomp(normalize(L)) != "
        "xcomp(normalize(vector(-.1, 0, -1))) ? 1 : 0;"
        "  float h = shadow(\"raytrace\", P); if (own == 1) { n += 1; sum += h; } }"
        "float hidden = n == 1 ? sum : -1;";
    expect_told(c.render(by_point + both + tells), 0, 3500);
}

/// Elsewhere nobody knows which light is meant.
TEST(RayShaders, ShadowsOfNoLightAreWarnedOf) {
    Case c;
    c.things = "Surface \"constant\" " + wall("3");
    c.may_say = "rsl-shadow-without-light";
    expect_told(c.render("float hidden = shadow(\"raytrace\", P); Ci = told(hidden, 0, 1);"), 0, 64 * 64);
    ASSERT_EQ(c.said.size(), 1u);
    EXPECT_EQ(c.said[0].severity, Severity::Warning);
    EXPECT_NE(to_string(c.said[0]).find("ask.sl:1:"), std::string::npos) << to_string(c.said[0]);
}

/// A light's shader that asks before it says where the light is.
TEST(RayShaders, ShadowsBeforeTheLightIsPlacedAreWarnedOf) {
    for (const auto& [early, warnings] : {std::pair("", 0), {"hidden = shadow(\"raytrace\", Ps);", 1}}) {
        SCOPED_TRACE(early);
        Case c;
        c.shaders["lamp"] = "light lamp() { float hidden = 0; " + std::string(early) +
                            " illuminate(point \"world\" (0, 0, 0)) {"
                            " if (hidden == 0 && " +
                            (warnings ? "0" : "1") +
                            " == 1) hidden = shadow(\"raytrace\", Ps); Cl = 1 - hidden; } }";
        c.things = "Surface \"constant\" " + wall("3");
        c.asker = "LightSource \"lamp\" 1 ";
        c.may_say = "rsl-shadow-without-light";
        expect_told(c.render("color k = 0; illuminance(P) k += Cl; Ci = told(comp(k, 0), " +
                             std::to_string(warnings) + ", 1);"),
                    0, 64 * 64);
        EXPECT_EQ(c.said.size(), static_cast<size_t>(warnings));
    }
}

/// In a room of mirrors each bounce behind the first takes one ray, whatever "samples" says.
TEST(RayShaders, TakeTheirSamplesAtTheFirstBounceAlone) {
    for (const std::string surface :
         {"\"mirror\"", "\"glass\"", "\"shinymetal\" \"texturename\" [\"raytrace\"]",
          "\"metal\" \"Kr\" [1]"}) {
        const auto rays_of = [&](int depth) {
            WorkFolder folder;
            folder.write(
                "a.rib",
                "Option \"trace\" \"int maxdepth\" [" + std::to_string(depth) +
                    "] Display \"x\" \"exr\" \"rgb\" Format 8 8 1 PixelSamples 1 1 Projection "
                    "\"perspective\" \"fov\" 40 WorldBegin Attribute \"trace\" \"int maxspeculardepth\" "
                    "[9] Attribute \"visibility\" \"int specular\" [1] Surface " +
                    surface +
                    " \"float samples\" [4] \"float blur\" [.2] \"float Kt\" [0] Sphere 5 -5 5 360 WorldEnd\n");
            const auto frames = render_scene((folder / "a.rib").string(), {});
            return frames.at(0).stats.shade.rays.specular;
        };
        const auto one = rays_of(1), six = rays_of(6);
        EXPECT_GT(one, 0u) << surface;
        EXPECT_LE(six, 7 * one) << surface;
    }
}

}  // namespace
}  // namespace trapeze::testing
