/// Gather blocks: what their rays tell, next to trace() along the same rays and to closed forms, and that
/// control flow in them is each vertex' own.
#include <gtest/gtest.h>

#include "tests/rays/rays_harness.h"

namespace trapeze::testing {
namespace {

/// Two spheres in front of a wall, one half transparent: rays hit all of it or leave past the wall.
std::string things() {
    return "Surface \"constant\" Color .2 .4 .8 " + sphere("-.4 .3 3", ".5") +
           "Opacity .5 .5 .5 Color 1 .5 .25 " + sphere("1 -.5 2", ".8") +
           "Opacity 1 1 1 Color .3 .6 .9 Patch \"bilinear\" \"P\" [-3 2 1 3 2 1 -3 -2 1 3 -2 1] ";
}

/// Each ray is traced again, along the direction that it is said to have, of which trace() makes the length 1
/// again: the numbers are the same but for their last bits.
TEST(Gather, RaysTellWhatTraceDoes) {
    for (const char* spread : {"\"uniform\"", "\"cosine\""}) {
        Case c;
        c.things = things();
        expect_told(
            c.render(
                "float wrong = 0, hits = 0, misses = 0; color seen = 0, open = 0; vector d = 0;"
                "point from = 0; float far = 0;"
                "gather(\"illuminance\", P, vector(0, 0, -1), PI / 2, 16, \"surface:Ci\", seen,"
                "  \"surface:Oi\", open, \"ray:direction\", d, \"ray:length\", far, \"ray:origin\", from,"
                "  \"distribution\", " +
                std::string(spread) +
                ") { hits += 1; color again = trace(P, d); float deep = trace(P, d);"
                "  color off = seen - again;"
                "  if (off . off > 1e-10 || abs(far - deep) > 2e-6 * far || from != P) wrong += 1;"
                "  if (deep > 1e20 || zcomp(d) > 0) wrong += 100;"
                "} else { misses += 1; if (float trace(P, d) < 1e20 || far < 1e20) wrong += 10000; }"
                "Ci = told(wrong, 0, hits > 1 && misses > 1 && hits + misses == 16 ? 1 : 0);"),
            0, 3500);
    }
}

/// Where it stands on its own: a ray of no angle is the direction itself.
TEST(Gather, OfNoAngleIsTheDirection) {
    Case c;
    c.things = things();
    expect_told(c.render("vector w = vector(.1, -.2, -1); color seen = 0; float n = 0;"
                         "gather(\"\", P, w, 0, 3, \"surface:Ci\", seen) { n += comp(seen, 1); }"
                         "color again = trace(P, w); Ci = told(n, 3 * comp(again, 1), 1);"),
                1e-6f, 64 * 64);
}

/// The form factor of a sphere above the horizon is (r / d)^2 cos(theta): the share of rays by the cosine
/// that hit it.
TEST(Gather, CountsTheFormFactorOfASphere) {
    Case c;
    c.things = sphere("0 0 3", ".5");
    for (const int samples : {16, 64}) {
        const Image image = c.render(
            "vector m = point(0, 0, 3) - P; float d2 = m . m, hits = 0;"
            "gather(\"illuminance\", P, normal(0, 0, -1), PI / 2, " +
            std::to_string(samples) +
            ", \"distribution\", \"cosine\") { hits += 1; }"
            "Ci = color(hits / " +
            std::to_string(samples) + ", .25 / d2 * (2 / sqrt(d2)), 1);");
        double square = 0, independent = 0, bias = 0;
        for (const Pixel& p : pixels(image)) {
            const double expected = static_cast<double>(p.green);
            const double error = static_cast<double>(p.red) - expected;
            independent += expected * (1 - expected) / samples / 4096;
            square += error * error / 4096, bias += error / 4096;
        }
        EXPECT_LE(square, independent * 1.05) << samples;
        // The sphere's micropolygons lie a little inside of it, as in the test of occlusion().
        EXPECT_NEAR(bias, 0, 4 * std::sqrt(independent / 4096) + 2e-4) << samples;
    }
}

/// All directions alike: a disk under the angle a fills (1 - cos a) / (1 - cos b) of the cone of b.
TEST(Gather, UniformRaysFillTheirCone) {
    Case c;
    c.things = "Surface \"constant\" Translate 0 0 3 Disk 0 .302270 360 ";  // 2 tan .15
    const Image image = c.render(
        "float hits = 0; gather(\"illuminance\", point(0, 0, 5) + 0 * P, vector(0, 0, -2), .3, 64) hits += 1;"
        "Ci = hits / 64;");
    EXPECT_NEAR(mean_red(image), (1 - std::cos(0.15)) / (1 - std::cos(0.3)), 2e-3);
}

// What is asked of hits.

struct Ask {
    const char *type, *name, *expected;
};

/// A slanted square with its own variables and shader: all that is asked is that of the place there.
TEST(Gather, AsksShadersPrimitivesAndAttributes) {
    Case c;
    c.shaders["tells"] =
        "surface tells(output varying float height = 0; output varying color tint = 0; float level = .5;) {"
        " height = 3 * xcomp(P); tint = color(u, v, 1); Oi = 1; Ci = .25; }";
    c.shaders["lift"] = "displacement lift(output varying float raised = 0;) { raised = 7 * u; }";
    c.things =
        "Attribute \"user\" \"float level\" [4] \"color tone\" [.1 .2 .3] Color .5 .25 1 "
        "Surface \"tells\" \"level\" 2 Displacement \"lift\" "
        "Patch \"bilinear\" \"P\" [-2 2 2 2 2 3 -2 -2 2 2 -2 3] \"vertex float heat\" [0 4 0 4] ";
    constexpr float kSide = 1.0f / 32;  // places along borders of grids are known to half a side
    for (const Ask& ask :
         {Ask{"float", "surface:height", "3 * xcomp(there)"},
          Ask{"color", "surface:tint", "color((xcomp(there) + 2) / 4, 0, 0)"},
          Ask{"float", "surface:level", "2"}, Ask{"float", "surface:u", "(xcomp(there) + 2) / 4"},
          Ask{"point", "surface:P", "there"}, Ask{"color", "surface:Cs", "color(.5, .25, 1)"},
          Ask{"float", "displacement:raised", "7 * (xcomp(there) + 2) / 4"},
          Ask{"point", "primitive:P", "there"}, Ask{"color", "primitive:Cs", "color(.5, .25, 1)"},
          Ask{"float", "primitive:heat", "xcomp(there) + 2"}, Ask{"float", "attribute:user:level", "4"},
          Ask{"color", "attribute:user:tone", "color(.1, .2, .3)"}, Ask{"float", "attribute:Sides", "2"}}) {
        SCOPED_TRACE(ask.name);
        const bool triple = ask.type != std::string("float");
        const std::string type(ask.type);
        expect_told(c.render("vector w = vector(.1, -.2, -1); vector d = normalize(w); " + type +
                             " found = -1, expected; point there;"
                             "there = P + d * ((zcomp(P) - 2.5 - xcomp(P) / 4) / (xcomp(d) / 4 - zcomp(d)));"
                             "expected = " +
                             ask.expected + "; gather(\"illuminance\", P, w, 0, 1, \"" +
                             std::string(ask.name) + "\", found) { } Ci = told(" +
                             (triple ? "comp(found, 0), comp(expected, 0)" : "found, expected") + ", 1);"),
                    2e-5f, 64 * 64, 4 * kSide);
    }
    // The normal, of which only the direction is told.
    expect_told(
        c.render("normal n = 0; gather(\"illuminance\", P, vector(0, 0, -1), 0, 1, \"surface:N\", n) ;"
                 "Ci = told(abs(zcomp(normalize(n))), 1 / sqrt(1 + 1 / 16), 1);"),
        1e-5f, 64 * 64);
}

/// What a hit does not have stays as it was, and so does all but the ray's own where it misses.
TEST(Gather, LeavesAloneWhatThereIsNot) {
    Case c;
    c.things = "Surface \"constant\" " + wall("3");
    const std::string gather = "gather(\"illuminance\", P, w, 0, 1, ";
    for (const char* name : {"surface:nothing", "primitive:nothing", "attribute:user:nothing",
                             "displacement:raised", "volume:fog"})
        expect_told(c.render("vector w = vector(0, 0, -1); float k = .5, n = 0;" + gather + "\"" + name +
                             "\", k) n = 1; Ci = told(k + n, 1.5, 1);"),
                    0, 64 * 64);
    expect_told(c.render("vector w = vector(0, 0, 1), d = 0; color k = .5; float n = 0;" + gather +
                         "\"surface:Ci\", k, \"ray:direction\", d) n = 5; else n = zcomp(d);"
                         "Ci = told(comp(k, 0) + n, 1.5, 1);"),
                0, 64 * 64);
}

/// Of what is seen through nothing they are the surface's.
TEST(Gather, ColorsOfVolumesAreThoseOfTheWholeRay) {
    Case c;
    c.things = things();
    expect_told(c.render("vector w = vector(.1, -.2, -1); color seen = 0, open = 0; float n = 0;"
                         "gather(\"illuminance\", P, w, 0, 1, \"volume:Ci\", seen, \"volume:Oi\", open)"
                         "  n = comp(seen, 0) + comp(open, 1);"
                         "color again = trace(P, w), left = 1 - transmission(P, P + 9 * w);"
                         "Ci = told(n, comp(again, 0) + comp(left, 1), 1);"),
                1e-6f, 64 * 64);
}

TEST(Gather, SetsElementsOfArrays) {
    Case c;
    c.things = "Surface \"constant\" Color .25 .5 1 " + wall("3");
    expect_told(c.render("color k[3] = {0, 0, 0}; float i = 1; vector d[2] = {0, 0};"
                         "gather(\"illuminance\", P, vector(0, 0, -1), 0, 1, \"surface:Ci\", k[i],"
                         " \"ray:direction\", d[1]) { }"
                         "Ci = told(comp(k[0] + 2 * k[1] + k[2], 0) - zcomp(d[1]) + zcomp(d[0]), 1.5, 1);"),
                0, 64 * 64);
}

/// Sheets of which each lets half through: a ray ends when it is as opaque as asked.
TEST(Gather, EndsAtItsOpacityThreshold) {
    Case c;
    c.things = "Surface \"constant\" Opacity .5 .5 .5 " + wall("4") + wall("3") + wall("2") + wall("1");
    for (const auto& [threshold, color] : {std::pair("color(0)", ".5"),
                                           {"color(.5)", ".5"},
                                           {"color(.6)", ".75"},
                                           {"color(.8)", ".875"},
                                           {"color(1)", ".9375"},
                                           {".7", ".75"}})
        expect_told(c.render("color k = 0, o = 0; gather(\"illuminance\", P, vector(0, 0, -1), 0, 1,"
                             " \"surface:Ci\", k, \"surface:Oi\", o, \"othreshold\", " +
                             std::string(threshold) + ") { } Ci = told(comp(k, 0) + comp(o, 1), 2 * " +
                             color + ", 1);"),
                    1e-6f, 64 * 64);
}

TEST(Gather, TakesMaxdistAndBias) {
    Case c;
    c.things = "Surface \"constant\" Color .5 .5 .5 " + wall("4") + "Color .25 .25 .25 " + wall("2");
    const auto expect = [&](const std::string& given, const std::string& value) {
        SCOPED_TRACE(given);
        expect_told(
            c.render("color k = 0; gather(\"illuminance\", P, vector(0, 0, -3), 0, 1, \"surface:Ci\", k" +
                     given + ") { } else { k = 1; } Ci = told(comp(k, 2), " + value + ", 1);"),
            1e-6f, 64 * 64);
    };
    expect("", ".5");
    expect(", \"maxdist\", .9", "1");
    expect(", \"maxdist\", 1.1", ".5");
    expect(", \"bias\", 1.1", ".25");
    expect(", \"bias\", 1.1, \"maxdist\", 2.9", "1");
    expect(", \"bias\", 3.1", "1");
}

/// Directions alone: nothing is hit, and every ray has one within the cone.
TEST(Gather, SamplePatternsTraceNothing) {
    Case c;
    c.things = wall("3");
    expect_told(
        c.render("vector d = 0, sum = 0; float hits = 0, misses = 0, wide = 0;"
                 "gather(\"samplepattern\", P, vector(0, 0, -2), .4, 16, \"ray:direction\", d) hits += 1;"
                 "else { misses += 1; sum += d; if (-zcomp(d) < cos(.4) - 1e-5) wide += 1; }"
                 "Ci = told(hits + 100 * wide + (misses - 16) +"
                 " (length(sum) > 15 && length(sum) < 15.9 ? 0 : 1000), 0, 1);"),
        0, 64 * 64);
}

// Control.

/// A checkered wall above: every other vertex' rays miss, whatever else goes on.
const std::string kComb =
    "vector w = vector(0, 0, -1); float hit = mod(floor(4 * xcomp(P) + 100), 2);"
    "float x = 4 * xcomp(P); float sure = abs(x - round(x)) > .13 ? 1 : 0;";

std::string comb() {
    std::string all = "Surface \"constant\" ";
    for (int i = -5; i < 5; i += 2)
        all += "Polygon \"P\" [" + std::to_string(i * 0.25) + " -2 3 " + std::to_string((i + 1) * 0.25) +
               " -2 3 " + std::to_string((i + 1) * 0.25) + " 2 3 " + std::to_string(i * 0.25) + " 2 3] ";
    return all;
}

TEST(Gather, ControlFlowIsEachVertexOwn) {
    Case c;
    c.things = comb();
    const auto expect = [&](const std::string& body, const std::string& of_hits,
                            const std::string& of_misses) {
        SCOPED_TRACE(body);
        expect_told(c.render(kComb + "float r = 0; uniform float i; " + body + " Ci = told(r, hit > 0 ? " +
                             of_hits + " : " + of_misses + ", sure);"),
                    0, 1500);
    };
    const std::string gather = "gather(\"illuminance\", P, w, 0, ";
    expect(gather + "5) r += 1; else r += 10;", "5", "50");
    expect(gather + "5) { r += 1; break; } else r += 10;", "1", "50");
    expect(gather + "5) r += 1; else { r += 10; break; }", "5", "10");
    expect(gather + "5) { r += 1; if (r < 3) continue; r += 100; } else { r += 10; if (r > 25) break; }",
           "305", "30");
    expect("for (i = 0; i < 4; i += 1) " + gather + "3) { r += 1; if (i >= 1) break 2; } else r += 10;", "4",
           "120");
    expect(
        "for (i = 0; i < 4; i += 1) { " + gather + "3) { r += 1; continue 2; } else { r += 10; } r += 100; }",
        "4", "520");
    expect(gather + "2) { " + gather + "3) r += 1; else r += 1000; " +
               "gather(\"illuminance\", P, -w, 0, 4) r += 1000; else r += 10; } else { " + gather +
               "3) r += 1000; else r += 100; }",
           "86", "600");
    // As many samples as each vertex wants, and none.
    expect(gather + "2 + 3 * hit) r += 1; else r += 10;", "5", "20");
    expect(gather + "0) r += 1; else r += 10;", "0", "0");
    expect(gather + "-3 + hit * 5) r += 1; else r += 10;", "2", "0");
    // What the block changes is asked for once.
    expect("point from = P; " + gather.substr(0, gather.find("P, w")) +
               "from, w, 0, 3) { r += 1; from = point(0, 0, -5); w = -w; } else { r += 10; from += w; }",
           "3", "30");
    // Only where it runs.
    expect("if (hit > 0) " + gather + "3) r += 1; else r += 1000;", "3", "0");
    expect("if (hit > 0) r = 7; else " + gather + "3) r += 1000; else r += 1;", "7", "3");
    c.functions =
        "float first(point o; vector w) { float n = 0; gather(\"illuminance\", o, w, 0, 4) {"
        " n += 1; if (n > 1) return n; } else return 10; return 100; } ";
    expect("r = first(P, w);", "2", "10");
}

/// Rays of hits are cut at the depth of their kind: what is too deep is black, but is hit.
TEST(Gather, DepthCutsItsSeries) {
    Case c;
    c.shaders["glows"] =
        "surface glows() { Oi = 1; color k = 0; vector w = faceforward(normalize(N), I);"
        "gather(\"illuminance\", P, w, 0, 1, \"surface:Ci\", k) { Ci = .25 + .5 * k; } else { Ci = 100; } }";
    for (int depth = 0; depth <= 4; ++depth) {
        c.asker = "Attribute \"trace\" \"int maxspeculardepth\" [" + std::to_string(depth) + "] ";
        c.things = c.asker + "Surface \"glows\" " + wall("2") + wall("5.5");
        float expected = 0;
        for (int i = 0; i < depth; ++i) expected = 0.25f + 0.5f * expected;
        expect_told(
            c.render("color k = -1; gather(\"illuminance\", P, vector(0, 0, -1), 0, 1, \"surface:Ci\", k)"
                     " { } Ci = told(comp(k, 0), " +
                     std::to_string(expected) + ", 1);"),
            1e-6f, 64 * 64);
    }
}

TEST(Gather, AbsurdInputDoesNoHarm) {
    Case c;
    c.things = "Surface \"constant\" " + wall("3");
    const std::string odd =
        "float nan = 1e30 * (2 + s); nan *= nan; nan -= nan; color k = 0; float hits = 0, misses = 0;";
    for (const char* way : {"vector(0, 0, 0)", "vector(nan, 0, -1)"})
        expect_told(c.render(odd + "gather(\"illuminance\", P, " + std::string(way) +
                             ", .5, 4, \"surface:Ci\", k) hits += 1; else misses += 1;"
                             "Ci = told(10 * hits + misses, 4, 1);"),
                    0, 64 * 64);
    for (const char* number : {"-1", "nan", "1e30", "-1e30"})
        for (const std::string& arguments :
             {std::string(number) + ", 4", ".5, 4, \"bias\", " + std::string(number),
              ".5, 4, \"othreshold\", " + std::string(number), ".5, 4, \"maxdist\", " + std::string(number)})
            expect_told(c.render(odd + "gather(\"illuminance\", P, vector(0, 0, -1), " + arguments +
                                 ", \"surface:Ci\", k) hits += 1; else misses += 1;"
                                 "Ci = told(hits + misses, 4, 1);"),
                        0, 64 * 64);
}

/// The same bits for any number of threads, regions and any method, with more rays than are traced at once.
TEST(Gather, IsTheSameForEveryOrderOfWork) {
    Case c;
    c.things = things() + "Attribute \"visibility\" \"int camera\" 1 " + sphere("0 -.6 3", ".3");
    const std::string body =
        "color k = 0, sum = 0; gather(\"illuminance\", P, vector(0, 0, -1), 1, 40, \"surface:Ci\", k)"
        " sum += k; else sum += .1; Ci = sum / 40;";
    const Image first = c.render(body);
    EXPECT_GT(mean_red(first), 0.2);
    c.threads = 1;
    EXPECT_EQ(c.render(body).rgba, first.rgba);
    c.threads = 7;
    c.settings.regions_at_least = 4;
    EXPECT_EQ(c.render(body).rgba, first.rgba);
    c.settings.sampler = "bruteforce";
    EXPECT_EQ(c.render(body).rgba, first.rgba);
}

/// A colour does not go into a float, and a name that is found only in a run is looked at then.
TEST(Gather, SaysWhatItDoesNotKnow) {
    for (const auto& [body, text] :
         {std::pair("gather(\"\", P, w, 0, 1, \"surface:Ci\", h) { }", "gather() knows no \"surface:Ci\""),
          {"string a = \"smap\"; if (n == 7) a = \"x\"; h = trace(P, w, concat(a, \"les\"), 3);",
           "trace() knows no \"smaples\""},
          {"string a = \"side\"; h = trace(P, w, \"hitsides\", concat(a, \"ways\"));", "not \"sideways\""}}) {
        const WorkFolder folder;
        std::vector<Diagnostic> said;
        folder.write(
            "ask.sl",
            std::string("surface ask(uniform float n = 3) { float h = 3; vector w = vector(0, 0, -1); ") +
                body + " Ci = h; Oi = 1; }");
        folder.write("a.rib", kPicture + "Option \"searchpath\" \"string shader\" [\"" +
                                  folder.path().string() + "\"] WorldBegin AttributeBegin " + kHidden +
                                  kSeen + wall("3") + "AttributeEnd Surface \"ask\" " + kAsker +
                                  " WorldEnd\n");
        Diagnostics diagnostics([&](const Diagnostic& d) { said.push_back(d); });
        render_worlds((folder / "a.rib").string(), RenderSettings(), 2, diagnostics);
        ASSERT_EQ(said.size(), 1u) << body;
        EXPECT_NE(said[0].text.find(text), std::string::npos) << said[0].text;
        EXPECT_NE(said[0].place.find("ask.sl:1:"), std::string::npos) << said[0].place;
    }
}

}  // namespace
}  // namespace trapeze::testing
