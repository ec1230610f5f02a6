/// Occlusion next to closed forms, and that surfaces neither hide themselves nor leak.
#include <gtest/gtest.h>

#include "tests/rays/rays_harness.h"

namespace trapeze::testing {
namespace {

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

/// On both sides of a wall from z = 2 to the floor at z = 5, up to the crease, where a half is hidden: of a
/// wall of height h, as far to both sides as b, a point at a distance d sees
/// (atan(b / d) - d / sqrt(d^2 + h^2) atan(b / sqrt(d^2 + h^2))) / pi.
TEST(RayOcclusion, OfACreaseIsThatOfItsWall) {
    for (const bool together : {false, true}) {
        Case c;
        c.things = "Patch \"bilinear\" \"P\" [0 8 5 0 8 2 0 -8 5 0 -8 2] ";
        if (together) c.things = "PointsPolygons [4] [0 1 2 3] \"P\" [0 -8 5 0 -8 2 0 8 2 0 8 5] ";
        c.asks =
            "Patch \"bilinear\" \"P\" [-1.2 1.2 5 0 1.2 5 -1.2 -1.2 5 0 -1.2 5] "
            "Patch \"bilinear\" \"P\" [0 1.2 5 1.2 1.2 5 0 -1.2 5 1.2 -1.2 5] ";
        const Image image = c.render(
            "float d = max(abs(xcomp(P)), 1e-4), s = sqrt(d * d + 9), b = 8 - ycomp(P), c = 8 + ycomp(P);"
            "float expected = (atan(b / d) + atan(c / d) - d / s * (atan(b / s) + atan(c / s))) / (2 * PI);"
            "Ci = color(occlusion(P, normal(0, 0, -1), 256), expected, 1);");
        double square = 0;
        int creased = 0;
        for (const Pixel& p : pixels(image)) {
            ASSERT_NEAR(p.red, p.green, .03f);
            square += std::pow(static_cast<double>(p.red - p.green), 2) / 4096, creased += p.green > .499f;
        }
        EXPECT_LT(std::sqrt(square), .007);
        EXPECT_GE(creased, 64);
    }
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
                             "near += float trace(P, w) < 1e5 ? 1 : 0; } Ci = told(near, 26, 1);"),
                    0, 64 * 64);
    }
}

/// Away from the middle of the thing.
const std::string kOutOfTheMiddle = "normalize(N) * sign(N . (P - point \"middle\" (0, 0, 0)))";

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
                         body + ", 0, " + (normal == kOutOfTheMiddle ? "1" : "facing > .02 ? 1 : 0") + ");");
            SCOPED_TRACE(thing + rate + view + place);
            expect_told(image, 0, 300);
        }
}

TEST(RaySelfHits, ASphereHasNone) {
    expect_open("Sphere 1 -1 1 360", kOutOfTheMiddle);
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
        kOutOfTheMiddle);
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

/// The inside of a sphere: chords are 2 r cos(theta) long, of micropolygons less by their sagitta, (h
/// sqrt 2)^2 / 8 r for sides h, at either end, divided by the cosine. What is met is not the surface
/// that the ray has left.
TEST(RaySelfHits, TheInsideOfASphereHasNone) {
    for (const char* const place : {"Translate 0 0 5 ", "Translate 0 0 5 Rotate 50 1 2 3 "})
        for (const float tilt : {.07f, .1f, .2f, .5f, 1.0f}) {
            Case c;
            c.asker = kSeen + place + "CoordinateSystem \"middle\" ";
            c.asks = "AttributeBegin Sphere 1 -1 1 360 AttributeEnd ";
            SCOPED_TRACE(place + std::to_string(tilt));
            // h = 1/32, foreshortened to less than 1/10 where it counts; tilts from the tangent plane.
            expect_near(
                c.render("normal n = normalize(P - point \"middle\" (0, 0, 0));"
                         "vector along = normalize(n ^ vector(.3, .5, .7));"
                         "along = rotate(along, 2 * PI * random(), point(0, 0, 0), point(0, 0, 0) + n);"
                         "float tilt = " +
                         std::to_string(tilt) +
                         ", found = trace(P, cos(tilt) * along - sin(tilt) * n);"
                         "float most = 2 * sin(tilt);"
                         "Ci = color(found, 2 * sin(tilt), 1);"),
                1 / 1024.0f / tilt, 2500);
        }
}

/// A quarter of a million rays from inside of closed things; all hit something.
TEST(RayLeaks, ClosedThingsHaveNone) {
    const std::string cube = "[4 4 4 4 4 4] [0 1 3 2 5 4 6 7 1 0 4 5 2 3 7 6 0 2 6 4 3 1 5 7] ";
    const std::string corners = "\"P\" [-1 -1 -1 1 -1 -1 -1 1 -1 1 1 -1 -1 -1 1 1 -1 1 -1 1 1 1 1 1] ";
    const std::pair<std::string, std::string> things[] = {
        {"Sphere 1 -1 1 360 ", "point(0, 0, 5)"},
        {"Displacement \"bumps\" Attribute \"displacementbound\" \"float sphere\" [.3] "
         "Attribute \"trace\" \"int displacements\" [1] Sphere 1 -1 1 360 ",
         "point(0, 0, 5)"},
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
            c.shaders["bumps"] =
                "displacement bumps() { P += .2 * (noise(4 * transform(\"object\", P)) - .5) * normalize(N);"
                "N = calculatenormal(P); }";
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
                         "if (float trace(o + .1 * w, w) > 1e20) leaks += 1; } Ci = told(leaks, 0, 1);");
            SCOPED_TRACE(thing + rate);
            expect_told(image, 0, 64 * 64);
        }
    }
}

// What is seen by whom.

}  // namespace
}  // namespace trapeze::testing
