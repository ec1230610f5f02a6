/// What calls that trace can be told by name, next to closed forms: which hits count and what they stand for,
/// and what lies behind all of them.
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include "tests/rays/rays_harness.h"

namespace trapeze::testing {
namespace {

const std::string kUp = "vector w = vector(0, 0, -1); ";

// Which hits count.

/// A sphere has an outside in front and an inside behind it.
TEST(RayHits, SidesAreThoseAskedFor) {
    for (const char* sides : {"Sides 2 ", "Sides 1 "}) {
        Case c;
        c.things = sides + sphere("0 0 3", "1.9");
        const std::string deep =
            kUp + "float r2 = xcomp(P) * xcomp(P) + ycomp(P) * ycomp(P), deep = sqrt(3.61 - r2);";
        const auto expect = [&](const std::string& given, const std::string& distance) {
            SCOPED_TRACE(sides + given);
            // Micropolygons' middles lie (h sqrt 2)^2 / 8 R inside, h = 1/32: 1.3e-4, over a cosine of 0.66.
            expect_told(c.render(deep + "Ci = told(float trace(P, w, \"hitsides\", \"" + given + "\"), " +
                                 distance + ", 1);"),
                        4e-4f, 64 * 64);
        };
        expect("front", "2 - deep");
        expect("back", "2 + deep");
        expect("both", "2 - deep");
        expect("", "2 - deep");
        expect_told(c.render("point o = point(0, 0, 3) + 0 * P;"
                             "Ci = told(float trace(o, vector(0, 0, 1), \"hitsides\", \"both\"), 1.9, 1);"),
                    4e-4f, 64 * 64);
        expect_told(c.render("point o = point(0, 0, 3) + 0 * P;"
                             "Ci = told(float trace(o, vector(0, 0, 1), \"hitsides\", \"front\"), 1e30, 1);"),
                    0, 64 * 64);
        // Of all calls: from inside of it the sphere is closed, or not there.
        for (const auto& [given, open] : {std::pair("back", "0"), {"front", "1"}}) {
            const std::string asks =
                "point o = point(0, 0, 3) + 0 * P; normal n = normal(0, 0, 1); color seen = 0; float hits = 0;";
            const std::string side = std::string(", \"hitsides\", \"") + given + "\")";
            expect_told(c.render(asks + "Ci = told(1 - occlusion(o, n, 8" + side + ", " + open + ", 1);"), 0,
                        64 * 64);
            expect_told(c.render(asks + "Ci = told(comp(transmission(o, point(0, 0, -2)" + side + ", 1), " +
                                 open + ", 1);"),
                        0, 64 * 64);
            expect_told(c.render(asks + "gather(\"\", o, n, 1, 4" + side +
                                 " hits += 1; Ci = told(1 - hits / 4, " + open + ", 1);"),
                        0, 64 * 64);
        }
    }
}

TEST(RayHits, SubsetsAreGroups) {
    Case c;
    const auto member = [](const std::string& groups) {
        return "Attribute \"grouping\" \"string membership\" [\"" + groups + "\"] ";
    };
    c.things = "Surface \"constant\" " + member("near") + wall("4") + member("+middle both") + wall("3") +
               member("-near") + wall("2") + member("") + wall("1");
    for (const auto& [subset, distance] : {std::pair("near", "1"),
                                           {"middle", "2"},
                                           {"both,none", "2"},
                                           {"near, middle", "1"},
                                           {"none", "1e30"},
                                           {"-near", "3"},
                                           {"-near -both", "4"},
                                           {"middle -near", "3"},
                                           {"", "1"}}) {
        SCOPED_TRACE(subset);
        const std::string given = std::string(", \"subset\", \"") + subset + "\")";
        expect_told(c.render(kUp + "Ci = told(float trace(P, w" + given + ", " + distance + ", 1);"), 1e-5f,
                    64 * 64);
        expect_told(c.render(kUp + "float far = 1e30; gather(\"\", P, w, 0, 1, \"ray:length\", far" + given +
                             " { } Ci = told(far, " + distance + ", 1);"),
                    1e-5f, 64 * 64);
        const std::string hit = std::string(distance) == "1e30" ? "0" : "1";
        expect_told(
            c.render(kUp + "Ci = told(occlusion(P, w, 4, \"coneangle\", .1" + given + ", " + hit + ", 1);"),
            0, 64 * 64);
        expect_told(
            c.render("Ci = told(1 - comp(transmission(P, point(0, 0, .5)" + given + ", 0), " + hit + ", 1);"),
            0, 64 * 64);
    }
}

// What hits stand for.

TEST(RayHits, ModesAreOfCallsAndOfAttributes) {
    Case c;
    c.shaders["window"] = "surface window() { Oi = .25; Ci = .125; }";
    const std::string thing = "Surface \"window\" Color .5 .5 .5 Opacity .75 .75 .75 " + wall("3");
    const auto expect = [&](const std::string& attribute, const std::string& call, const std::string& value) {
        SCOPED_TRACE(attribute + call);
        c.things = attribute + thing;
        expect_told(c.render(kUp + "color k = " + call + "; Ci = told(comp(k, 0), " + value + ", 1);"), 1e-6f,
                    64 * 64);
    };
    const std::string trace = "trace(P, w", indirect = "indirectdiffuse(P, w, 4, \"coneangle\", .1";
    const std::string occlusion = "occlusion(P, w, 4, \"coneangle\", .1",
                      shadow = "transmission(P, P + 4 * w";
    const std::string primitive = ", \"hitmode\", \"primitive\")", shader = ", \"hitmode\", \"shader\")",
                      usual = ", \"hitmode\", \"default\")";
    const auto attribute = [](const std::string& name, const std::string& mode) {
        return "Attribute \"shade\" \"string " + name + "hitmode\" [\"" + mode + "\"] ";
    };
    // The primitive's colour is Cs Os: .375.
    expect("", trace + usual, ".125");
    expect("", trace + primitive, ".375");
    expect(attribute("specular", "primitive"), trace + ")", ".375");
    expect(attribute("specular", "primitive"), trace + shader, ".125");
    expect("", indirect + usual, ".125");
    expect("", indirect + primitive, ".375");
    expect(attribute("diffuse", "primitive"), indirect + ")", ".375");
    expect("", occlusion + usual, ".75");
    expect("", occlusion + shader, ".25");
    expect(attribute("diffuse", "shader"), occlusion + ")", ".25");
    expect(attribute("diffuse", "shader"), occlusion + primitive, ".75");
    expect("", shadow + usual, ".75");
    expect("", shadow + primitive, ".25");
    expect(attribute("transmission", "primitive"), shadow + ")", ".25");
    expect(attribute("transmission", "primitive"), shadow + shader, ".75");
    expect(attribute("transmission", "primitive") + attribute("diffuse", "shader"), shadow + ")", ".25");
    expect(attribute("transmission", "primitive") + attribute("diffuse", "shader"), occlusion + ")", ".25");
}

/// What a shader can ask of the ray that has hit its surface.
TEST(RayHits, KnowTheirRays) {
    Case c;
    const auto expect = [&](const std::string& tells, const std::string& call, const std::string& value) {
        SCOPED_TRACE(tells + call);
        c.shaders["tells"] = "surface tells() { Oi = 1; string text; float n = -1; " + tells + " Ci = n; }";
        c.things = "Surface \"tells\" " + wall("3") + wall("8");
        expect_told(c.render(kUp + "color k = 0; " + call + "; Ci = told(comp(k, 0), " + value + ", 1);"), 0,
                    64 * 64);
    };
    const std::string label = "if (raylabel() == \"mine\") n = 1;";
    expect(label, "k = trace(P, w, \"label\", \"mine\")", "1");
    expect(label, "k = trace(P, w, \"label\", \"other\")", "-1");
    expect(label, "k = trace(P, w)", "-1");
    expect("n = rayinfo(\"label\", text); if (text == \"mine\") n += 1;",
           "k = indirectdiffuse(P, w, 1, \"coneangle\", .1, \"label\", \"mine\")", "2");
    expect(label, "gather(\"\", P, w, 0, 1, \"surface:Ci\", k, \"label\", \"mine\") { }", "1");
    const std::string type = "n = rayinfo(\"type\", text);";
    expect(type + "if (text == \"specular\") n += 1;", "k = trace(P, w)", "2");
    expect(type + "if (text == \"diffuse\") n += 1;", "k = indirectdiffuse(P, w, 1, \"coneangle\", .1)", "2");
    for (const auto& [name, trace, indirect] : {std::tuple("depth", "1", "1"),
                                                {"speculardepth", "1", "0"},
                                                {"diffusedepth", "0", "1"},
                                                {"shadowdepth", "0", "0"}}) {
        const std::string asks = std::string("rayinfo(\"") + name + "\", n);";
        expect(asks, "k = trace(P, w)", trace);
        expect(asks, "k = indirectdiffuse(P, w, 1, \"coneangle\", .1)", indirect);
    }
    expect("n = isindirectray();", "k = comp(indirectdiffuse(P, w, 1, \"coneangle\", 0), 0)", "1");
    expect("n = isindirectray() + isshadowray();", "k = comp(color trace(P, w), 0)", "0");
    expect("n = raydepth();", "k = trace(P, w)", "1");
}

/// Where rays that have hit began, which way they came and how far: in shaders of surfaces and of lights.
TEST(RayHits, KnowWhereTheirRaysBegan) {
    const std::string asks_all =
        " point o = 0; vector d = 0; float l = -1; string name = concat(\"len\", \"gth\");"
        "float n = rayinfo(\"origin\", o) + rayinfo(\"direction\", d) + rayinfo(name, l);";
    const std::pair<std::string, std::string> tells[] = {
        {"color(xcomp(o), ycomp(o), zcomp(o))", "color(xcomp(P), ycomp(P), zcomp(P))"},
        {"color(xcomp(d), ycomp(d), zcomp(d))", "color(xcomp(w), ycomp(w), zcomp(w))"},
        {"l", "2 / -zcomp(w)"},
        {"n", "3"}};
    const std::string way = "vector w = normalize(vector(.3, .1, -1));";
    for (const auto& [told, expected] : tells) {
        SCOPED_TRACE(told);
        Case c;
        c.shaders["tells"] = "surface tells() {" + asks_all + " Oi = 1; Ci = " + told + "; }";
        c.shaders["tellslight"] = "light tellslight() {" + asks_all + " solar() { Cl = " + told + "; } }";
        c.shaders["lit"] = "surface lit() { Oi = 1; illuminance(P) { Ci = Cl; } }";
        const std::string body = way + "color k = color trace(P, w), e = " + expected +
                                 "; color off = k - e; vector o3 = vector(comp(off, 0), comp(off, 1), "
                                 "comp(off, 2)); Ci = color(length(o3), comp(k, 0), 1);";
        for (const std::string surface :
             {"Surface \"tells\" ", "LightSource \"tellslight\" 1 Surface \"lit\" "}) {
            c.things = surface + wall("3");
            for (const Pixel& p : pixels(c.render(body))) ASSERT_NEAR(p.red, 0, 1e-5f) << surface;
        }
    }
}

/// The camera's own begin in the eye, or on the eye's plane.
TEST(RayHits, TheCamerasRaysBeginInTheEye) {
    const std::string asks =
        "point o = 7; vector d = 7; float l = 7, n = rayinfo(\"origin\", o) + rayinfo(\"direction\", d) + "
        "rayinfo(\"length\", l);";
    const std::string tells =
        "Ci = color(length(o - from) + length(d - normalize(P - from)) + abs(l - length(P - from)), n, 1);";
    for (const auto& [projection, from] :
         {std::pair("orthographic", "point(xcomp(P), ycomp(P), 0)"), {"perspective", "point(0, 0, 0)"}}) {
        Case c;
        c.options = std::string("Projection \"") + projection + "\" ";
        c.asks = "Scale 5 5 1 " + kAsker;
        for (const Pixel& p : pixels(c.render("point from = " + std::string(from) + ";" + asks + tells))) {
            ASSERT_NEAR(p.red, 0, 1e-5f) << projection;
            ASSERT_EQ(p.green, 3) << projection;
        }
        // Lights are asked by the surface that the camera sees.
        c.shaders["tells"] = "light tells() {" + asks + " solar() { Cl = color(l, zcomp(d), n); } }";
        c.asker = "LightSource \"tells\" 1 ";
        for (const Pixel& p :
             pixels(c.render("point from = " + std::string(from) +
                             "; illuminance(P) { Ci = color(comp(Cl, 0) - length(P - from), comp(Cl, 1) - "
                             "5 / length(P - from), comp(Cl, 2)); }"))) {
            ASSERT_NEAR(p.red, 0, 1e-5f) << projection;
            ASSERT_NEAR(p.green, 0, 1e-5f) << projection;
            ASSERT_EQ(p.blue, 3) << projection;
        }
    }
}

/// Variables of another type, and those of vertices that do not ask, stay as they are.
TEST(RayHits, ToldIsWhoAsksForTheRightType) {
    Case c;
    expect_told(c.render("float n = -1; Ci = told(rayinfo(\"origin\", n) + n, -1, 1);"), 0, 64 * 64);
    expect_told(c.render("point n = 3; Ci = told(rayinfo(\"length\", n) + xcomp(n), 3, 1);"), 0, 64 * 64);
    expect_told(c.render("string n = \"a\"; float f = rayinfo(\"length\", n); if (n == \"a\") f += 1;"
                         "Ci = told(f, 1, 1);"),
                0, 64 * 64);
    expect_told(c.render("float n = -1; if (xcomp(P) > 0) rayinfo(\"length\", n);"
                         "Ci = told(n, xcomp(P) > 0 ? 5 : -1, 1);"),
                1e-6f, 64 * 64);
}

/// A diffuse bounce leaves the specular ones, and the least of the bounds on the way holds.
TEST(RayHits, DepthsAreCountedByKind) {
    Case c;
    c.shaders["mirror"] =
        "surface mirror() { Oi = 1; Ci = color trace(P, reflect(normalize(I), normalize(N))) / 2; }";
    c.shaders["lit"] =
        "surface lit() { Oi = 1; float d = -1; rayinfo(\"diffusedepth\", d); float s = -1;"
        "rayinfo(\"speculardepth\", s); Ci = d + 10 * s; }";
    const auto expect = [&](const std::string& of_asker, const std::string& of_mirror,
                            const std::string& value) {
        SCOPED_TRACE(of_asker + of_mirror);
        c.asker = of_asker;
        c.things = of_mirror + "Surface \"mirror\" " + wall("3") + "Surface \"lit\" " + wall("9");
        expect_told(c.render(kUp +
                             "color k = indirectdiffuse(P, w, 4, \"coneangle\", .01);"
                             "Ci = told(comp(k, 0), " +
                             value + ", 1);"),
                    1e-6f, 64 * 64);
    };
    const auto most = [](const std::string& kind, int depth) {
        return "Attribute \"trace\" \"int max" + kind + "depth\" [" + std::to_string(depth) + "] ";
    };
    expect("", "", "5.5");
    expect(most("specular", 1), "", "5.5");
    expect("", most("specular", 1), "5.5");
    expect(most("specular", 0), "", "0");
    expect("", most("specular", 0), "0");
    expect(most("diffuse", 0), "", "0");
}

// Where rays begin.

/// Over half a micropolygon's side, 1/32, to either side; evenly.
TEST(RayOrigins, SamplebaseSpreadsThem) {
    Case c;
    const std::string body =
        "point o = 0; vector sum = 0; float wide = 0, square = 0, n = 0;"
        "gather(\"samplepattern\", P, vector(0, 0, -1), 0, 256, \"ray:origin\", o, \"samplebase\", ";
    const std::string rest =
        ") { } else { vector off = 32 * (o - P); sum += off / 256; square += xcomp(off) * xcomp(off) / 256;"
        " if (max(max(abs(xcomp(off)), abs(ycomp(off))), abs(zcomp(off))) > .501 * ";
    const std::string end = ") wide += 1; n += 1; } ";
    expect_told(c.render(body + "1" + rest + "1" + end + "Ci = told(wide + n, 256, 1);"), 0, 64 * 64);
    expect_told(c.render(body + ".5" + rest + ".5" + end + "Ci = told(wide + n, 256, 1);"), 0, 64 * 64);
    // A uniform number's variance is 1/12, the mean of 256 has a deviation of 0.018, its square of 0.0047.
    expect_told(c.render(body + "1" + rest + "1" + end + "Ci = told(xcomp(sum), 0, 1);"), 0.09f, 64 * 64);
    expect_told(c.render(body + "1" + rest + "1" + end + "Ci = told(ycomp(sum), 0, 1);"), 0.09f, 64 * 64);
    expect_told(c.render(body + "1" + rest + "1" + end + "Ci = told(square, 1 / 12, 1);"), 0.025f, 64 * 64);
    expect_told(c.render(body + "0" + rest + "0" + end + "Ci = told(square + zcomp(sum), 0, 1);"), 0,
                64 * 64);
}

// environment() that traces.

TEST(RayEnvironment, IsATraceFromP) {
    Case c;
    c.things = "Surface \"constant\" Color .25 .5 1 " + sphere("0 0 3", ".5") +
               "Color .2 .4 .8 Opacity .5 .5 .5 " + wall("1");
    for (const char* name : {"\"raytrace\"", "map"})
        expect_told(c.render("string map = \"raytrace\"; vector w = vector(.1 * u, -.2 * v, -1);"
                             "color a = environment(" +
                             std::string(name) + ", w), b = trace(P, w); float g = environment(" + name +
                             "[1], w); color off = a - b;"
                             "Ci = told(off . off + abs(g - comp(b, 1)), 0, comp(b, 0) > 0 ? 1 : 0);"),
                    1e-10f, 3500);
    // With samples of a cone, as trace() has them.
    c.things = "Surface \"constant\" Translate 0 0 3 Disk 0 .302270 360 ";  // 2 tan .15
    EXPECT_NEAR(
        mean_red(c.render("Ci = color environment(\"raytrace\", vector(0, 0, -3) + 0 * (P - point(0, 0, 5)),"
                          " \"samples\", 64, \"samplecone\", .3);")),
        mean_red(c.render("Ci = color trace(P, vector(0, 0, -3), \"samples\", 64, \"samplecone\", .3);")),
        2e-3);
}

// What is behind everything.

/// Environment maps in a folder: white, a colour, and white for all that is above the horizon (z) alone.
class RaySky : public ::testing::Test {
  protected:
    RaySky() {
        save("white", [](int) { return V3f(1, 1, 1); });
        save("tint", [](int) { return V3f(0.5f, 0.25f, 1); });
        save("upper", [](int y) { return y < 32 ? V3f(1, 1, 1) : V3f(0, 0, 0); });
        c.options = "Option \"searchpath\" \"string texture\" [\"" + folder.path().string() + "\"] ";
    }

