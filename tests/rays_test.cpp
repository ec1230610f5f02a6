/// Rays that shaders trace, from RIB to the picture, next to closed forms.
///
/// A square that fills the picture asks: its shader leaves what rays tell in red and what a formula, at the
/// same point, says in green. Shading is constant over a micropolygon, so that each pixel holds a vertex'
/// values; none is left out but those that the shader says are near a silhouette (blue is 0 there).
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>

#include "tests/program_harness.h"
#include "tests/scene_harness.h"

namespace trapeze::testing {
namespace {

const std::string kSeen =
    "Attribute \"visibility\" \"int diffuse\" 1 \"int specular\" 1 \"int transmission\" 1 ";
const std::string kHidden = "Attribute \"visibility\" \"int camera\" 0 ";
/// A picture of 64 x 64 pixels, each with a sample in its middle; the camera sees -1..1, from z = 0 upwards.
const std::string kPicture =
    "Display \"x\" \"exr\" \"rgba\" Format 64 64 1 PixelFilter \"box\" 1 1 PixelSamples 1 1 "
    "Hider \"hidden\" \"jitter\" 0 ShadingInterpolation \"constant\" Projection \"orthographic\" ";
/// The square that asks.
const std::string kAsker = "Patch \"bilinear\" \"P\" [-1.2 1.2 5 1.2 1.2 5 -1.2 -1.2 5 1.2 -1.2 5] ";

/// The difference, much enlarged; what was found; whether it counts.
const std::string kTold =
    "color told(float found, expected, sure) {"
    "  return color(found == expected ? 0 : 1024 * (found - expected), found, sure); } ";

/// A world's picture. Its shaders are given by their names; the text is what stands between.
struct Case {
    std::map<std::string, std::string> shaders;
    std::string functions;      ///< before the shader that asks
    std::string things;         ///< hidden from the camera
    std::string options;        ///< before the world
    std::string asker;          ///< attributes of the square that asks
    std::string asks = kAsker;  ///< what the camera sees
    RenderSettings settings;
    int threads = 2;

    std::vector<Diagnostic> said = {};

