/// Which rays see what, what calls are given, and scenes with all of it.
#include <gtest/gtest.h>

#include "tests/rays/rays_harness.h"

namespace trapeze::testing {
namespace {

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

/// "blur" is the half angle where no "samplecone" is given, up to a right angle.
TEST(RayArguments, BlurSpreadsRays) {
    Case c;
    c.things = "Surface \"constant\" Translate 0 0 3 Disk 0 .302270 360 ";  // 2 tan .15
    const double share = (1 - std::cos(0.15)) / (1 - std::cos(0.3));
    const std::string from = "point o = point(0, 0, 5) + 0 * P; vector w = vector(0, 0, -5); ";
    const std::string given = ", \"samples\", 64, \"blur\", .3";
    for (const std::string call : {"color trace(o, w", "1 - transmission(o, o + w"}) {
        EXPECT_NEAR(mean_red(c.render(from + "Ci = " + call + given + ");")), share, 2e-3) << call;
        EXPECT_EQ(mean_red(c.render(from + "Ci = " + call + given + ", \"samplecone\", 0);")), 1) << call;
        EXPECT_NEAR(mean_red(c.render(from + "Ci = " + call + given + ", \"samplecone\", .2);")),
                    (1 - std::cos(0.15)) / (1 - std::cos(0.2)), 2e-3);
    }
    c.things = "Surface \"constant\" " + wall("3");
    // Of P, a point in the middle of a vertex' sky: the wall's edges are seen under 3 in 2.
    const std::string seen = "Ci = environment(\"raytrace\", vector(0, 0, -1) + 0 * s, \"samples\", 64, ";
    EXPECT_EQ(mean_red(c.render(seen + "\"blur\", .5);")), 1);
    EXPECT_LT(mean_red(c.render(seen + "\"blur\", 1.5);")), 0.99);
    c.things = "Surface \"constant\" " + wall("7");  // behind
    EXPECT_EQ(mean_red(c.render(seen + "\"blur\", 3);")), 0);
    EXPECT_GT(mean_red(c.render(seen + "\"samplecone\", 3);")), 0.2);
}

TEST(RayArguments, MaxdistEndsRays) {
    Case c;
    c.things = "Surface \"constant\" " + wall("3");
    const std::string w = "vector w = vector(0, 0, -4); ";
    for (const auto& [most, hits] :
         {std::pair("1.9", "0"), {"2.1", "1"}, {"1e30", "1"}, {"1.9 + 0 * s", "0"}}) {
        const auto told = [&, most = most, hits = hits](const std::string& value) {
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
    // Colours likewise, and what of them is told to be hidden.
    c.things = "Surface \"constant\" " + wall("3");
    const std::string given = "P, normal(0, 0, -1), 16, \"coneangle\", .01, \"falloff\", 1";
    expect_told(c.render("color k = indirectdiffuse(" + given + "); Ci = told(comp(k, 1), exp(-2), 1);"),
                1e-4f, 64 * 64);
    expect_told(c.render("float hides = 0; color k = indirectdiffuse(" + given +
                         ", \"falloffmode\", 1, \"maxdist\", 8, \"occlusion\", hides);"
                         "Ci = told(comp(k, 1) + hides, 1.5, 1);"),
                1e-4f, 64 * 64);
}

TEST(RayArguments, ExcludesubsetLeavesGroupsOut) {
    Case c;
    const auto member = [](const std::string& groups) {
        return "Attribute \"grouping\" \"string membership\" [\"" + groups + "\"] ";
    };
    c.things = "Surface \"constant\" " + member("near") + wall("4") + member("near, both") + wall("3") +
               member("far, both") + wall("2") + member("") + wall("1");
    const auto expect = [&](const std::string& arguments, const std::string& distance) {
        SCOPED_TRACE(arguments);
        const std::string w = "vector w = vector(0, 0, -1); ", given = ", " + arguments + ")";
        expect_told(c.render(w + "Ci = told(float trace(P, w" + given + ", " + distance + ", 1);"), 1e-5f,
                    64 * 64);
        expect_told(c.render(w + "float way = 1e30; gather(\"\", P, w, 0, 1, \"ray:length\", way" + given +
                             " { } Ci = told(way, " + distance + ", 1);"),
                    1e-5f, 64 * 64);
    };
    for (const auto& [excluded, distance] : {std::pair("near", "3"),
                                             {"both", "1"},
                                             {"near,both", "4"},
                                             {"-near", "1"},
                                             {"-both", "2"},
                                             {"none", "1"},
                                             {" ,", "1"},
                                             {"", "1"}})
        expect("\"excludesubset\", \"" + std::string(excluded) + "\"", distance);
    expect("\"subset\", \"both\", \"excludesubset\", \"near\"", "3");
    expect("\"excludesubset\", \"both\", \"subset\", \"-near\"", "4");
    expect("\"subset\", \"far\", \"excludesubset\", \"far\"", "1e30");
}

TEST(RayArguments, MinsamplesIsTheLeastNumberOfRays) {
    Case c;
    c.things = wall("3");
    for (const auto& [least, count] : {std::pair("9", "9"), {"3", "4"}, {"0", "4"}})
        expect_told(c.render("float n = 0; gather(\"samplepattern\", P, vector(0, 0, -1), .1, 4, "
                             "\"minsamples\", " +
                             std::string(least) + ") { } else { n += 1; } Ci = told(n, " + count + ", 1);"),
                    0, 64 * 64);
}

/// The mean over the rays that hit, also those that go on behind.
TEST(RayArguments, HitdistIsHowFarTheHitsAre) {
    Case c;
    c.things = "Surface \"constant\" Opacity .5 .5 .5 " + wall("3") + wall("1");
    const std::string given = "(P, way, 16, \"coneangle\", 1e-4, \"hitdist\", far)";
    for (const std::string call : {"occlusion", "indirectdiffuse"})
        for (const auto& [way, distance] : {std::pair("-1", "2"), {"1", "1e30"}})
            expect_told(c.render("float far = -1; vector way = vector(0, 0, " + std::string(way) +
                                 "); color k = " + call + given + "; Ci = told(far, " + distance + ", 1);"),
                        1e-5f, 64 * 64);
    // Half of a wall is nearer: what is missed does not count.
    c.things = "Surface \"constant\" Patch \"bilinear\" \"P\" [0 6 3 6 6 3 0 -6 3 6 -6 3] ";
    expect_told(c.render("float far = -1, o = occlusion(P, vector(0, 0, -1), 64, \"coneangle\", .1, "
                         "\"hitdist\", far);"
                         "Ci = told(o > 0 ? far : 2, 2, far > 0 && far < 1e20 ? 1 : 0);"),
                0.011f, 1500);
}

/// What 3Delight's trace() sets: what is left of the light, and how far the first surface is. Behind two
/// surfaces that let half and a quarter through an eighth is left.
TEST(RayArguments, TraceSetsWhatIsLeftOfTheLight) {
    Case c;
    c.things = "Surface \"constant\" Opacity .75 .5 .25 " + wall("3") + "Opacity .5 .5 .5 " + wall("1");
    const std::string w = "vector w = vector(0, 0, -1); color left = -1; float far = -1, some = -1; ";
    const auto told = [&](const std::string& call, const std::string& found, const std::string& expected) {
        SCOPED_TRACE(call + found);
        expect_told(c.render(w + call + " Ci = told(" + found + ", " + expected + ", 1);"), 1e-6f, 64 * 64);
    };
    for (const std::string kind : {"color k = color trace(", "float k = float trace("}) {
        const std::string named = kind + "P, w, \"transmission\", left);";
        told(named, "comp(left, 0)", ".125");
        told(named, "comp(left, 2)", ".375");
        told(kind + "P, w, far, \"transmission\", some);", "some", ".25");
        told(kind + "P, w, far, \"transmission\", some);", "far", "2");
        told(kind + "P, w, \"hitdist\", far, \"maxdist\", 3);", "far", "2");
        // Nothing is there; and a ray that leads nowhere.
        told(kind + "P, -w, far, \"transmission\", left);", "comp(left, 1)", "1");
        told(kind + "P, -w, far);", "far", "1e30");
        told(kind + "P, 0 * w, far, \"transmission\", left);", "comp(left, 1)", "1");
        told(kind + "P, w, far, \"transmission\", left, \"maxdist\", 3);", "comp(left, 0)", ".25");
        // Of the vertices that ask.
        told("left = .25; if (xcomp(P) > 0) { " + kind + "P, w, far, \"transmission\", left); }",
             "comp(left, 0)", "xcomp(P) > 0 ? .125 : .25");
    }
    told("far = trace(P, w, some, \"transmission\", left);", "far - some", "0");
    // The mean of rays, of which half miss.
    c.things = "Surface \"constant\" Patch \"bilinear\" \"P\" [0 6 3 6 6 3 0 -6 3 6 -6 3] ";
    const Image image =
        c.render(w +
                 "color k = trace(P, w, \"samplecone\", 1, \"samples\", 64, \"transmission\", "
                 "left); Ci = told(comp(left, 1), 1 - comp(k, 1), 1);");
    expect_told(image, 1e-6f, 64 * 64);
}

/// What is deeper than rays go is hit, and black.
TEST(RayArguments, TraceSetsWhatIsLeftWhereRaysAreTooDeep) {
    Case c;
    c.things = "Surface \"constant\" Opacity .5 .5 .5 " + wall("3");
    c.asker = "Attribute \"trace\" \"int maxspeculardepth\" 0 ";
    const std::string call =
        "float far = -1; color left = -1, k = trace(P, vector(0, 0, way), far, \"transmission\", left); ";
    expect_told(c.render("float way = -1; " + call + "Ci = told(comp(left, 0), .5, 1);"), 1e-6f, 64 * 64);
    expect_told(c.render("float way = -1; " + call + "Ci = told(far + comp(k, 0), 2, 1);"), 1e-5f, 64 * 64);
    expect_told(c.render("float way = 1; " + call + "Ci = told(comp(left, 0), 1, 1);"), 0, 64 * 64);
}

TEST(RayArguments, AbsurdOnesDoNoHarm) {
    Case c;
    c.things = "Surface \"constant\" " + wall("3");
    const std::string odd =
        "float nan = 1e30 * (2 + s); nan *= nan; nan -= nan; vector w = vector(0, 0, -1);";
    for (const std::string call :
         {"trace(P, w", "transmission(P, point(0, 0, 0)", "occlusion(P, w, 2", "indirectdiffuse(P, w, 2"}) {
        const bool over_sky = call.ends_with("2");
        for (const char* value : {"-1", "0", "nan", "1e-30", "-1e30"})
            for (const char* name : {"samples", over_sky ? "coneangle" : "samplecone", "maxdist", "bias",
                                     over_sky ? "falloff" : "blur", "maxerror", "minsamples"}) {
                const std::string more = std::string(", \"") + name + "\", " + value + ");";
                for (const Pixel& p : pixels(c.render(odd + "color k = " + call + more + "Ci = k;"))) {
                    ASSERT_GE(p.red, 0) << call << more;
                    ASSERT_LE(p.red, 1) << call << more;
                }
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