    void save(const std::string& name, const std::function<V3f(int)>& row) const {
        constexpr int kWidth = 128, kHeight = 64;
        const std::string file = (folder / (name + ".exr")).string();
        const auto out = OIIO::ImageOutput::create(file);
        ASSERT_TRUE(out && out->open(file, OIIO::ImageSpec(kWidth, kHeight, 3, OIIO::TypeDesc::FLOAT)));
        std::vector<float> all;
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x)
                for (int k = 0; k < 3; ++k) all.push_back(row(y)[k]);
        ASSERT_TRUE(out->write_image(OIIO::TypeDesc::FLOAT, all.data()) && out->close());
    }

    const WorkFolder folder;
    Case c;
};

const std::string kFloor = "normal n = normal(0, 0, -1); ";

TEST_F(RaySky, IsSeenWhereRaysMiss) {
    c.things = "Surface \"constant\" Color .2 .2 .2 Opacity .5 .5 .5 " + wall("3");
    const std::string map = ", \"environmentmap\", \"tint.exr\")";
    const auto expect = [&](const std::string& call, const std::string& value) {
        SCOPED_TRACE(call);
        expect_told(c.render(kFloor + "color k = " + call + "; Ci = told(comp(k, 1), " + value + ", 1);"),
                    1e-5f, 64 * 64);
    };
    expect("trace(P, n" + map, ".1 + .125");
    expect("trace(P, -n" + map, ".25");
    expect("environment(\"raytrace\", vector n" + map, ".1 + .125");
    expect("indirectdiffuse(P, n, 16, \"coneangle\", .1" + map, ".1 + .125");
    expect("indirectdiffuse(P, -n, 16" + map, ".25");
    expect("indirectdiffuse(P, -n, 16)", "0");
}

/// By the space's z: the world's, or that of a coordinate system that is turned over.
TEST_F(RaySky, IsOfItsSpace) {
    c.things =
        "TransformBegin Rotate 180 1 0 0 CoordinateSystem \"over\" TransformEnd "
        "TransformBegin Rotate 90 0 1 0 CoordinateSystem \"aside\" TransformEnd " +
        sphere("0 0 500", "1");
    const auto expect = [&](const std::string& way, const std::string& space, double value,
                            double tolerance) {
        const std::string given = space.empty() ? "" : ", \"environmentspace\", \"" + space + "\"";
        EXPECT_NEAR(mean_red(c.render("Ci = indirectdiffuse(P, normal(" + way +
                                      "), 64, \"environmentmap\", \"upper.exr\"" + given + ");")),
                    value, tolerance)
            << way << space;
    };
    expect("0, 0, 1", "", 1, 0.01);
    expect("0, 0, -1", "", 0, 0.01);
    expect("0, 0, 1", "over", 0, 0.01);
    expect("0, 0, -1", "over", 1, 0.01);
    expect("1, 0, 0", "", 0.5, 0.01);
    expect("0, 0, 1", "aside", 0.5, 0.01);
    c.may_say = "rsl-environment-space nowhere", c.said.clear();
    expect("0, 0, 1", "nowhere", 1, 0.01);
    EXPECT_EQ(c.said.size(), 1u);
}

/// A map's mean about a direction, without rays.
TEST_F(RaySky, HasAMeanOfItsOwn) {
    c.things = wall("3");
    const auto mean_of = [&](const std::string& map, const std::string& way) {
        return mean_found(
            c.render("Ci = indirectdiffuse(\"" + map + ".exr\", vector(" + way + ") + 0 * vector(P));"));
    };
    EXPECT_NEAR(mean_of("tint", "1, 2, 3"), 0.25, 1e-5);
    EXPECT_NEAR(mean_of("upper", "0, 0, 1"), 1, 0.02);
    EXPECT_NEAR(mean_of("upper", "0, 0, -1"), 0, 0.02);
    EXPECT_NEAR(mean_of("upper", "0, 1, 0"), 0.5, 0.02);
    // The part of the sky above, by the cosine to a way that is turned by an angle a: (1 + cos a) / 2.
    EXPECT_NEAR(mean_of("upper", "0, .8, .6"), 0.8, 0.02);
    // Where it is all that is asked nobody misses things that rays would see.
    c.things.clear(), c.said.clear();
    EXPECT_NEAR(mean_of("tint", "1, 2, 3"), 0.25, 1e-5);
    EXPECT_TRUE(c.said.empty());
}

/// By discs what none of them covers, as by rays: the same map in the same space, and nothing of it behind a
/// wall.
TEST_F(RaySky, IsSeenBetweenDiscs) {
    c.asker = "ShadingRate 16 ";
    c.things =
        "TransformBegin Rotate 70 1 0 0 CoordinateSystem \"aside\" TransformEnd Surface \"constant\" "
        "Color .2 .4 .6 " +
        sphere("0 0 3.5", "1.2");
    const auto call = [](const std::string& name, const std::string& more) {
        return name + more +
               ", \"environmentmap\", \"upper.exr\", \"environmentspace\", \"aside\", "
               "\"environmentcolor\", e)";
    };
    for (const char* const name : {"indirectdiffuse", "occlusion"}) {
        const std::string rays = call(name, "(P, n, 1024"), discs = call(name, "(P, n, 0, \"pointbased\", 1");
        const Image image =
            c.render(kFloor + "color e = 0; color a = " + discs + "; color sky = e; color b = " + rays +
                     "; Ci = color(comp(a, 0) - comp(b, 0) + .5, comp(sky, 0), comp(e, 0));");
        float most = 0, least = 1;
        for (const Pixel& pixel : pixels(image)) {
            EXPECT_NEAR(pixel.red, .5f, .03f) << name;
            EXPECT_NEAR(pixel.green, pixel.blue, .03f) << name;
            most = std::max(most, pixel.blue), least = std::min(least, pixel.blue);
        }
        EXPECT_GT(most, .3f);
        EXPECT_LT(least, most - .1f);
    }
}

/// Under a white sky what is open and what is hidden are all, by discs exactly.
TEST_F(RaySky, OpenAndHiddenAreAllByDiscs) {
    c.things = "Surface \"constant\" Color 0 0 0 " + sphere("0 0 3", ".9");
    expect_told(c.render(kFloor + "color e = -1; float o = occlusion(P, n, 0, \"pointbased\", 1, "
                                  "\"environmentmap\", \"white.exr\", \"environmentcolor\", e);"
                                  "Ci = told(o + comp(e, 0), 1, o > .01 && o < .99 ? 1 : 0);"),
                1e-5f, 4000);
}

/// Under a white sky what is open and what is hidden are all.
TEST_F(RaySky, OpenAndHiddenAreAll) {
    c.things = "Surface \"constant\" Color 0 0 0 " + sphere("0 0 3", ".9") + "Opacity .5 .5 .5 " + wall("1");
    const std::string asks = kFloor + "color e = -1; float o = -1; vector d = 0;";
    const std::string named = "\"environmentmap\", \"white.exr\", \"environmentcolor\", e";
    expect_told(c.render(asks + "o = occlusion(P, n, 32, " + named +
                         ");"
                         "Ci = told(o + comp(e, 0), 1, o > .01 && o < .99 ? 1 : 0);"),
                1e-5f, 4000);
    expect_told(c.render(asks + "color k = indirectdiffuse(P, n, 32, " + named +
                         ", \"occlusion\", o);"
                         "color off = k - e; Ci = told(o + comp(e, 0) + off . off, 1, o > .01 ? 1 : 0);"),
                1e-5f, 4000);
    // Elements of arrays are set, too; and what is asked twice is the same.
    expect_told(c.render(asks + "float p[2] = {-1, -1}; color k = indirectdiffuse(P, n, 32, " + named +
                         ", \"occlusion\", p[1]); Ci = told(p[1] + comp(e, 0) + p[0], 0, 1);"),
                1e-5f, 64 * 64);
}

/// The mean direction of what is open: of half a sky, by the cosine, it leans by atan(2 / pi).
TEST_F(RaySky, TheOpenWayLeansFromWhatHides) {
    c.things = "ShadingRate 50 Polygon \"P\" [-.0001 -5 9 -.0001 5 9 -.0001 5 -5 -.0001 -5 -5] ";
    const Image image = c.render(
        kFloor +
        "vector d = 0; float o = occlusion(point(0, 0, 4.9) + 0 * P, n, 256, \"environmentdir\", d, \"bias\", 0);"
        "Ci = color(xcomp(d), -zcomp(d), o);");
    EXPECT_NEAR(mean_red(image), std::sin(std::atan(2 / M_PI)), 5e-3);
    EXPECT_NEAR(mean_found(image), std::cos(std::atan(2 / M_PI)), 5e-3);
    const Image open = c.render(
        kFloor +
        "vector d = 0; color k = indirectdiffuse(point(30, 0, 4.9) + 0 * P, -n, 256, \"environmentdir\", d,"
        " \"maxdist\", 20); Ci = color(xcomp(d), zcomp(d), comp(k, 0));");
    EXPECT_NEAR(mean_found(open), 1, 1e-3);
}

/// White things under a white sky are white. Of what a floor sees the sphere is up to 1/16, and the sphere
/// sees no more than half of floor: with three bounces less than 1 / (16 * 2 * 16) is still on its way.
/// (Where a sphere's micropolygons are met at its rim, its normal may look away from the ray: it is the
/// normal that points outside which counts.)
TEST_F(RaySky, AWhiteFurnaceIsWhite) {
    const std::string bounces = "Attribute \"trace\" \"int maxdiffusedepth\" [3] ";
    const std::string outside = "vector(P - point(0, 0, 3))", up = "vector(0, 0, -1)";
    c.things = bounces + "Surface \"white\" " + sphere("0 0 3", ".5");
    c.asker = bounces + kSeen;
    // By a call, and by a block in which what misses adds the sky.
    const auto by_call = [](const std::string& way) {
        return "Ci = indirectdiffuse(P, " + way + ", 16, \"environmentmap\", \"white.exr\");";
    };
    const auto by_block = [](const std::string& way) {
        return "color k = 0, sum = 0; gather(\"illuminance\", P, " + way +
               ", PI / 2, 16, \"distribution\", \"cosine\", \"surface:Ci\", k) sum += k; else sum += 1;"
               "Ci = sum / 16;";
    };
    for (const auto& white : std::vector<std::function<std::string(const std::string&)>>{by_call, by_block}) {
        c.shaders["white"] = "surface white() { Oi = 1; " + white(outside) + " }";
        for (const Pixel& p : pixels(c.render(white(up)))) {
            ASSERT_GT(p.red, 1 - 2.0 / 512);
            ASSERT_LT(p.red, 1 + 1e-5);
        }
    }
}

}  // namespace
}  // namespace trapeze::testing