    Image render(const std::string& body) {
        const WorkFolder folder;
        shaders["ask"] = kTold + functions + "surface ask() { " + body + " Oi = 1; }";
        for (const auto& [name, text] : shaders) folder.write(name + ".sl", text);
        folder.write("a.rib", kPicture + "Option \"searchpath\" \"string shader\" [\"" +
                                  folder.path().string() + "\"] " + options + "\nWorldBegin AttributeBegin " +
                                  kHidden + kSeen + things + "\nAttributeEnd Surface \"ask\" " + asker +
                                  asks + "\nWorldEnd\n");
        const std::vector<std::string> files{(folder / "a.rib").string()};
        Diagnostics diagnostics([&](const Diagnostic& d) { said.push_back(d); });
        Image image;
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                        static_cast<size_t>(threads));
        tbb::task_arena arena(threads);
        arena.execute([&] {
            read_rib(files, ReadOptions{}, diagnostics, [&](Scene&& scene) {
                auto result = render_frame(make_context(scene, settings, diagnostics), settings);
                if (result) image = std::move(result->image);
            });
        });
        for (const Diagnostic& d : said)
            EXPECT_TRUE(d.kind == "nothing-for-rays") << to_string(d) << "\n" << shaders["ask"];
        EXPECT_EQ(image.rgba.size(), size_t{64 * 64 * 4});
        return image;
    }
};

/// A pixel's values.
struct Pixel {
    float red, green, blue, alpha;
};

std::vector<Pixel> pixels(const Image& image) {
    std::vector<Pixel> all;
    for (size_t i = 0; i + 3 < image.rgba.size(); i += 4)
        all.push_back({image.rgba[i], image.rgba[i + 1], image.rgba[i + 2], image.rgba[i + 3]});
    return all;
}

/// Found is what was expected, wherever blue is above 0 and the square is seen; at least so many pixels say
/// so.
/// A quarter of them may differ by more than `tolerance`, but not by more than `at_most`.
void expect_told(const Image& image, float tolerance, int at_least = 3500, float at_most = 0) {
    int told = 0, differ = 0;
    for (const Pixel& p : pixels(image)) {
        if (!(p.blue > 0) || p.alpha == 0) continue;
        ++told;
        differ += std::abs(p.red) / 1024 > tolerance;
        ASSERT_LE(std::abs(p.red) / 1024, std::max(tolerance, at_most))
            << "found " << p.green << " after " << told << " pixels";
    }
    EXPECT_GE(told, at_least);
    EXPECT_LE(differ, told / 4);
}

/// The mean of a pixel's number over all pixels that the square covers.
double mean(const Image& image, const std::function<double(const Pixel&)>& number) {
    double sum = 0, count = 0;
    for (const Pixel& p : pixels(image))
        if (p.alpha > 0) sum += number(p), ++count;
    EXPECT_GT(count, 0);
    return sum / count;
}

double mean_red(const Image& image) {
    return mean(image, [](const Pixel& p) { return static_cast<double>(p.red); });
}
double mean_found(const Image& image) {
    return mean(image, [](const Pixel& p) { return static_cast<double>(p.green); });
}

std::string sphere(const std::string& place, const std::string& radius) {
    return "AttributeBegin Translate " + place + " Sphere " + radius + " -" + radius + " " + radius +
           " 360 AttributeEnd ";
}

/// A square in a plane of equal z, from -6 to 6.
std::string wall(const std::string& z) {
    return "Patch \"bilinear\" \"P\" [-6 6 " + z + " 6 6 " + z + " -6 -6 " + z + " 6 -6 " + z + "] ";
}

// Distances.

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

/// The form factor of a sphere that is wholly above the horizon: (r / d)^2 cos(theta).
const std::string kUnderASphere =
    "vector m = point(0, 0, 3) - P; float d2 = m . m;"
    "float expected = .25 / d2 * (2 / sqrt(d2)); ";

/// Mean squared errors over 4096 points, each with random numbers of its own. A point's error is at most that
/// of N independent rays, p (1 - p) / N, for strata only help.
TEST(RayOcclusion, OfASphereIsItsFormFactor) {
    Case c;
    c.things = sphere("0 0 3", ".5");
    double before = 1;
    for (const int samples : {16, 64, 256}) {
        const Image image = c.render(kUnderASphere + "Ci = color(occlusion(P, normal(0, 0, -1), " +
                                     std::to_string(samples) + "), expected, 1);");
        const double n = samples;
        double independent = 0, square = 0, bias = 0;
        for (const Pixel& p : pixels(image)) {
            const double expected = static_cast<double>(p.green),
                         error = static_cast<double>(p.red) - expected;
            ASSERT_LT(std::abs(error), 5 * std::sqrt(expected * (1 - expected) / n)) << samples;
            independent += expected * (1 - expected) / n / 4096;
            square += error * error / 4096, bias += error / 4096;
        }
        EXPECT_LE(square, independent * 1.05) << samples;
        EXPECT_LE(square, before / 4 * 1.1) << "falls at least as 1 / N";
        // The sphere's micropolygons lie up to 1e-3 of its radius inside: the area falls by less than 2e-3.
        EXPECT_NEAR(bias, 0, 4 * std::sqrt(independent / 4096) + 2e-4) << samples;
        before = square;
    }
}

/// Points side by side, and calls in a loop, take random numbers of their own.
TEST(RayOcclusion, ErrorsOfPointsAndCallsAreIndependent) {
    Case c;
    c.things = sphere("0 0 3", ".5");
    const Image image =
        c.render(kUnderASphere +
                 "float sum = 0; uniform float i; for (i = 0; i < 16; i += 1)"
                 "sum += occlusion(P, normal(0, 0, -1), 1) / 16; Ci = color(sum, expected, 1);");
    double square = 0, neighbours = 0, independent = 0;
    const std::vector<Pixel> all = pixels(image);
    const auto error = [&](size_t i) { return static_cast<double>(all[i].red - all[i].green); };
    for (size_t i = 0; i + 1 < all.size(); ++i) {
        const double expected = static_cast<double>(all[i].green);
        square += error(i) * error(i), neighbours += error(i) * error(i + 1);
        independent += expected * (1 - expected) / 16;
    }
    // Deviations of sums over 4096 numbers are about 1/64 (and of their squares some times that, for p is
    // small).
    EXPECT_NEAR(square / independent, 1, 0.15);
    EXPECT_NEAR(neighbours / independent, 0, 0.08);
}

TEST(RayOcclusion, InAClosedBoxIsAll) {
    Case c;
    const std::string box =
        "PointsPolygons [4 4 4 4 4 4] [0 1 3 2 4 5 7 6 0 1 5 4 2 3 7 6 0 2 6 4 1 3 7 5] \"P\" "
        "[-2 -2 1 2 -2 1 -2 2 1 2 2 1 -2 -2 8 2 -2 8 -2 2 8 2 2 8] ";
    const std::string apart =
        "Polygon \"P\" [-2 -2 1 2 -2 1 2 2 1 -2 2 1] Polygon \"P\" [-2 -2 8 2 -2 8 2 2 8 -2 2 8] "
        "Polygon \"P\" [-2 -2 1 2 -2 1 2 -2 8 -2 -2 8] Polygon \"P\" [-2 2 1 2 2 1 2 2 8 -2 2 8] "
        "Polygon \"P\" [-2 -2 1 -2 2 1 -2 2 8 -2 -2 8] Polygon \"P\" [2 -2 1 2 2 1 2 2 8 2 -2 8] ";
    for (const std::string& things : {box, apart}) {
        c.things = "Surface \"constant\" Color .5 .5 .5 " + things;
        expect_told(c.render("Ci = told(occlusion(P, normal(0, 0, -1), 64), 1, 1);"), 0, 64 * 64);
        expect_told(c.render("Ci = told(comp(indirectdiffuse(P, normal(0, 0, -1), 16), 1), .5, 1);"), 1e-6f,
                    64 * 64);
        // Right into the edges and the corners.
        expect_told(c.render("float near = 0; float i, j, k; for (i = -1; i < 2; i += 1)"
                             "for (j = -1; j < 2; j += 1) for (k = -1; k < 2; k += 1)"
                             "if (i != 0 || j != 0 || k != 0) {"
                             "vector w = point(2 * i, 2 * j, 4.5 + 3.5 * k) - P;"
                             "near += trace(P, w) < 1e5 ? 1 : 0; } Ci = told(near, 26, 1);"),
                    0, 64 * 64);
    }
}

/// Away from the middle of the thing.
const std::string kOutwards = "normalize(N) * sign(N . (P - point \"middle\" (0, 0, 0)))";

/// A thing that the camera sees asks for the occlusion of its own outside, all of which is empty.
/// Micropolygons that are seen from the side, or from behind, do not count where the normal is not known to
/// point outwards.
void expect_open(const std::string& thing, const std::string& normal = "faceforward(normalize(N), I)",
                 const std::string& body = "occlusion(P, n, 8)") {
    for (const char* rate : {".5", "9"})
        for (const auto& [view, place] :
             {std::pair("", "Translate 0 0 3"),
              {"Projection \"perspective\" \"fov\" 30 ", "Translate 0 0 4"},
              {"Projection \"perspective\" \"fov\" 30 ", "Translate 0 0 400 Scale 100 100 100"},
              {"Projection \"perspective\" \"fov\" 80 ", "Translate 0 0 1.3"}}) {
            Case c;
            c.options = view;
            c.asker = kSeen + "ShadingRate " + rate + " " + place + " CoordinateSystem \"middle\" ";
            c.asks = "AttributeBegin " + thing + " AttributeEnd ";
            const Image image =
                c.render("normal n = " + normal +
                         "; float facing = abs(n . normalize(I));"
                         "Ci = told(" +
                         body + ", 0, " + (normal == kOutwards ? "1" : "facing > .02 ? 1 : 0") + ");");
            SCOPED_TRACE(thing + rate + view + place);
            expect_told(image, 0, 300);
        }
}

TEST(RaySelfHits, ASphereHasNone) {
    expect_open("Sphere 1 -1 1 360", kOutwards);
}
/// Where it faces the camera by half, a cone about its normal passes above the other side.
TEST(RaySelfHits, ATorusHasNone) {
    expect_open("Torus .7 .3 0 360 360", "faceforward(normalize(N), I)",
                "(-zcomp(n) > .9 ? occlusion(P, n, 8, \"coneangle\", .15) : 0)");
}
TEST(RaySelfHits, ASubdivisionMeshHasNone) {
    expect_open(
        "Rotate 30 1 1 0 SubdivisionMesh \"catmull-clark\" [4 4 4 4 4 4] [0 1 3 2 5 4 6 7 1 0 4 5 2 3 7 6 0 2 6 4 "
        "3 1 5 7] [] [] [] [] \"P\" [-1 -1 -1 1 -1 -1 -1 1 -1 1 1 -1 -1 -1 1 1 -1 1 -1 1 1 1 1 1]",
        kOutwards);
}
/// A dome towards the camera: its control points are those of a paraboloid.
TEST(RaySelfHits, ABicubicPatchHasNone) {
    expect_open(
        "Patch \"bicubic\" \"P\" [-1 -1 1  -.33333 -1 .33333  .33333 -1 .33333  1 -1 1 "
        "-1 -.33333 .33333  -.33333 -.33333 -.33333  .33333 -.33333 -.33333  1 -.33333 .33333 "
        "-1 .33333 .33333  -.33333 .33333 -.33333  .33333 .33333 -.33333  1 .33333 .33333 "
        "-1 1 1  -.33333 1 .33333  .33333 1 .33333  1 1 1]");
}
TEST(RaySelfHits, APolygonHasNone) {
    expect_open("Rotate 40 1 .3 0 Polygon \"P\" [-1 -1 0 1 -1 0 1 1 0 -1 1 0]");
}

/// A quarter of a million rays from inside of closed things; all hit something.
TEST(RayLeaks, ClosedThingsHaveNone) {
    const std::string cube = "[4 4 4 4 4 4] [0 1 3 2 5 4 6 7 1 0 4 5 2 3 7 6 0 2 6 4 3 1 5 7] ";
    const std::string corners = "\"P\" [-1 -1 -1 1 -1 -1 -1 1 -1 1 1 -1 -1 -1 1 1 -1 1 -1 1 1 1 1 1] ";
    const std::pair<std::string, std::string> things[] = {
        {"Sphere 1 -1 1 360 ", "point(0, 0, 5)"},
        {"Torus .7 .3 0 360 360 ", "point(.7, 0, 5)"},
        {"Cylinder 1 -1 1 360 Disk 1 1 360 Disk -1 1 360 ", "point(0, 0, 5)"},
        {"Translate 0 0 -.5 Cone 1 1 360 Disk 0 1 360 ", "point(0, 0, 4.7)"},
        {"PointsPolygons " + cube + corners, "point(0, 0, 5)"},
        {"SubdivisionMesh \"catmull-clark\" " + cube + "[] [] [] [] " + corners, "point(0, 0, 5)"},
        {"SubdivisionMesh \"catmull-clark\" " + cube + "[\"crease\"] [5 1] [0 1 3 2 0] [2.5] " + corners,
         "point(0, 0, 5)"},
        {"Basis \"b-spline\" 1 \"b-spline\" 1 Geometry \"teapot\" ", ""},
    };
    for (const auto& [thing, inside] : things) {
        if (inside.empty()) continue;  // a teapot is not closed
        for (const char* rate : {".5", "20"}) {
            Case c;
            c.things = std::string("ShadingRate ") + rate + " Translate 0 0 5 Rotate 20 1 2 3 " + thing;
            // From the middle, turned as the thing is.
            const std::string middle = inside == "point(.7, 0, 5)" || inside == "point(0, 0, 4.7)"
                                           ? "transform(\"thing\", \"current\", " + std::string(inside) + ")"
                                           : inside;
            c.things =
                std::string("ShadingRate ") + rate +
                " Translate 0 0 5 Rotate 20 1 2 3 Translate 0 0 -5 CoordinateSystem \"thing\" Translate 0 0 5 " +
                thing;
            const Image image =
                c.render("point o = " + middle +
                         "; float leaks = 0; uniform float i; for (i = 0; i < 64; i += 1) {"
                         "vector w = vector(random() - .5, random() - .5, random() - .5);"
                         "if (trace(o + .1 * w, w) > 1e20) leaks += 1; } Ci = told(leaks, 0, 1);");
            SCOPED_TRACE(thing + rate);
            expect_told(image, 0, 64 * 64);
        }
    }
}

// What is seen by whom.

TEST(RayVisibility, EachKindSeesItsOwn) {
    for (const char* kind : {"diffuse", "specular", "transmission", "none"}) {
        Case c;
        c.things =
            "Attribute \"visibility\" \"int diffuse\" 0 \"int specular\" 0 \"int transmission\" 0 " +
            (kind == std::string("none") ? std::string()
                                         : "Attribute \"visibility\" \"int " + std::string(kind) + "\" 1 ") +
            "Surface \"constant\" " + wall("3");
        const auto sees = [&](const std::string& call) {
            c.said.clear();
            const double value = mean_red(c.render("vector w = vector(0, 0, -1); Ci = " + call + ";"));
            const bool empty = kind == std::string("none");
            EXPECT_EQ(c.said.size(), empty ? 1u : 0u);
            if (empty && !c.said.empty()) {
                EXPECT_EQ(c.said[0].kind, "nothing-for-rays");
                EXPECT_EQ(c.said[0].severity, Severity::Warning);
            }
            return value;
        };
        const bool diffuse = kind == std::string("diffuse"), specular = kind == std::string("specular");
        EXPECT_EQ(sees("color trace(P, w)"), specular ? 1 : 0) << kind;
        EXPECT_EQ(sees("float trace(P, w) < 10 ? 1 : 0"), specular ? 1 : 0) << kind;
        EXPECT_EQ(sees("occlusion(P, w, 4, \"coneangle\", .1)"), diffuse ? 1 : 0) << kind;
        EXPECT_EQ(sees("indirectdiffuse(P, w, 4, \"coneangle\", .1)"), diffuse ? 1 : 0) << kind;
        EXPECT_EQ(sees("transmission(P, point(0, 0, 0))"), kind == std::string("transmission") ? 0 : 1)
            << kind;
    }
}

TEST(RayVisibility, NothingIsSeenUnlessItIsAskedFor) {
    Case c;
    c.things = "AttributeEnd AttributeBegin " + kHidden + "Surface \"constant\" " + wall("3");
    const Image image = c.render("Ci = told(float trace(P, vector(0, 0, -1)), 1e30, 1);");
    expect_told(image, 0, 64 * 64);
    EXPECT_EQ(c.said.size(), 1u);
}

/// Sides 1: where the camera sees it, a ray that goes the camera's way does.
TEST(RaySides, AreThoseThatTheCameraSees) {
    const std::string polygon = "Polygon \"P\" [-1.5 -1.5 0 1.5 -1.5 0 1.5 1.5 0 -1.5 1.5 0] ";
    const std::string things[] = {polygon,
                                  "Polygon \"P\" [-1.5 -1.5 0 -1.5 1.5 0 1.5 1.5 0 1.5 -1.5 0] ",
                                  "Sphere 2 -2 2 360 ",
                                  "Disk 0 2 360 ",
                                  "Sphere 2 0 2 360 ",
                                  "Sphere 2 -2 0 360 ",
                                  "Patch \"bilinear\" \"P\" [-2 2 0 2 2 0 -2 -2 0 2 -2 0] "};
    for (const std::string& thing : things)
        for (const char* turn : {"", "ReverseOrientation ", "Orientation \"inside\" ", "Orientation \"rh\" ",
                                 "Scale -1 1 1 ", "Scale 1 1 -1 ", "Scale -1 1 1 Orientation \"rh\" "}) {
            const std::string one_sided = "Sides 1 Translate 0 0 4 " + std::string(turn) + thing;
            Case camera;
            camera.things = "";
            camera.asks = "Surface \"constant\" " + one_sided;
            const Image seen = camera.render("Ci = 1;");
            Case c;
            c.things = one_sided;
            const Image traced = c.render(
                "point o = P; setzcomp(o, .1); float far = trace(o, vector(0, 0, 1));"
                "Ci = far < 1e20 ? 1 : 0;");
            int differ = 0;
            const std::vector<Pixel> a = pixels(seen), b = pixels(traced);
            for (size_t i = 0; i < std::min(a.size(), b.size()); ++i)
                differ += (a[i].alpha > 0) != (b[i].red > 0);
            EXPECT_EQ(differ, 0) << one_sided;
        }
}

/// From inside of it nothing is there; from outside its near side is.
TEST(RaySides, AOneSidedSphereIsSeenFromOutside) {
    Case c;
    c.things = "Sides 1 " + sphere("0 0 5", "2");
    expect_told(c.render("Ci = told(float trace(P, vector(0, 0, -1)), 1e30, 1);"), 0, 64 * 64);
    expect_told(c.render("Ci = told(comp(transmission(P, point(0, 0, 0)), 0), 1, 1);"), 0, 64 * 64);
    expect_told(c.render("Ci = told(occlusion(P, normal(0, 0, -1), 16), 0, 1);"), 0, 64 * 64);
    // From before it, through the near side; the point is at most 1.7 from the axis.
    expect_told(c.render("point o = P; setzcomp(o, 1); float r2 = xcomp(P) * xcomp(P) + ycomp(P) * ycomp(P);"
                         "Ci = told(float trace(o, vector(0, 0, 1)), 4 - sqrt(4 - r2), 1);"),
                1e-3f, 64 * 64);
    expect_told(c.render("Ci = told(comp(transmission(point(0, 0, 0), P), 0), 0, 1);"), 0, 64 * 64);
}

// Arguments.

/// A disk that is seen under half of the cone's angle fills (1 - cos a) / (1 - cos b) of it.
TEST(RayArguments, SamplesFillTheirCone) {
    Case c;
    c.things = "Surface \"constant\" Translate 0 0 3 Disk 0 .302270 360 ";  // 2 tan .15
    const double share = (1 - std::cos(0.15)) / (1 - std::cos(0.3));
    const Image image = c.render(
        "color k = trace(point(0, 0, 5), vector(0, 0, -3), \"samples\", 64, \"samplecone\", .3);"
        "Ci = k + 0 * s;");
    EXPECT_NEAR(mean_red(image), share, 2e-3);
    // A transmission's rays spread too.
    EXPECT_NEAR(mean_red(c.render("Ci = transmission(point(0, 0, 5) + 0 * P, point(0, 0, 0), \"samples\", 64,"
                                  " \"samplecone\", .3);")),
                1 - share, 2e-3);
    // All within the disk.
    expect_told(
        c.render("color k = trace(point(0, 0, 5) + 0 * P, vector(0, 0, -3), \"samples\", 64, \"samplecone\", "
                 ".14); Ci = told(comp(k, 0), 1, 1);"),
        1e-6f, 64 * 64);
}

TEST(RayArguments, MaxdistEndsRays) {
    Case c;
    c.things = "Surface \"constant\" " + wall("3");
    const std::string w = "vector w = vector(0, 0, -4); ";
    for (const auto& [most, hits] :
         {std::pair("1.9", "0"), {"2.1", "1"}, {"1e30", "1"}, {"1.9 + 0 * s", "0"}}) {
        const auto told = [&](const std::string& value) {
            SCOPED_TRACE(value + most);
            expect_told(c.render(w + "float most = " + most + ", hits = " + hits + ", k; k = " + value +
                                 "; Ci = told(k, hits, 1);"),
                        1e-6f, 64 * 64);
        };
        told("float trace(P, w, \"maxdist\", most) < 3 ? 1 : 0");
        told("comp(color trace(P, w, \"maxdist\", most), 0)");
        told("1 - comp(transmission(P, point(0, 0, 0), \"maxdist\", most), 0)");
        told("occlusion(P, w, 8, \"maxdist\", most, \"coneangle\", .1)");
        told("comp(indirectdiffuse(P, w, 8, \"maxdist\", most, \"coneangle\", .1), 1)");
    }
    // A sphere around the point: the part of a plane within reach is that within an angle.
    const Image image = c.render("Ci = occlusion(P, normal(0, 0, -1), 256, \"maxdist\", 4);");
    EXPECT_NEAR(mean_red(image), 0.75, 2e-3) << "sin^2 of 60 degrees";
}

TEST(RayArguments, BiasSkipsWhatIsNear) {
    Case c;
    c.things = "Surface \"constant\" Color .5 .5 .5 " + wall("4") + "Color .25 .25 .25 " + wall("2");
    const std::string w = "vector w = vector(0, 0, -1); ";
    for (const auto& [bias, color, far] : {std::tuple("0", ".5", "1"),
                                           {".9", ".5", "1"},
                                           {"1.1", ".25", "3"},
                                           {"2.9", ".25", "3"},
                                           {"3.1", "0", "1e30"}}) {
        const std::string b = std::string("\"bias\", ") + bias;
        expect_told(c.render(w + "Ci = told(float trace(P, w, " + b + "), " + far + ", 1);"), 1e-5f, 64 * 64);
        expect_told(c.render(w + "Ci = told(comp(color trace(P, w, " + b + "), 0), " + color + ", 1);"),
                    1e-6f, 64 * 64);
        if (bias == std::string("0")) continue;
        c.asker = std::string("Attribute \"trace\" \"bias\" ") + bias + " ";
        expect_told(c.render(w + "Ci = told(float trace(P, w), " + far + ", 1);"), 1e-5f, 64 * 64);
        c.asker += kSeen;
        c.asker = "";
    }
    c.asker = "Attribute \"trace\" \"bias\" 1.5 ";
    expect_told(c.render(w + "Ci = told(float trace(P, w, \"bias\", .5), 1, 1);"), 1e-5f, 64 * 64);
    c.asker = "";
    // At both ends of what transmission() asks for.
    expect_told(
        c.render(
            "point to = P - vector(0, 0, 4); Ci = told(comp(transmission(P, to, \"bias\", 1.1), 0), 1, 1);"),
        0, 64 * 64);
}

/// A sphere straight above, seen under half an angle of asin(1/4), fills sin^2 of it over sin^2 of the
/// cone's.
TEST(RayArguments, ConeangleNarrowsTheSky) {
    Case c;
    c.things = sphere("0 0 3", ".5");
    const std::string call = "Ci = occlusion(point(0, 0, 5) + 0 * P, normal(0, 0, -1), 256, \"coneangle\", ";
    EXPECT_NEAR(mean_red(c.render(call + "PI / 2);")), 1.0 / 16, 5e-4);
    EXPECT_NEAR(mean_red(c.render(call + "PI / 4);")), 2.0 / 16, 1e-3);
    EXPECT_NEAR(mean_red(c.render(call + ".5);")), 1.0 / 16 / std::pow(std::sin(0.5), 2), 2e-3);
    EXPECT_EQ(mean_red(c.render(call + ".2);")), 1);
    EXPECT_EQ(mean_red(c.render(call + "0);")), 1);
    const double angle = std::asin(0.25);
    EXPECT_NEAR(mean_red(c.render(call + "PI / 2, \"distribution\", \"uniform\");")), 1 - std::cos(angle),
                5e-4);
    EXPECT_NEAR(mean_red(c.render(call + "PI / 2, \"distribution\", \"cosine\");")), 1.0 / 16, 5e-4);
}

TEST(RayArguments, FalloffDimsWhatIsFar) {
    Case c;
    c.things = wall("3");
    const std::string call = "Ci = told(occlusion(P, normal(0, 0, -1), 16, \"coneangle\", .01, \"falloff\", ";
    expect_told(c.render(call + "0), 1, 1);"), 0, 64 * 64);
    expect_told(c.render(call + "1), exp(-2), 1);"), 1e-4f, 64 * 64);
    expect_told(c.render(call + ".25, \"falloffmode\", 0), exp(-.5), 1);"), 1e-4f, 64 * 64);
    expect_told(c.render(call + "1, \"falloffmode\", 1, \"maxdist\", 8), .75, 1);"), 1e-4f, 64 * 64);
    expect_told(c.render(call + "3, \"falloffmode\", 1, \"maxdist\", 8), .421875, 1);"), 1e-4f, 64 * 64);
}

TEST(RayArguments, AbsurdOnesDoNoHarm) {
    Case c;
    c.things = "Surface \"constant\" " + wall("3");
    const std::string odd =
        "float nan = 1e30 * (2 + s); nan *= nan; nan -= nan; vector w = vector(0, 0, -1);";
    for (const char* value : {"-1", "0", "nan", "1e-30", "-1e30"})
        for (const char* name :
             {"samples", "samplecone", "maxdist", "bias", "coneangle", "falloff", "unknown"}) {
            const std::string more = std::string(", \"") + name + "\", " + value + ");";
            for (const std::string call :
                 {"color k = trace(P, w", "color k = transmission(P, point(0, 0, 0)",
                  "color k = occlusion(P, w, 2", "color k = indirectdiffuse(P, w, 2"})
                for (const Pixel& p : pixels(c.render(odd + call + more + "Ci = k;"))) {
                    ASSERT_GE(p.red, 0) << call << more;
                    ASSERT_LE(p.red, 1) << call << more;
                }
        }
}

// Moving and displaced things.

TEST(RayScenes, MovingThingsAndLensesAreMetAtShutterOpen) {
    Case c;
    c.options = "Shutter 0 1 DepthOfField 4 1 4 ";
    c.things =
        "Surface \"constant\" MotionBegin [0 1] Translate 0 0 3 Translate 0 0 4 MotionEnd "
        "Patch \"bilinear\" \"P\" [-6 6 0 6 6 0 -6 -6 0 6 -6 0] ";
    expect_told(c.render("Ci = told(float trace(P, vector(0, 0, -1)), 2, 1);"), 1e-5f);
    // Whatever moves asks, and deforms.
    c.asks =
        "MotionBegin [0 1] Translate 0 0 0 Translate .2 .1 .3 MotionEnd MotionBegin [0 1] "
        "Patch \"bilinear\" \"P\" [-2 2 5 2 2 5 -2 -2 5 2 -2 5] "
        "Patch \"bilinear\" \"P\" [-2 2 5 2 2 6 -2 -2 5 2 -2 7] MotionEnd ";
    c.asker = kSeen;
    expect_told(c.render("Ci = told(float trace(P, vector(0, 0, -1)), 2, 1);"), 1e-5f);
    c.options += "Projection \"perspective\" \"fov\" 40 ";
    expect_told(c.render("Ci = told(float trace(P, vector(0, 0, -1)), 2, 1);"), 1e-5f);
    EXPECT_GT(mean_red(c.render("Ci = occlusion(P, normal(0, 0, -1), 4);")), 0.8);
}

TEST(RayScenes, DisplacementsAreMetIfTheyAreAskedFor) {
    Case c;
    c.shaders["lift"] = "displacement lift() { P += vector(0, 0, .5); N = calculatenormal(P); }";
    const std::string thing =
        "Attribute \"displacementbound\" \"sphere\" [.6] Displacement \"lift\" " + wall("3");
    const std::string asks = "Ci = told(float trace(P, vector(0, 0, -1)), ";
    c.things = thing;
    expect_told(c.render(asks + "2, 1);"), 1e-5f, 64 * 64);
    c.things = "Attribute \"trace\" \"int displacements\" [1] " + thing;
    expect_told(c.render(asks + "1.5, 1);"), 1e-5f, 64 * 64);
    // Hits are where the displaced surface is.
    c.shaders["tells"] = "surface tells() { Oi = 1; Ci = zcomp(P); }";
    c.things = "Surface \"tells\" Attribute \"trace\" \"int displacements\" [1] " + thing;
    expect_told(c.render("Ci = told(comp(color trace(P, vector(0, 0, -1)), 0), 3.5, 1);"), 1e-5f, 64 * 64);
}

/// A displaced plane, which is flat as before, does not hide itself.
TEST(RayScenes, ADisplacedPlaneDoesNotHideItself) {
    Case c;
    c.shaders["lift"] = "displacement lift() { P += vector(0, 0, .5); N = calculatenormal(P); }";
    c.things = wall("-50");
    c.asker = kSeen +
              "Attribute \"trace\" \"int displacements\" [1] Attribute \"displacementbound\" \"sphere\" [.6] "
              "Displacement \"lift\" ";
    expect_told(c.render("Ci = told(occlusion(P, normal(0, 0, -1), 32, \"maxdist\", 20), 0, 1);"), 0,
                64 * 64);
}

/// Everything at once gives the same bits for any number of threads, regions and any method.
TEST(RayScenes, AreTheSameForEveryOrderOfWork) {
    Case c;
    c.shaders["window"] =
        "surface window() { Oi = mod(floor(5 * u) + floor(3 * v), 2) * .5 + .25; Ci = Oi * Cs; }";
    c.shaders["mirror"] =
        "surface mirror() { Oi = 1; Ci = .2 + .7 * color trace(P, reflect(normalize(I), normalize(N))); }";
    c.things = "Surface \"window\" Color .2 .8 .3 " + sphere("-.4 0 3", ".4") + "Surface \"mirror\" " +
               sphere(".5 .3 3.5", ".4") + wall("8") + "Attribute \"visibility\" \"int camera\" 1 " +
               sphere("0 -.6 3", ".3");
    c.options = "PixelSamples 2 2 Shutter 0 1 ";
    const std::string body =
        "Ci = occlusion(P, normal(0, 0, -1), 8) * transmission(P, point(-1, 2, 0)) +"
        "trace(P, vector(.1, .1, -1), \"samples\", 4, \"samplecone\", .2);";
    const Image first = c.render(body);
    c.threads = 1;
    EXPECT_EQ(c.render(body).rgba, first.rgba);
    c.threads = 7;
    c.settings.regions_at_least = 4;
    EXPECT_EQ(c.render(body).rgba, first.rgba);
    c.settings.sampler = "bruteforce";
    EXPECT_EQ(c.render(body).rgba, first.rgba);
}

}  // namespace
}  // namespace trapeze::testing
