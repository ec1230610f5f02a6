/// Distances, transmission and colours of rays that shaders trace, next to closed forms.
#include <gtest/gtest.h>

#include "tests/rays/rays_harness.h"

namespace trapeze::testing {
namespace {

/// A plane's micropolygons are flat, so what remains is float: coordinates to 5 and distances to 4 in some
/// ten operations of 2^-24 each, over the cosine of the ray to the plane.
TEST(RayDistance, OfAPlaneIsExact) {
    Case c;
    c.things = "Polygon \"P\" [-9 -9 2 9 -9 3.8 9 9 3.8 -9 9 2] ";  // z = 2.9 + x / 10
    const std::string formula =
        "float expected = (zcomp(P) - 2.9 - xcomp(P) / 10) / (xcomp(d) / 10 - zcomp(d));";
    for (const char* way : {"0, 0, -1", "0, 0, -7", ".3, .2, -1", "-.8, .3, -.5", ".1, 1, -.3"}) {
        const std::string body = "vector w = vector(" + std::string(way) + "); vector d = normalize(w); " +
                                 formula + "float found = trace(P, w); Ci = told(found, expected, 1);";
        expect_told(c.render(body), 2e-5f, 64 * 64);
    }
}

/// A sphere's micropolygons have sides of a pixel, h = 1/32: their middles lie within (h sqrt 2)^2 / 8 R of
/// it, 4.9e-4 for R = 1/2, along the normal. Rays that meet it under a cosine of at least 0.3 are told.
TEST(RayDistance, OfASphereIsThatOfItsMicropolygons) {
    Case c;
    c.things = sphere("0 0 3", ".5");
    expect_told(c.render("float r2 = xcomp(P) * xcomp(P) + ycomp(P) * ycomp(P);"
                         "float deep = sqrt(max(.25 - r2, 0)), found = trace(P, vector(0, 0, -1));"
                         "if (r2 < .25 * .91) Ci = told(found, 2 - deep, 1);"
                         "else if (r2 > .2501) Ci = told(found, 1e30, 1); else Ci = 0;"),
                1.7e-3f, 3900);
}

TEST(RayDistance, IsThatOfTheNearestOfMany) {
    Case c;
    c.things = wall("1") + wall("4.5") + wall("3") + wall("4") + wall("7") + sphere("0 0 2.5", ".1");
    expect_told(c.render("Ci = told(float trace(P, vector(0, 0, -1)), .5, 1);"), 1e-5f, 64 * 64);
    expect_told(c.render("Ci = told(float trace(P, vector(0, 0, 1)), 2, 1);"), 1e-5f, 64 * 64);
}

TEST(RayDistance, OfNothingIsEndless) {
    Case c;
    c.things = wall("3");
    expect_told(c.render("Ci = told(float trace(P, vector(0, 0, 1)), 1e30, 1);"), 0, 64 * 64);
    expect_told(c.render("color k = trace(P, vector(0, 0, 1)); Ci = told(comp(k, 0), 0, 1);"), 0, 64 * 64);
}

/// Rays of no use are misses, and nothing is ever NaN.
TEST(RayDistance, WaysThatLeadNowhereMiss) {
    Case c;
    c.things = wall("3") + wall("7");
    const std::string odd =
        "float huge = 1e30 * (2 + s); float endless = huge * huge, nan = endless - endless;";
    for (const char* way : {"vector(0, 0, 0)", "vector(nan, 0, -1)", "vector(0, 0, endless)",
                            "vector(endless, nan, -endless)"}) {
        const std::string asks = odd + "vector w = " + way + ";";
        expect_told(c.render(asks + "Ci = told(float trace(P, w), 1e30, 1);"), 0, 64 * 64);
        expect_told(c.render(asks + "Ci = told(comp(color trace(P, w), 0), 0, 1);"), 0, 64 * 64);
        expect_told(c.render(asks + "Ci = told(occlusion(P, w, 4), 0, 1);"), 0, 64 * 64);
        expect_told(c.render(asks + "Ci = told(comp(indirectdiffuse(P, w, 4), 1), 0, 1);"), 0, 64 * 64);
    }
    for (const char* place : {"point(nan, 0, 5)", "point(endless, 0, 5)", "point(0, -endless, nan)"}) {
        const std::string asks = odd + "point o = " + place + ";";
        expect_told(c.render(asks + "Ci = told(float trace(o, vector(0, 0, 1)), 1e30, 1);"), 0, 64 * 64);
        expect_told(c.render(asks + "Ci = told(comp(transmission(o, P), 0), 1, 1);"), 0, 64 * 64);
        expect_told(c.render(asks + "Ci = told(comp(transmission(P, o), 0), 1, 1);"), 0, 64 * 64);
        expect_told(c.render(asks + "Ci = told(occlusion(o, N, 4), 0, 1);"), 0, 64 * 64);
    }
    expect_told(c.render("Ci = told(comp(transmission(P, P), 0), 1, 1);"), 0, 64 * 64);
    expect_told(c.render("point o = P * 1e30; Ci = told(comp(transmission(o, o), 0), 1, 1);"), 0, 64 * 64);
    // Very long ways are ways.
    expect_told(c.render("Ci = told(float trace(P, vector(0, 0, -1e30)), 2, 1);"), 1e-5f, 64 * 64);
    expect_told(c.render("Ci = told(float trace(P, vector(0, 0, -1e-30)), 2, 1);"), 1e-5f, 64 * 64);
}

// Shadows.

/// Lights and spheres in front of a floor. Points whose way to the light passes the sphere's rim within a
/// hundredth are left out: its micropolygons lie up to 1.2e-3 inside of it.
TEST(RayTransmission, ShadowsAreHardAndWhereTheyShould) {
    Case c;
    c.things =
        sphere("0 0 3", ".3") + sphere(".6 -.2 4.5", ".1") + sphere("0 0 -3", "2") + sphere("0 0 9", "1");
    c.functions =
        "float passes(point from, to, middle) { vector way = normalize(to - from);"
        "  vector m = middle - from; return length(m - (m . way) * way); }";
    const std::string formula =
        "point light = point(.3, .2, 0);"
        "float d1 = passes(P, light, point(0, 0, 3)), d2 = passes(P, light, point(.6, -.2, 4.5));"
        "float lit = (d1 > .3 && d2 > .1) ? 1 : 0;"
        "float sure = (abs(d1 - .3) > .01 && abs(d2 - .1) > .01) ? 1 : 0;";
    for (const char* call : {"transmission(P, light)", "transmission(light, P)", "visibility(P, light)",
                             "transmission(P, light, \"samples\", 3)"}) {
        const Image image = c.render(formula + "color t = " + call + "; Ci = told(comp(t, 1), lit, sure);");
        expect_told(image, 0);
        EXPECT_NEAR(mean_found(image), 0.84, 0.1) << "some is dark: " << call;
    }
}

/// What lies behind an end counts no more than the ends themselves do.
TEST(RayTransmission, EndsAtItsEnds) {
    Case c;
    c.things = wall("3") + wall("5");
    for (const auto& [to, open] : {std::pair("3.1", "1"), {"3", "1"}, {"2.9", "0"}, {"5", "1"}, {"9", "1"}})
        expect_told(c.render("point to = P; setzcomp(to, " + std::string(to) +
                             "); Ci = told(comp(transmission(P, to), 2), " + open + ", 1);"),
                    0, 64 * 64);
}

/// Grids hold primitives' own opacities as half floats: this is how much a part of 1 differs from what was
/// given.
constexpr float kHalf = 0x1p-12f;

TEST(RayTransmission, OfSheetsIsTheProduct) {
    Case c;
    c.things = "Opacity .5 .25 .75 " + wall("3") + "Opacity .2 .4 .6 " + wall("4");
    const std::string asks = "color t = transmission(P, point(0, 0, 0)); Ci = told(comp(t, ";
    expect_told(c.render(asks + "0), .5 * .8, 1);"), 2 * kHalf, 64 * 64);
    expect_told(c.render(asks + "1), .75 * .6, 1);"), 2 * kHalf, 64 * 64);
    expect_told(c.render(asks + "2), .25 * .4, 1);"), 2 * kHalf, 64 * 64);
    c.things += "Opacity 1 1 1 " + wall("1");
    expect_told(c.render(asks + "0), 0, 1);"), 0, 64 * 64);
}

/// As many sheets as one looks through, one close behind the other.
TEST(RayTransmission, CountsEachSheetOnce) {
    Case c;
    for (int i = 0; i < 20; ++i) c.things += "Opacity .125 .125 .125 " + wall(std::to_string(3 + 0.01 * i));
    expect_told(c.render("Ci = told(comp(transmission(P, point(0, 0, 0)), 0), pow(.875, 20), 1);"), 1e-6f,
                64 * 64);
    // A sphere has a near side and a far one.
    c.things = "Opacity .25 .25 .25 " + sphere("0 0 3", "1.9");
    expect_told(c.render("point to = P - vector(0, 0, 5);"
                         "Ci = told(comp(transmission(P, to), 0), .5625, 1);"),
                1e-6f, 64 * 64);
}

/// A ray ends where next to no light is left, not behind so many surfaces.
TEST(RayTransmission, GoesThroughAsManySheetsAsLightDoes) {
    const auto pile = [](const std::string& opacity) {
        std::string sheets = "ShadingRate 25 Opacity " + opacity + ' ' + opacity + ' ' + opacity + ' ';
        for (int i = 0; i < 100; ++i) {
            const std::string z = ' ' + std::to_string(2 + 0.02 * i) + ' ';
            sheets += "Patch \"bilinear\" \"P\" [-1.3 1.3" + z + "1.3 1.3" + z + "-1.3 -1.3" + z +
                      "1.3 -1.3" + z + "] ";
        }
        return sheets;
    };
    const std::string open = "comp(transmission(P, point(0, 0, 0)), 0)",
                      seen = "comp(color trace(P, vector(0, 0, -1), \"hitmode\", \"primitive\"), 0)";
    Case c;
    c.things = pile(".01");
    // In half floats .01 is off by up to 2^-18, a hundred times.
    constexpr float kTolerance = 100 * 0x1p-18f;
    expect_told(c.render("Ci = told(" + open + ", pow(.99, 100), 1);"), kTolerance, 64 * 64);
    expect_told(c.render("Ci = told(" + seen + ", 1 - pow(.99, 100), 1);"), kTolerance, 64 * 64);
    c.things = pile(".5");
    expect_told(c.render("Ci = told(" + open + ", 0, 1);"), 0, 64 * 64);
    expect_told(c.render("Ci = told(" + seen + ", 1, 1);"), 1.01f / 512, 64 * 64);
}

TEST(RayTransmission, ShadersMakeOpacityUnlessTheyAreNotAsked) {
    Case c;
    c.shaders["window"] = "surface window() { Oi = Os * (xcomp(P) > 0 ? .25 : .75); Ci = 1; }";
    const std::string sheet = "Surface \"window\" Opacity .8 .8 .8 " + wall("3");
    const std::string asks =
        "point to = P - vector(0, 0, 4); color t = transmission(P, to);"
        "float sure = abs(xcomp(P)) > 1e-4 ? 1 : 0;";
    c.things = sheet;
    expect_told(c.render(asks + "Ci = told(comp(t, 0), xcomp(P) > 0 ? .8 : .4, sure);"), 1e-6f);
    c.things = "Attribute \"shade\" \"string transmissionhitmode\" \"primitive\" " + sheet;
    expect_told(c.render(asks + "Ci = told(comp(t, 0), .2, sure);"), kHalf);
    // An opaque primitive that its shader opens.
    c.things = "Surface \"window\" " + wall("3");
    expect_told(c.render(asks + "Ci = told(comp(t, 0), xcomp(P) > 0 ? .75 : .25, sure);"), 1e-6f);
}

/// Opacity at the hit itself, not at some vertex near it. At borders of grids a vertex is where that of the
/// neighbour is, so that the place in the surface's parameters is known to half a micropolygon's side, 1/64,
/// there.
TEST(RayTransmission, ShadersAreAskedAtTheHit) {
    Case c;
    c.shaders["ramp"] = "surface ramp() { Oi = .5 + .4 * sin(7 * xcomp(P)) * cos(5 * ycomp(P)); Ci = 0; }";
    c.things = "Surface \"ramp\" " + wall("3");
    expect_told(c.render("float open = .5 - .4 * sin(7 * xcomp(P)) * cos(5 * ycomp(P));"
                         "color t = transmission(P, P - vector(0, 0, 4)); Ci = told(comp(t, 0), open, 1);"),
                3e-5f, 64 * 64, 2.8f / 64);
}

// Reflections.

/// A mirror shows a plane of checks and a red sphere before it. Ways within 0.005 of an edge of a check or
/// 0.01 of the sphere's rim are left out.
TEST(RayTrace, MirrorsShowWhatStandsThere) {
    Case c;
    c.shaders["checks"] =
        "surface checks() { Oi = 1;"
        "Ci = mod(floor(4 * xcomp(P)) + floor(4 * ycomp(P)), 2); }";
    c.things =
        "Surface \"checks\" " + wall("2") + "Surface \"constant\" Color .25 0 0 " + sphere("0 0 3.5", ".4");
    for (const char* way : {"vector(0, 0, -1)", "vector(.2, .1, -1)", "2 * vector(-.4, .3, -1)"}) {
        const std::string body =
            "vector w = " + std::string(way) +
            "; vector m = point(0, 0, 3.5) - P; vector d = normalize(w);"
            "float passes = length(m - (m . d) * d); point there = P - w * (3 / zcomp(w));"
            "float x = 4 * xcomp(there), y = 4 * ycomp(there);"
            "float check = mod(floor(x) + floor(y), 2);"
            "float sure = min(abs(x - round(x)), abs(y - round(y))) > .0626 && abs(passes - .4) > .01 ? 1 : 0;"
            "color seen = trace(P, w);"
            "Ci = told(comp(seen, 0), passes < .4 ? .25 : check, sure);";
        const Image image = c.render(body);
        expect_told(image, 1e-6f, 2500);
        EXPECT_GT(mean_found(image), 0.2);
    }
}

/// What a shader finds at a hit: its place, its parameters, from where it is seen, and after how many
/// bounces.
/// Flat mirrors and bent ones that stand on a floor, at z = 5 (below it is black), up to the vertices on it.
TEST(RayTrace, MirrorsSeeTheFloorThatTheyStandOn) {
    const std::string flat = "vector w = normalize(vector(.1 * u, -.2, 1));";
    const auto bent = [](const std::string& down) {
        return "normal n = normalize(N); if (zcomp(n) > 0) n = -n;"
               "vector w = normalize(2 * vector(n) + vector(0, 0, " +
               down + " - 2 * zcomp(n)));";
    };
    for (const auto& [mirror, way] :
         {std::pair("Patch \"bilinear\" \"P\" [-1.2 -.9 5 1.2 -.9 5 -1.2 .9 2 1.2 .9 2] ", flat),
          {"Polygon \"P\" [-.9 -.9 5 .9 -.9 5 .9 .9 2 -.9 .9 2] ", flat},
          {"Translate 0 0 5 Scale 1 1 -1 Cone 3 .9 360 ", bent("1.2")},
          {"Translate 0 0 5 Scale 1 1 -1 Cone 1.5 .9 360 ", bent(".6")}}) {
        SCOPED_TRACE(mirror);
        Case c;
        c.things = "Surface \"constant\" Color 1 1 1 " + wall("5") + " Color 0 0 0 " + wall("9");
        c.asks = mirror;
        const std::string far = way + "float far = (5 - zcomp(P)) / zcomp(w);";
        expect_told(c.render(way + "Ci = told(comp(color trace(P, w), 0), 1, 1);"), 0, 1000);
        expect_told(c.render(way + "color k = 0; gather(\"\", P, w, 0, 1, \"surface:Ci\", k) { }"
                                   "Ci = told(comp(k, 0), 1, 1);"),
                    0, 1000);
        // Told from P, but for a quarter of a micropolygon where the mirror is bent.
        expect_told(
            c.render(far + "float f = -1; point o = 0; color k = 0; gather(\"\", P, w, 0, 1, \"ray:length\", "
                           "f, \"ray:origin\", o, \"surface:Ci\", k) { }"
                           "Ci = told(f + length(o - P), far, 1);"),
            way == flat ? 1e-3f : 0.03f, 1000);
    }
}

/// From all vertices of a room's walls, edges and corners among them, into all directions that are not nearly
/// along the own wall: nothing leaves the room.
TEST(RayTrace, NothingLeavesARoomFromItsEdges) {
    const std::string corners = "\"P\" [-2 -2 -1 2 -2 -1 -2 2 -1 2 2 -1 -2 -2 4 2 -2 4 -2 2 4 2 2 4] ";
    const std::string room =
        "PointsPolygons [4 4 4 4 4 4] [0 1 3 2 4 5 7 6 0 1 5 4 2 3 7 6 0 2 6 4 1 3 7 5] " + corners;
    const std::string apart =
        "Polygon \"P\" [-2 -2 4 2 -2 4 2 2 4 -2 2 4] Polygon \"P\" [-2 -2 -1 2 -2 -1 2 2 -1 -2 2 -1] "
        "Polygon \"P\" [-2 -2 -1 2 -2 -1 2 -2 4 -2 -2 4] Polygon \"P\" [-2 2 -1 2 2 -1 2 2 4 -2 2 4] "
        "Polygon \"P\" [-2 -2 -1 -2 2 -1 -2 2 4 -2 -2 4] Polygon \"P\" [2 -2 -1 2 2 -1 2 2 4 2 -2 4] ";
    for (const std::string& walls : {room, apart}) {
        SCOPED_TRACE(walls);
        Case c;
        c.options = "Projection \"perspective\" \"fov\" 90 ";
        c.things = "Surface \"constant\" " + walls, c.asks = walls;
        expect_told(
            c.render("normal n = faceforward(normalize(N), I); float lost = 0, i;"
                     "for (i = 0; i < 64; i += 1) {"
                     "  vector w = vector cellnoise(99 * P + vector(i * 17, 0, 0)) - vector(.5, .5, .5);"
                     "  if (w . n < 0) w = -w;"
                     "  if (w . n > .2 * length(w)) lost += 1 - comp(color trace(P, w), 0); }"
                     "Ci = told(lost, 0, 1);"),
            0, 64 * 64);
    }
}

TEST(RayTrace, HitsHaveTheirOwnPlaceAndParameters) {
    Case c;
    c.things = "Surface \"tells\" Patch \"bilinear\" \"P\" [-2 2 2 2 2 3 -2 -2 2 2 -2 3] ";
    const auto expect = [&](const std::string& tells, const std::string& expected, float tolerance,
                            float at_most = 0) {
        c.shaders["tells"] = "surface tells() { Oi = 1; " + tells + " }";
        SCOPED_TRACE(tells);
        expect_told(
            c.render("vector w = vector(.1, -.2, -1); color seen = trace(P, w); vector d = normalize(w);"
                     "float l = (zcomp(P) - 2.5 - xcomp(P) / 4) / (xcomp(d) / 4 - zcomp(d));"
                     "point there = P + l * d;"
                     "Ci = told(comp(seen, 0), " +
                     expected + ", 1);"),
            tolerance, 64 * 64, at_most);
    };
    // Along a border of grids places are known to half a micropolygon's side; see above.
    constexpr float kHalfSide = 1.0f / 64;
    expect("Ci = xcomp(P);", "xcomp(there)", 1e-5f, kHalfSide);
    expect("Ci = zcomp(P);", "zcomp(there)", 1e-5f, kHalfSide / 4);
    expect("Ci = u;", "(xcomp(there) + 2) / 4", 1e-5f, kHalfSide / 4);
    expect("Ci = v;", "(2 - ycomp(there)) / 4", 1e-5f, kHalfSide / 4);
    expect("Ci = t;", "(2 - ycomp(there)) / 4", 1e-5f, kHalfSide / 4);
    expect("Ci = length(I);", "l", 1e-5f, kHalfSide / 2);
    expect("Ci = normalize(I) . normalize(vector(.1, -.2, -1));", "1", 1e-5f);
    expect("float d = -1; rayinfo(\"depth\", d); Ci = d;", "1", 0);
    expect("Ci = raylevel();", "1", 0);
    expect("Ci = zcomp(faceforward(normalize(N), I));", "1 / sqrt(1 + 1 / 16)", 1e-5f);
    expect("Ci = abs(zcomp(normalize(Ng)));", "1 / sqrt(1 + 1 / 16)", 1e-5f);
    // Derivatives are those of the ray's geometry.
    expect("Ci = abs(Du(xcomp(P)));", "4", 2e-3f);
    expect("Ci = abs(Dv(ycomp(P)));", "4", 2e-3f);
    // Blocks that not all vertices run, and rays in them.
    expect("Ci = 0; if (u > .5) Ci = 1;", "xcomp(there) > 0 ? 1 : 0", 0);
}

/// Light that passes what is half transparent adds to what that shines itself, from front to back.
TEST(RayTrace, LooksThroughWhatIsTransparent) {
    Case c;
    c.things = "Surface \"constant\" Color 1 .5 .25 Opacity .5 .5 .5 " + wall("4") +
               "Color .2 .4 .8 Opacity .75 .5 .25 " + wall("3") + "Color 1 1 1 Opacity 1 1 1 " + wall("2");
    const std::string asks = "color k = trace(P, vector(0, 0, -1)); Ci = told(comp(k, ";
    expect_told(c.render(asks + "0), .5 + .5 * (.15 + .25), 1);"), 1e-6f, 64 * 64);
    expect_told(c.render(asks + "1), .25 + .5 * (.2 + .5), 1);"), 1e-6f, 64 * 64);
    expect_told(c.render(asks + "2), .125 + .5 * (.2 + .75), 1);"), 1e-6f, 64 * 64);
}

/// Matte holds things out of the camera's view, and hides there what is behind them. Rays see them as others,
/// and so what is matte sees what it reflects.
TEST(RayTrace, MatteThingsAreAsOthers) {
    Case c;
    const std::string thing = "Surface \"constant\" Color .25 .5 1 " + wall("3");
    for (const char* matte : {"Matte 0 ", "Matte 1 ", "Matte 2 "}) {
        SCOPED_TRACE(matte);
        c.things = matte + thing;
        expect_told(c.render("color k = trace(P, vector(0, 0, -1)); Ci = told(comp(k, 1), .5, 1);"), 0,
                    64 * 64);
        expect_told(c.render("Ci = told(comp(transmission(P, point(0, 0, 0)), 0), 0, 1);"), 0, 64 * 64);
        expect_told(c.render("Ci = told(occlusion(P, vector(0, 0, -1), 4, \"coneangle\", .1), 1, 1);"), 0,
                    64 * 64);
    }
    c.things = thing, c.asker = "Matte 1 ";
    for (const Pixel& p : pixels(c.render("Ci = trace(P, vector(0, 0, -1));"))) {
        ASSERT_EQ(p.green, 0);
        ASSERT_EQ(p.alpha, 0);
    }
}

/// A call whose type nothing says is of a colour: so the older shaders were written.
TEST(RayTrace, IsAColourUnlessItMustNot) {
    Case c;
    c.things = "Surface \"constant\" Color .25 .5 1 " + wall("3");
    const Image image = c.render("float Kr = .5; vector w = vector(0, 0, -1); Ci = .125 + Kr * trace(P, w);");
    for (const Pixel& p : pixels(image)) {
        ASSERT_EQ(p.red, 0.25f);
        ASSERT_EQ(p.green, 0.375f);
        ASSERT_EQ(p.blue, 0.625f);
    }
}

/// Two mirrors face each other; each shines with .25 and gives back half of what it gets.
TEST(RayTrace, DepthCutsTheSeriesOfTwoMirrors) {
    Case c;
    c.shaders["mirror"] =
        "surface mirror() { Oi = 1; vector way = reflect(normalize(I), normalize(N));"
        "Ci = .25 + .5 * color trace(P, way); }";
    const auto shine = [&](int depth, const std::string& options, int attribute) {
        c.options = options;
        const std::string bounces = attribute < 0 ? ""
                                                  : "Attribute \"trace\" \"int maxspeculardepth\" [" +
                                                        std::to_string(attribute) + "] ";
        c.things = bounces + "Surface \"mirror\" " + wall("2") + wall("5.5");
        c.asker = bounces;
        float expected = 0;
        for (int i = 0; i <= depth; ++i) expected += 0.25f * std::pow(0.5f, static_cast<float>(i));
        SCOPED_TRACE(options + bounces);
        expect_told(c.render("Ci = told(.25 + .5 * comp(color trace(P, vector(0, 0, -1)), 0), " +
                             std::to_string(expected) + ", 1);"),
                    1e-6f, 64 * 64);
    };
    for (int depth = 0; depth <= 5; ++depth) shine(depth, "", depth);
    shine(2, "", -1);
    for (int depth = 0; depth <= 3; ++depth)
        shine(depth, "Option \"trace\" \"int maxdepth\" [" + std::to_string(depth) + "] ", 8);
    shine(10, "", 100);
}

/// Comparisons by size are of floats: they ask for the distance.
TEST(RayTrace, IsADistanceWhereItIsCompared) {
    Case c;
    expect_told(c.render("Ci = told(trace(P, vector(0, 0, -1)) > 1e20 ? 1 : 0, 1, 1);"), 0, 64 * 64);
    c.things = "Color 0 0 0 " + wall("3");
    expect_told(c.render("Ci = told(2.5 < trace(P, vector(0, 0, -1)) ? 1 : 0, 0, 1);"), 0, 64 * 64);
    expect_told(c.render("Ci = told(trace(P, vector(0, 0, -1)) > 1.5 ? 1 : 0, 1, 1);"), 0, 64 * 64);
}

/// A hundred bounces, each of which runs a shader that waits for the next.
TEST(RayTrace, FollowsAsManyBouncesAsMayBeAskedFor) {
    Case c;
    c.shaders["counts"] =
        "surface counts() { Oi = 1; vector way = reflect(normalize(I), normalize(N));"
        "Ci = 1 + color trace(P, way); }";
    c.options = "Option \"trace\" \"int maxdepth\" [100] ";
    c.asker = "Attribute \"trace\" \"int maxspeculardepth\" [100] ";
    c.things = c.asker + "Surface \"counts\" " + wall("2") + wall("5.5");
    expect_told(c.render("Ci = told(1 + comp(color trace(P, vector(0, 0, -1)), 0), 101, 1);"), 0, 64 * 64);
}

/// What is too deep is black, but still in the way: the colour of rays is, their opacity and distance are
/// not.
TEST(RayTrace, DepthDoesNotEndDistancesAndShadows) {
    Case c;
    c.options = "Option \"trace\" \"int maxdepth\" [0] ";
    c.things = "Opacity .5 .5 .5 " + wall("3");
    expect_told(c.render("Ci = told(float trace(P, vector(0, 0, -1)), 2, 1);"), 1e-5f, 64 * 64);
    expect_told(c.render("Ci = told(comp(transmission(P, point(0, 0, 0)), 0), .5, 1);"), 1e-6f, 64 * 64);
    expect_told(c.render("Ci = told(occlusion(P, vector(0, 0, -1), 4, \"coneangle\", .1), .5, 1);"), 1e-6f,
                64 * 64);
    expect_told(c.render("Ci = told(comp(color trace(P, vector(0, 0, -1)), 0), 0, 1);"), 0, 64 * 64);
}

// Occlusion.

}  // namespace
}  // namespace trapeze::testing
