/// What gather blocks send along with their rays: "send:surface:NAME" and its like.
#include <gtest/gtest.h>

#include "tests/rays/rays_harness.h"

namespace trapeze::testing {
namespace {

/// Rays of no angle towards smaller z, one for each vertex; what they tell goes to k.
std::string gather(const std::string& given, const std::string& output = "surface:Ci") {
    return "gather(\"illuminance\", P, vector(0, 0, -1), 0, 1, \"" + output + "\", k, " + given + ") { } ";
}
/// The first component of what was told; it is there everywhere.
std::string told(const std::string& value) {
    return "Ci = told(comp(k, 0), " + value + ", 1);";
}

/// Another value for each of some strips, so that hits of one run differ.
const std::string kStrip = "float strip = floor(4 * xcomp(P)); ";

Case level_case() {
    Case c;
    c.shaders["told"] =
        "surface told(float level = 1; varying float tint = 2;) { Oi = 1; Ci = level + 10 * tint; }";
    c.things = "Surface \"told\" \"level\" 3 " + wall("3");
    return c;
}

void expect_value(Case& c, const std::string& body, const std::string& value) {
    SCOPED_TRACE(body);
    expect_told(c.render(kStrip + "color k = -1; " + body + told(value)), 1e-5f, 64 * 64);
}

TEST(SentToHits, ValuesStandInPlaceOfParameters) {
    Case c = level_case();
    expect_value(c, gather("\"send:surface:none\", 7"), "23");
    expect_value(c, gather("\"send:surface:level\", 7"), "27");
    expect_value(c, gather("\"send:surface:level\", strip"), "strip + 20");
    expect_value(c, gather("\"send:surface:tint\", strip"), "3 + 10 * strip");
    expect_value(c, gather("\"send:surface:tint\", strip + 1, \"send:surface:level\", -strip"),
                 "9 * strip + 10");
    expect_value(c, gather("\"send:surface:level\", strip, \"send:surface:level\", 5"), "25");
    expect_value(c,
                 "string n = shadername() == \"ask\" ? \"level\" : \"\"; " +
                     gather("concat(\"send:surface:\", n), strip"),
                 "strip + 20");
    expect_value(c,
                 "if (strip > 0) { " + gather("\"send:surface:level\", strip") + "} else { " +
                     gather("\"send:surface:tint\", strip") + "}",
                 "strip > 0 ? strip + 20 : 3 + 10 * strip");
    expect_value(c,
                 "float got = -1; gather(\"\", P, vector(0, 0, -1), 0, 1, \"surface:level\", got,"
                 " \"send:surface:level\", strip) { } k = got; ",
                 "strip");
}

/// Other rays know nothing of them, whatever grids of hits were made before.
TEST(SentToHits, ValuesAreThoseOfOneBlock) {
    Case c = level_case();
    expect_value(c, gather("\"send:surface:level\", strip") + "k += 100 * trace(P, vector(0, 0, -1));",
                 "strip + 2320");
    expect_value(c,
                 gather("\"send:surface:level\", 1000") +
                     "gather(\"illuminance\", P, vector(0, 0, -1), 0, 1, \"surface:Ci\", k) { }",
                 "23");
    // Those of its beginning, for more rays than are traced at once.
    expect_value(c,
                 "float level = strip, i = 0; color sum = 0;"
                 "gather(\"illuminance\", P, vector(0, 0, -1), 0, 100, \"surface:Ci\", k,"
                 " \"send:surface:level\", level) { level += 1; sum += k; i += 1; } k = sum / i;",
                 "strip + 20");
}

TEST(SentToHits, ValuesAreOfAnyType) {
    const auto expect = [](const std::string& parameter, const std::string& made, const std::string& sent,
                           const std::string& value) {
        SCOPED_TRACE(parameter);
        Case c = level_case();
        c.shaders["told"] = "surface told(" + parameter + ";) { Oi = 1; Ci = " + made + "; }";
        c.things = "Surface \"told\" " + wall("3");
        expect_value(
            c,
            "float m[3] = {strip, 2, 3};"
            "string names[2] = {\"a\", \"b\"}; color tones[2] = {0, 1}; tones[1] = color(strip, 1, 2); " +
                gather("\"send:surface:x\", " + sent),
            value);
    };
    const std::string weighed = "comp(x, 0) + 10 * comp(x, 1) + 100 * comp(x, 2)",
                      triple = "xcomp(x) + 10 * ycomp(x) + 100 * zcomp(x)", tripled = "strip + 320";
    expect("color x = 0", weighed, "color(strip, 2, 3)", tripled);
    expect("varying color x = 0", weighed, "color(strip, 2, 3)", tripled);
    expect("point x = 0", triple, "point(strip, 2, 3)", tripled);
    expect("vector x = 0", triple, "normal(strip, 2, 3)", tripled);
    expect("varying normal x = 0", triple, "vector(strip, 2, 3)", tripled);
    expect("matrix x = 0", "comp(x, 0, 0) + comp(x, 3, 2)", "matrix(1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,strip,1)",
           "1 + strip");
    expect("float x[3] = 0", "x[0] + 10 * x[1] + 100 * x[2]", "m", tripled);
    expect("varying float x[3] = 0", "x[0] + 10 * x[1] + 100 * x[2]", "m", tripled);
    expect("color x[2] = 0", "comp(x[1], 0) + comp(x[1], 2) + comp(x[0], 0)", "tones", "strip + 2");
    expect("float x[] = {}", "x[0] + 10 * x[1] + 100 * arraylength(x)", "m", "strip + 320");
    expect("string x = \"\"", "x == \"yes\" ? 5 : 1", "concat(\"y\", \"es\")", "5");
    expect("string x[2] = {\"\", \"\"}", "x[1] == \"b\" && x[0] == \"a\" ? 5 : 1", "names", "5");
    expect("varying float x = s + zcomp(P)", "x", "strip", "strip");
}

/// They count for more than a primitive's variables, which count where nothing suitable is sent.
TEST(SentToHits, ValuesReplacePrimitiveVariables) {
    Case c = level_case();
    c.things =
        "Surface \"told\" \"level\" 3 Patch \"bilinear\" \"P\" [-6 6 3 6 6 3 -6 -6 3 6 -6 3] "
        "\"uniform float level\" 4 \"varying float tint\" [5 5 5 5] ";
    expect_value(c, gather("\"send:displacement:level\", 7"), "54");
    expect_value(c, gather("\"send:surface:level\", strip"), "strip + 50");
    expect_value(c, gather("\"send:surface:tint\", strip"), "4 + 10 * strip");
}

/// All that a ray goes through gets them.
TEST(SentToHits, ValuesReachWhatIsSeenThroughTransparency) {
    Case c = level_case();
    c.shaders["veil"] = "surface veil(float level = 1; float own = 2;) { Oi = .5; Ci = Oi * (level + own); }";
    c.things += "Surface \"veil\" " + wall("4") + "Surface \"veil\" \"own\" 8 " + wall("3.5");
    expect_value(c, gather("\"send:surface:level\", strip"),
                 ".5 * (strip + 2) + .25 * (strip + 8) + .25 * (strip + 20)");
}

/// Each kind of shader gets its own alone.
TEST(SentToHits, ValuesAreForOneKindOfShaders) {
    Case c;
    for (const char* kind : {"surface", "displacement", "volume"})
        c.shaders[std::string("of_") + kind] =
            std::string(kind) + " of_" + kind +
            "(float level = 1; output varying float heard = 0;) { heard = level; " +
            (kind == std::string("displacement") ? "N = calculatenormal(P); " : "Ci = Ci + 0; Oi = 1; ") +
            "}";
    c.things =
        "Surface \"of_surface\" Displacement \"of_displacement\" Atmosphere \"of_volume\" " + wall("3");
    for (const std::string heard : {"surface", "displacement", "volume", "atmosphere"})
        for (const std::string sent : {"surface", "displacement", "volume", "atmosphere"}) {
            const bool same = heard == sent || (heard != "surface" && heard != "displacement" &&
                                                sent != "surface" && sent != "displacement");
            SCOPED_TRACE(heard);
            expect_value(c,
                         "float got = -1; gather(\"\", P, vector(0, 0, -1), 0, 1, \"" + heard +
                             ":heard\", got, \"send:" + sent + ":level\", strip) { } k = got; ",
                         same ? "strip" : "1");
        }
}

TEST(SentToHits, ValuesReachTheMediaOnTheWay) {
    Case c;
    c.shaders["haze"] = "volume haze(float k = 0;) { Ci += k; }";
    c.asker = "Exterior \"haze\" ";
    c.things = "Surface \"constant\" Color 1 1 1 " + wall("3");
    expect_value(c, gather("\"send:surface:k\", 7"), "1");
    expect_value(c, gather("\"send:volume:k\", strip"), "1 + strip");
}

TEST(SentToHits, DisplacementsTurnTheSurfacesThatAreSeen) {
    Case c;
    c.shaders["turn"] = "displacement turn(float level = 0;) { N = normal(level, 0, -1); }";
    c.things = "Surface \"constant\" Displacement \"turn\" " + wall("3");
    const std::string asked = "normal n = 0; gather(\"\", P, vector(0, 0, -1), 0, 1, \"surface:N\", n, ";
    expect_value(c, asked + "\"send:displacement:level\", strip) { } k = -xcomp(n) / zcomp(n);", "strip");
    expect_value(c, asked + "\"send:surface:level\", strip) { } k = -xcomp(n) / zcomp(n);", "0");
}

/// What shaders send for: to count how deep they are.
TEST(SentToHits, CountersGrowFromHitToHit) {
    Case c;
    c.shaders["counts"] =
        "surface counts(uniform float depth = 0;) { color k = 0; Oi = 1; Ci = depth; if (depth < 3) {"
        " gather(\"illuminance\", P, faceforward(normalize(N), I), 0, 1, \"surface:Ci\", k,"
        " \"send:surface:depth\", depth + 1) Ci = depth + 10 * k; } }";
    const std::string deep = "Attribute \"trace\" \"int maxspeculardepth\" 9 ";
    c.asker = deep;
    c.things = deep + "Surface \"counts\" " + wall("2") + wall("5.5");
    expect_value(c, gather("\"send:surface:depth\", 1"), "321");
    expect_value(c, gather("\"send:volume:depth\", 1"), "3210");
    expect_value(c, gather("\"send:surface:depth\", strip > 0 ? 2 : 3"), "strip > 0 ? 32 : 3");
}

TEST(SentToHits, PicturesAreTheSameForEveryOrderOfWork) {
    Case c = level_case();
    c.things = "Surface \"told\" " + sphere("-.4 .3 3", ".5") + "Opacity .5 .5 .5 " +
               sphere("1 -.5 2", ".8") + wall("0");
    const std::string body =
        "color k = 0, sum = 0; gather(\"illuminance\", P, vector(0, 0, -1), 1, 40, \"surface:Ci\", k,"
        " \"send:surface:level\", s, \"send:surface:tint\", t) sum += k; else sum += .1; Ci = sum / 40;";
    const Image first = c.render(body);
    EXPECT_GT(mean_red(first), 0.2);
    for (const int threads : {1, 4}) {
        c.threads = threads;
        EXPECT_EQ(c.render(body).rgba, first.rgba);
    }
    c.settings.regions_at_least = 4;
    EXPECT_EQ(c.render(body).rgba, first.rgba);
}

/// Once a shader and name, and the parameter keeps its own value.
TEST(SentToHits, ValuesOfOtherTypesAreReportedAndNotTaken) {
    for (const std::string& sent : {std::string("color(1)"), std::string("\"a\""), std::string("list")}) {
        Case c = level_case();
        c.may_say = "rsl-sent-type surface told level";
        expect_value(c, "float list[2] = 5; " + gather("\"send:surface:level\", " + sent), "23");
        ASSERT_EQ(c.said.size(), 1u) << sent;
        EXPECT_EQ(
            c.said[0].text,
            "surface shader \"told\" declares \"level\" as another type than what gather sends, and does "
            "not take it");
        EXPECT_NE(c.said[0].place.find("ask.sl:1:"), std::string::npos) << c.said[0].place;
    }
}

TEST(SentToHits, ArraysThatGrowAreReportedAndNotSent) {
    for (const std::string& name :
         {std::string("\"send:surface:level\""),
          std::string("concat(\"send:surface:\", shadername() == \"ask\" ? \"level\" : \"\")")}) {
        Case c = level_case();
        c.may_say = "rsl-send-type send:surface:level";
        expect_value(c, "float grown[]; push(grown, 7); " + gather(name + ", grown"), "23");
        ASSERT_EQ(c.said.size(), 1u) << name;
        EXPECT_EQ(c.said[0].text,
                  "\"send:surface:level\" of gather is ignored: arrays that grow are not sent");
    }
}

}  // namespace
}  // namespace trapeze::testing
