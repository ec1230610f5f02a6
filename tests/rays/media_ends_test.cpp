/// Interior and Exterior shaders along rays that come to their ends without having met anything: lamps in
/// smoke. Next to the law of Beer and Lambert.
#include <gtest/gtest.h>

#include "tests/rays/haze_harness.h"

namespace trapeze::testing {
namespace {

/// All around.
const std::string kSmokyRoom =
    "Surface \"constant\" AttributeBegin Interior \"haze\" \"k\" [.2] \"own\" [.5 .5 .5] " +
    sphere("0 0 5", "20") + "AttributeEnd ";
constexpr float kHalfFloat = 5e-4f;  ///< how finely pictures tell

TEST(RayMediaEnds, TheExteriorOfWhatAsksIsBeforeTheEnd) {
    Case c = hazy();
    c.asker = "Exterior \"haze\" \"k\" [.2] ";
    const std::string expected = "float way = 2 + xcomp(P); vector w = vector(0, 0, -way);";
    expect_near(c.render(expected + "Ci = color(comp(transmission(P, P + w), 0), exp(-.2 * way), 1);"),
                kHalfFloat);
    expect_near(c.render(expected + "Ci = color(comp(visibility(P + w, P), 0), exp(-.2 * way), 1);"),
                kHalfFloat);
    // On the other side it is the inside that counts.
    expect_near(c.render(expected + "Ci = color(comp(transmission(P, P - w), 0), 1, 1);"), 0);
    c.asker = "Interior \"haze\" \"k\" [.2] ";
    expect_near(c.render(expected + "Ci = color(comp(transmission(P, P - w), 0), exp(-.2 * way), 1);"),
                kHalfFloat);
}

TEST(RayMediaEnds, RaysEndWithinAThing) {
    Case c = hazy();
    c.things = "Interior \"haze\" \"k\" [.5] Surface \"constant\" Opacity 0 0 0 " + sphere("0 0 3", "1");
    const std::string way =
        "float r2 = xcomp(P) * xcomp(P) + ycomp(P) * ycomp(P);"
        "float way = r2 < 1 ? sqrt(1 - r2) : 0; float sure = abs(r2 - 1) < .08 ? 0 : 1;";
    expect_near(c.render(way + "Ci = color(comp(transmission(P, P - vector(0, 0, 2)), 0), exp(-.5 * way), "
                               "sure);"),
                kThinChord);
    // From within the thing to the outside: what is behind the end does not count.
    expect_near(c.render(way + "point m = P - vector(0, 0, 2); Ci = color(comp(transmission(m, m - vector(0, "
                               "0, 1.8)), 0), exp(-.5 * way), sure);"),
                kThinChord);
}

/// Expects what lamps send to the asker to be what arrives through smoke.
void expect_in_smoke(const std::string& lights, float tolerance) {
    SCOPED_TRACE(lights);
    Case c = hazy();
    c.shaders["lamp"] =
        "light lamp(point from = point \"shader\" (0, 0, 0)) {"
        "  illuminate(from) { Cl = (1 - shadow(\"raytrace\", Ps)) / (L . L); } }";
    c.shaders["strange"] =
        "light strange(point from = point \"shader\" (0, 0, 0)) {"
        "  illuminate(from) { Cl = transmission(from, Ps) / (L . L); } }";
    c.things = kSmokyRoom, c.asker = lights;
    expect_near(c.render("float found = 0, way = 0; normal ahead = normal(0, 0, -1);"
                         "illuminance(P, ahead, PI / 2) { way = length(L); found = comp(Cl, 0) * (L . L); }"
                         "Ci = color(found, exp(-.2 * way), 1);"),
                tolerance);
}

TEST(RayMediaEnds, LampsInARoomOfSmoke) {
    expect_in_smoke("LightSource \"lamp\" 1 \"point from\" [.3 .2 2] ", kHalfFloat);
    expect_in_smoke("LightSource \"strange\" 1 \"point from\" [.3 .2 2] ", kHalfFloat);
}

TEST(RayMediaEnds, AreaLightsInARoomOfSmoke) {
    Case c = hazy();
    c.things = kSmokyRoom;
    c.asker =
        "AttributeBegin Attribute \"visibility\" \"int camera\" 0 AreaLightSource \"arealight\" \"a\" "
        "Patch \"bilinear\" \"P\" [-.01 -.01 2 .01 -.01 2 -.01 .01 2 .01 .01 2] AttributeEnd "
        "Illuminate \"a\" 1 ";
    expect_near(c.render("float way2 = P . P - 25 + 9, cosine = 3 / sqrt(way2);"
                         "Ci = color(comp(diffuse(normal(0, 0, -1)), 0) * way2 / (cosine * cosine),"
                         "           exp(-.2 * sqrt(way2)), 1);"),
                1e-2f);
}

/// What stands behind the end is not the room, whether it has smoke of its own or none.
TEST(RayMediaEnds, WhatStandsBehindTheEnd) {
    Case c = hazy();
    const std::string way = "point q = P - vector(0, 0, 2 + xcomp(P)); float way = distance(P, q); ";
    for (const std::string& stands :
         {"Surface \"constant\" " + wall("1"),
          "Surface \"constant\" Opacity 0 0 0 Interior \"haze\" \"k\" [5] " + sphere("0 0 0", "1.5")}) {
        SCOPED_TRACE(stands);
        c.things = kSmokyRoom + stands;
        expect_near(c.render(way + "Ci = color(comp(transmission(P, q), 0), exp(-.2 * way), 1);"),
                    kHalfFloat);
        if (stands.find("Interior") == std::string::npos) continue;
        c.things = stands;
        expect_near(c.render(way + "Ci = color(comp(transmission(P, q), 0), 1, 1);"), 0);
    }
}

/// What has no smoke of its own stands in that of the room, and lets it through.
TEST(RayMediaEnds, WhatStandsInTheRoom) {
    Case c = hazy();
    c.asker = "Attribute \"trace\" \"int maxspeculardepth\" 9 ";
    const std::string way = "point q = P - vector(0, 0, 2 + xcomp(P)); float way = distance(P, q); ";
    c.things = kSmokyRoom + "Opacity 0 0 0 " + wall("4") + sphere("0 0 4", ".5");
    expect_near(c.render(way + "Ci = color(comp(transmission(P, q), 0), exp(-.2 * way), 1);"), kHalfFloat);
    c.things = kSmokyRoom + "Opacity 0 0 0 " + wall("4") + "Opacity 1 1 1 Color 1 1 1 " + wall("2");
    expect_near(c.render("float t = exp(-.2 * 3);"
                         "Ci = color(comp(trace(P, vector(0, 0, -1)), 0), .5 + .5 * t, 1);"),
                kHalfFloat);
}

/// Smoke that sends what it takes: what is seen of it, and what is left of what is behind, are all.
TEST(RayMediaEnds, WhatIsSeenAndWhatIsLeftAreAll) {
    Case c = hazy();
    c.asker = "Exterior \"haze\" \"k\" [.4] \"own\" [1 1 1] ";
    const std::string way = "float way = 2 + xcomp(P); vector w = vector(0, 0, -1);";
    expect_near(c.render(way + "Ci = color(comp(trace(P, w, \"maxdist\", way), 0), 1 - exp(-.4 * way), 1);"),
                kHalfFloat);
    expect_near(c.render(way + "color left = transmission(P, P + w * way), seen = trace(P, w, \"maxdist\", "
                               "way); Ci = color(comp(seen + left, 0), 1, 1);"),
                kHalfFloat);
    // Without an end nothing is known to be there.
    expect_near(c.render("Ci = color(comp(trace(P, vector(0, 0, -1)), 0), 0, 1);"), 0);
    expect_near(
        c.render("float missed = 0; gather(\"illuminance\", P, vector(0, 0, -1), 0, 1, \"maxdist\", 2) { }"
                 " else { missed = 1; } Ci = color(missed, 1, 1);"),
        0);
}

/// A ball that comes by the end: the ray ends before it, within it and behind it.
TEST(RayMediaEnds, AThingThatMoves) {
    Case c = hazy();
    c.options = "Shutter 0 1 ";
    c.asker = "Attribute \"trace\" \"int samplemotion\" 1 ";
    c.things =
        "Interior \"haze\" \"k\" [.5] Surface \"constant\" Opacity 0 0 0 MotionBegin [0 1] "
        "Translate 0 0 1.5 Translate 0 0 3.5 MotionEnd Sphere 1 -1 1 360 ";
    const Image image = c.render(
        "float r2 = xcomp(P) * xcomp(P) + ycomp(P) * ycomp(P); float half = r2 < 1 ? sqrt(1 - r2) : 0;"
        "float left = 0, i; for (i = .5; i < 64; i += 1)"
        "  left += exp(-.5 * clamp(1.5 + 2 * i / 64 + half - 2.5, 0, 2 * half)) / 64;"
        "Ci = color(comp(transmission(P, P - vector(0, 0, 2.5), \"samples\", 64), 0), left,"
        "           abs(r2 - 1) < .08 ? 0 : 1);");
    expect_near(image, 2e-2f);
    EXPECT_NEAR(mean_red(image), mean_found(image), 1e-3);
}

/// Smoke that lamps shine through, and are dimmed by on their way to it: its shader's own shadows.
TEST(RayMediaEnds, SmokeIsLitThroughSmoke) {
    Case c = hazy();
    c.shaders["lamp"] =
        "light lamp(point from = point \"shader\" (0, 0, 0)) {"
        "  illuminate(from) { Cl = 1 - shadow(\"raytrace\", Ps); } }";
    c.shaders["lit"] =
        "volume lit(float k = .2) { float i; color sum = 0; for (i = .5; i < 4; i += 1) {"
        "  point m = P - I + I * (i / 4);"
        "  illuminance(m) { sum += Cl * exp(-k * length(I) * i / 4); } }"
        "  float t = exp(-k * length(I)); Ci = sum + t * Ci; Oi = mix(color 1, Oi, t); }";
    const std::string lamp = "LightSource \"lamp\" 1 \"point from\" [.3 .2 2] ";
    const std::string marches =
        "float k = .2, i, sum = 0, way = WAY; for (i = .5; i < 4; i += 1) {"
        "  point m = P - vector(0, 0, way * i / 4);"
        "  sum += exp(-k * (way * i / 4 + distance(m, point \"camera\" (.3, .2, 2)))); }"
        "Ci = color(comp(trace(P, vector(0, 0, -1)), 0), sum, 1);";
    const auto over = [&](const std::string& way) {
        return std::string(marches).replace(marches.find("WAY"), 3, way);
    };
    // The lamps are those of what is hit.
    c.asker = "Exterior \"lit\" ";
    c.things = lamp + "Color 0 0 0 Surface \"constant\" " + wall("1");
    expect_near(c.render(over("4")), 2e-3f);
    c.asker.clear();
    c.things = lamp + "Interior \"lit\" Color 0 0 0 Surface \"constant\" " + sphere("0 0 5", "20");
    const std::string of_room = over("sqrt(400 - xcomp(P) * xcomp(P) - ycomp(P) * ycomp(P))");
    expect_near(c.render(of_room), 4e-3f);
    // A shader whose shadows take all of it does not ask at each step of each step.
    std::string& lit = c.shaders["lit"];
    lit.replace(lit.find("Oi, t)"), 6, "Oi, t + 1e-6 * comp(sum, 0))");
    expect_near(c.render(of_room), 4e-3f);
}

}  // namespace
}  // namespace trapeze::testing
