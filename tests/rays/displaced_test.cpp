/// Rays that meet displaced surfaces, next to the closed forms of what these have become.
#include <gtest/gtest.h>

#include "tests/rays/ray_world_harness.h"

namespace trapeze::testing {
namespace {

/// Red is the part of so many rays that is hidden, green what is to be, each pixel within five deviations of
/// independent rays. Micropolygons lie up to 1e-3 of a ball's radius inside: the area falls by less than
/// 2e-3.
void expect_hidden(const Image& image, int samples) {
    double bias = 0, independent = 0;
    for (const Pixel& p : pixels(image)) {
        const double expected = static_cast<double>(p.green), error = static_cast<double>(p.red) - expected;
        ASSERT_LT(std::abs(error), 5 * std::sqrt(expected * (1 - expected) / samples));
        independent += expected * (1 - expected) / samples / 4096, bias += error / 4096;
    }
    EXPECT_NEAR(bias, 0, 4 * std::sqrt(independent / 4096) + 2e-4);
}

/// The form factor (r / d)^2 cos(theta) is that of the larger ball.
TEST(RayDisplaced, OcclusionOfABallIsItsFormFactor) {
    Case c;
    // A ball whose radius is blown up from .25 to .5.
    c.shaders["blow"] =
        "displacement blow() { vector out = normalize(vector(P - point(0, 0, 3)));"
        "  P += .25 * out; N = normal(out); }";
    c.things =
        "Attribute \"trace\" \"int displacements\" [1] Attribute \"displacementbound\" \"sphere\" [.3] "
        "ShadingRate .25 Displacement \"blow\" " +
        sphere("0 0 3", ".25");
    constexpr int kSamples = 64;
    const Image image = c.render(
        "vector m = point(0, 0, 3) - P; float d2 = m . m; float expected = .25 / d2 * (2 / sqrt(d2));"
        "Ci = color(occlusion(P, normal(0, 0, -1), " +
        std::to_string(kSamples) + "), expected, 1);");
    expect_hidden(image, kSamples);
}

/// One that grows in deforming from .15 to .25, and is blown up by .15 at all times: for the camera and for
/// rays that come at all times.
TEST(RayDisplaced, ABallThatGrowsIsDisplacedAtAllTimes) {
    Case c;
    c.options = "Shutter 0 1 ";
    c.asker = "Attribute \"trace\" \"int samplemotion\" 1 ";
    c.shaders["blow"] =
        "displacement blow() { vector out = normalize(vector(P - point(0, 0, 3)));"
        "  P += .15 * out; N = normal(out); }";
    c.things =
        "Attribute \"trace\" \"int displacements\" [1] Attribute \"displacementbound\" \"sphere\" [.2] "
        "ShadingRate .25 Displacement \"blow\" Translate 0 0 3 "
        "MotionBegin [0 1] Sphere .15 -.15 .15 360 Sphere .25 -.25 .25 360 MotionEnd ";
    constexpr int kSamples = 64;
    // The mean of the radius' square is (.3 * .3 + .3 * .4 + .4 * .4) / 3.
    const Image image = c.render(
        "vector m = point(0, 0, 3) - P; float d2 = m . m; float expected = .37 / 3 / d2 * (2 / sqrt(d2));"
        "Ci = color(occlusion(P, normal(0, 0, -1), " +
        std::to_string(kSamples) + "), expected, 1);");
    expect_hidden(image, kSamples);
    Case seen = c;
    seen.options += "PixelSamples 8 8 ";
    seen.asks = "Surface \"constant\" " + c.things;
    seen.things.clear();
    double alpha = 0;
    for (const Pixel& p : pixels(seen.render("Ci = 0;"))) alpha += static_cast<double>(p.alpha) / 4096;
    EXPECT_NEAR(alpha, .37 / 3 * M_PI / 4, 2e-4);
}

/// What shaders find at a hit is where the ray has met the displaced surface, not where that was before: P is
/// on the ray, and I leads along it. So it is for what the hit's shader asks in turn.
TEST(RayDisplaced, HitsAreSeenWhereTheyHaveBeenMet) {
    for (const std::string tells : {"vtransform(\"world\", I)", "transform(\"world\", P) - from"}) {
        Case c;
        c.shaders["lift"] =
            "displacement lift() { P += vector(0, .3 * xcomp(P), 1); N = calculatenormal(P); }";
        c.shaders["tells"] = "surface tells() { vector from = point(.2, .1, 5); vector w = " + tells +
                             "; Ci = color(xcomp(w), ycomp(w), zcomp(w)) / length(w) + 1; Oi = 1; }";
        c.things =
            "Attribute \"trace\" \"int displacements\" [1] Attribute \"displacementbound\" \"sphere\" [2] "
            "Displacement \"lift\" Surface \"tells\" " +
            wall("2");
        expect_told(c.render("vector d = normalize(vector(xcomp(P), ycomp(P), -1));"
                             "color seen = trace(point(.2, .1, 5), d) - 1;"
                             "Ci = told(comp(seen, 0) + 2 * comp(seen, 1), xcomp(d) + 2 * ycomp(d), 1);"),
                    1e-5f, 64 * 64);
    }
}

/// The penumbra of a disk light behind an edge that a displacement has lifted to where it is looked for: as
/// in area_lights_test, a disk of radius 3, 100 away, and an edge at z = -10.
TEST(RayDisplaced, ThePenumbraIsThatOfTheLiftedEdge) {
    Case c;
    c.may_say = "ris";
    c.asker =
        "AttributeBegin Translate 0 0 -95 Scale 6 6 1 Light \"PxrDiskLight\" \"l\" \"int fixedSampleCount\" [64] "
        "AttributeEnd ";
    c.shaders["lift"] = "displacement lift() { P += vector(1, 0, -2); N = calculatenormal(P); }";
    c.things =
        "Attribute \"trace\" \"int displacements\" [1] Attribute \"displacementbound\" \"sphere\" [2.5] "
        "Displacement \"lift\" Patch \"bilinear\" \"P\" [-4 3 -8 -1 3 -8 -4 -3 -8 -1 -3 -8] ";
    const Image image = c.render(
        "float t = clamp(-xcomp(P) * 85 / 15 / 3, -1, 1); float shown = (acos(t) - t * sqrt(1 - t * t)) / PI;"
        "Ci = color(comp(diffuse(normal(0, 0, -1)), 0) * 10009 / 9, shown, 1);");
    double error = 0;
    for (const Pixel& p : pixels(image)) {
        ASSERT_NEAR(p.red, p.green, 0.1f);
        error += static_cast<double>(p.red - p.green) / 4096;
    }
    EXPECT_NEAR(error, 0, 0.003);
}

/// Moving and displaced at once: the ball goes by while the shutter is open, and hides the mean of its form
/// factors.
TEST(RayDisplaced, OcclusionOfABallThatMovesIsItsMeanOverTheShutter) {
    Case c;
    c.options = "Shutter 0 1 ";
    c.asker = "Attribute \"trace\" \"int samplemotion\" [1] ";
    c.shaders["blow"] =
        "displacement blow() { vector out = vector(transform(\"object\", P)); P += out; N = normal(out); }";
    c.things =
        "Attribute \"trace\" \"int displacements\" [1] Attribute \"displacementbound\" \"sphere\" [.3] "
        "ShadingRate .25 Displacement \"blow\" MotionBegin [0 1] Translate -.8 .1 3 Translate .8 .1 2.5 MotionEnd "
        "Sphere .25 -.25 .25 360 ";
    constexpr int kSamples = 256;
    const Image image = c.render(
        "float expected = 0, i; for (i = .5; i < 64; i += 1) {"
        "  vector m = point(-.8 + 1.6 * i / 64, .1, 3 - .5 * i / 64) - P;"
        "  expected += .25 / (m . m) * -zcomp(m) / length(m) / 64; }"
        "Ci = color(occlusion(P, normal(0, 0, -1), " +
        std::to_string(kSamples) + "), expected, 1);");
    expect_hidden(image, kSamples);
}

/// Likewise the lifted edge, which goes 1 to the right.
TEST(RayDisplaced, ThePenumbraOfALiftedEdgeThatMovesIsItsMeanOverTheShutter) {
    Case c;
    c.may_say = "ris";
    c.options = "Shutter 0 1 ";
    c.asker =
        "AttributeBegin Translate 0 0 -95 Scale 6 6 1 Light \"PxrDiskLight\" \"l\" \"int fixedSampleCount\" "
        "[256] AttributeEnd Attribute \"trace\" \"int samplemotion\" [1] ";
    c.shaders["lift"] = "displacement lift() { P += vector(1, 0, -2); N = calculatenormal(P); }";
    c.things =
        "Attribute \"trace\" \"int displacements\" [1] Attribute \"displacementbound\" \"sphere\" [2.5] "
        "MotionBegin [0 1] Translate -.5 0 0 Translate .5 0 0 MotionEnd "
        "Displacement \"lift\" Patch \"bilinear\" \"P\" [-4 3 -8 -1 3 -8 -4 -3 -8 -1 -3 -8] ";
    expect_moving_penumbra(c);
}

/// So much of a disk of radius 3, 1000 away, is hidden by a ball of radius .6, 150 away: from a point its
/// outline falls on the disk as a circle of radius 4 (it is 1e-4 longer than wide at most). `apart` is how
/// far its middle is from the disk's; the formula is that of two circles' common part.
const std::string kHiddenDisk =
    "float hidden(float apart) {"
    "  float a = (apart * apart + 9 - 16) / (2 * apart), b = apart - a;"
    "  float common = 9 * acos(clamp(a / 3, -1, 1)) + 16 * acos(clamp(b / 4, -1, 1))"
    "    - apart * sqrt(max(9 - a * a, 0));"
    "  return apart < 1.0001 ? 1 : (apart > 7 ? 0 : common / (9 * PI)); } ";
const std::string kDiskOfHiddenDisk =
    "AttributeBegin Translate 0 0 -995 Scale 6 6 1 Light \"PxrDiskLight\" \"l\" \"int fixedSampleCount\" "
    "[256] AttributeEnd ";
/// What is found, as a part of what the disk gives where nothing is in the way; what is to be.
const std::string kLitByHiddenDisk =
    "Ci = color(comp(diffuse(normal(0, 0, -1)), 0) * 1000009 / 9, 1 - expected, 1);";

/// Red is the part of the disk that is lit, by 256 samples, green what is to be: each pixel within five
/// deviations of independent ones, or a sample, and all within four of their mean. Micropolygons lie up to
/// 1e-3 of the ball's radius inside, which is up to 2e-3 of what is hidden.
void expect_hidden_disk(const Image& image) {
    double error = 0, independent = 0, dark = 0, bright = 0;
    for (const Pixel& p : pixels(image)) {
        const double shown = static_cast<double>(p.green), off = static_cast<double>(p.red) - shown;
        ASSERT_LT(std::abs(off), 5 * std::sqrt(shown * (1 - shown) / 256) + 1.0 / 256 + 2e-3);
        independent += shown * (1 - shown) / 256, error += off / 4096;
        dark += p.green < 0.25f;
        bright += p.green > 0.95f;
    }
    EXPECT_NEAR(error, 0, 4 * std::sqrt(independent) / 4096 + 1e-3);
    EXPECT_GT(dark, 50);
    EXPECT_GT(bright, 100);
}

Case behind_blown_ball(const std::string& moves) {
    Case c;
    c.may_say = "ris";
    c.functions = kHiddenDisk;
    c.shaders["blow"] = "displacement blow() { P += .3 * normalize(N); N = calculatenormal(P); }";
    c.asker = kDiskOfHiddenDisk;
    c.things =
        "Attribute \"trace\" \"int displacements\" [1] Attribute \"displacementbound\" \"sphere\" [.35] "
        "ShadingRate .25 Displacement \"blow\" " +
        moves + "Sphere .3 -.3 .3 360 ";
    return c;
}

TEST(RayDisplaced, ThePenumbraOfABallIsThatOfTheBlownUpOne) {
    Case c = behind_blown_ball("Translate 0 0 -145 ");
    expect_hidden_disk(
        c.render("float x = xcomp(P), y = ycomp(P);"
                 "float expected = hidden(85 / 15 * sqrt(x * x + y * y));" +
                 kLitByHiddenDisk));
}

/// By .4 to the right, while it is looked at: its outline on the disk goes by 100 / 15 of that.
TEST(RayDisplaced, ThePenumbraOfABallThatMovesIsItsMeanOverTheShutter) {
    Case c = behind_blown_ball("MotionBegin [0 1] Translate -.2 0 -145 Translate .2 .1 -145 MotionEnd ");
    c.options = "Shutter 0 1 ";
    c.asker += "Attribute \"trace\" \"int samplemotion\" [1] ";
    expect_hidden_disk(c.render(
        "float x = xcomp(P), y = ycomp(P), expected = 0, i; for (i = .5; i < 64; i += 1) {"
        "  float dx = (100 * (.4 * i / 64 - .2) - 85 * x) / 15, dy = (100 * .1 * i / 64 - 85 * y) / 15;"
        "  expected += hidden(sqrt(dx * dx + dy * dy)) / 64; }" +
        kLitByHiddenDisk));
}

// Closed things.

/// A cube with creases and a corner that grows, leans, turns and goes aside while the shutter is open, with
/// bumps of up to .1. All the time it holds a ball of radius .65 about (0, 0, 5): a cube's limit surface is
/// no nearer than .83 to its middle, nothing is pushed inwards by more than .01, and it goes .05 to either
/// side.
std::string bumpy_mesh() {
    const std::string cube =
        "SubdivisionMesh \"catmull-clark\" [4 4 4 4 4 4] [0 1 3 2 5 4 6 7 1 0 4 5 2 3 7 6 0 2 6 4 3 1 5 7] "
        "[\"crease\" \"crease\" \"corner\"] [5 1 3 1 1 1] [0 1 3 2 0 5 7 6 4] [2.5 1.2 2] ";
    return "Displacement \"bumps\" Attribute \"displacementbound\" \"float sphere\" [.15] "
           "Attribute \"trace\" \"int displacements\" [1] "
           "MotionBegin [0 1] Translate -.05 0 5 Translate .05 0 5 MotionEnd "
           "MotionBegin [0 1] Rotate 0 1 2 3 Rotate 90 1 2 3 MotionEnd MotionBegin [0 1] " +
           cube + "\"P\" [-1 -1 -1 1 -1 -1 -1 1 -1 1 1 -1 -1 -1 1 1 -1 1 -1 1 1 1 1 1] " + cube +
           "\"P\" [-1.7 -1.2 -1.1 1.1 -1.2 -1.1 -1.7 1.2 -1.1 1.1 1.2 -1.1 "
           "-1.1 -1.2 1.1 1.7 -1.2 1.1 -1.1 1.2 1.1 2.1 1.6 1.5] MotionEnd ";
}

/// Half a million rays at all times from the ball, half of them nearly along its surface.
const std::string kFromTheBall =
    "for (i = 0; i < 32; i += 1) {"
    "  vector a = way(), b = way(); vector along = a ^ b; point p = o + .6 * pow(random(), 1 / 3) * a;"
    "  leaks += lost(p, b) + lost(p, along); p = o + .6 * a;"
    "  leaks += lost(p, along + (random() - .5) / 10 * a) + lost(p, along + (random() - .5) / 100 * a); }";
/// As many as the shutter opens: from the middle, and from all places up to close to what that finds, into
/// all directions and nearly along the surface there. The first ones tell how far the finest geometry is.
const std::string kFromNearTheSurface =
    "for (i = 0; i < 32; i += 1) {"
    "  vector a = way(); float far = 1e30; gather(\"\", o, a, 0, 1, \"ray:length\", far, \"bias\", 0) { }"
    "  if (far > 1e20) leaks += 1; else {"
    "  vector b = way(); leaks += lost(o + .97 * sqrt(random()) * far * a, b) +"
    "  lost(o + .97 * far * a, way()) + lost(o + .97 * far * a, b - .99 * (b . a) * a); } }";

/// Within the mesh asks a square, of each pixel; "way()" is a direction at random. With levels it is
/// 64 x 64 pixels of a larger picture, for which there are more of them.
Case within_bumpy_mesh(bool levels, bool in_time) {
    Case c;
    c.options = "Shutter 0 1 ";
    if (levels)
        c.options += "Option \"trace\" \"int levels\" 4 Format 256 256 1 CropWindow .375 .625 .375 .625 ";
    if (in_time) c.asker = "Attribute \"trace\" \"int samplemotion\" 1 ";
    c.asks = levels ? "Patch \"bilinear\" \"P\" [-.26 .26 5 .26 .26 5 -.26 -.26 5 .26 -.26 5] "
                    : "Patch \"bilinear\" \"P\" [-1.02 1.02 5 1.02 1.02 5 -1.02 -1.02 5 1.02 -1.02 5] ";
    c.shaders["bumps"] =
        "displacement bumps() { P += .2 * (noise(4 * transform(\"object\", P)) - .5) * normalize(N);"
        "N = calculatenormal(P); }";
    c.things = bumpy_mesh();
    c.functions = "vector way() { return normalize(vector(random() - .5, random() - .5, random() - .5)); }";
    return c;
}

/// A million rays with one level of the geometry, and a million with four.
TEST(RayLeaks, ACreasedMeshThatIsDisplacedAndMovesHasNone) {
    for (const bool levels : {false, true})
        for (const bool in_time : {true, false}) {
            Case c = within_bumpy_mesh(levels, in_time);
            c.functions +=
                "float lost(point from; vector w) {"
                "  float far = trace(from, w, \"bias\", 0); return far > 1e20 ? 1 : 0; } ";
            SCOPED_TRACE(std::string(levels ? "levels " : "") + (in_time ? "in time" : ""));
            expect_told(c.render("point o = point(0, 0, 5); float leaks = 0; uniform float i;" +
                                 (in_time ? kFromTheBall : kFromNearTheSurface) + "Ci = told(leaks, 0, 1);"),
                        0, 64 * 64);
        }
}

/// Two million rays to points outside, of which nothing arrives; without the mesh all of them do. With levels
/// they are cones: no others meet coarse geometry.
TEST(RayLeaks, NothingIsTransmittedOutOfAMeshThatIsDisplacedAndMoves) {
    for (const bool levels : {false, true})
        for (const bool in_time : {true, false}) {
            Case c = within_bumpy_mesh(levels, in_time);
            c.functions += std::string(
                               "float lost(point from; vector w) { color open = "
                               "transmission(from, from + 60 * normalize(w), \"bias\", 0") +
                           (levels ? ", \"samplecone\", .3" : "") + "); return comp(open, 0); } ";
            SCOPED_TRACE(std::string(levels ? "levels " : "") + (in_time ? "in time" : ""));
            const std::string begin = "point o = point(0, 0, 5); float leaks = 0; uniform float i;";
            expect_told(
                c.render(begin + (in_time ? kFromTheBall : kFromNearTheSurface) + "Ci = told(leaks, 0, 1);"),
                0, 64 * 64);
            c.things = "";
            expect_told(c.render(begin + kFromTheBall + "Ci = told(leaks, 128, 1);"), 0, 64 * 64);
        }
}

/// Nor is any of the sky seen, of half of it or of all.
TEST(RayLeaks, NoSkyIsSeenFromWithinAMeshThatIsDisplacedAndMoves) {
    for (const bool levels : {false, true})
        for (const bool in_time : {true, false}) {
            Case c = within_bumpy_mesh(levels, in_time);
            SCOPED_TRACE(std::string(levels ? "levels " : "") + (in_time ? "in time" : ""));
            const std::string hidden =
                "point o = point(0, 0, 5), p = o + .6 * pow(random(), 1 / 3) * way(), q = o + .6 * way();"
                "float hidden = occlusion(p, way(), 16, \"bias\", 0) + occlusion(q, way(), 16, \"bias\", 0) +"
                "  occlusion(q, way(), 32, \"bias\", 0, \"distribution\", \"uniform\", \"coneangle\", PI);";
            expect_told(c.render(hidden + "Ci = told(hidden, 3, 1);"), 0, 64 * 64);
            c.things = "";
            expect_told(c.render(hidden + "Ci = told(hidden, 0, 1);"), 0, 64 * 64);
        }
}

/// Lights all around, near and far, do not light a square of the diagonal 1.1 within.
TEST(RayLeaks, LightsDoNotShineIntoAMeshThatIsDisplacedAndMoves) {
    for (const char* shadow : {"transmission(from, Ps)", "transmission(Ps, from, \"samplecone\", .05)",
                               "1 - shadow(\"raytrace\", Ps, \"samples\", 4)"})
        for (const bool in_time : {true, false}) {
            Case c = within_bumpy_mesh(false, in_time);
            SCOPED_TRACE(std::string(shadow) + (in_time ? " in time" : ""));
            c.shaders["shadowed"] = "light shadowed(point from = point(0, 0, 0);) { illuminate(from) Cl = " +
                                    std::string(shadow) + "; }";
            RayNumbers number;
            for (int i = 0; i < 40; ++i) {
                const V3f way = number.in_cube(1).normalized(), at = way * number(4, 30) + V3f(0, 0, 5);
                c.asker += "LightSource \"shadowed\" " + std::to_string(i) + " \"from\" [" +
                           std::to_string(at.x) + ' ' + std::to_string(at.y) + ' ' + std::to_string(at.z) +
                           "] ";
            }
            c.asker += "Translate 0 0 5 Rotate 35 1 1 0 ";
            c.asks = "Patch \"bilinear\" \"P\" [-.39 .39 0 .39 .39 0 -.39 -.39 0 .39 -.39 0] ";
            const std::string arrives = "float light = 0; illuminance(P, N, PI) { light += comp(Cl, 0); }";
            expect_told(c.render(arrives + "Ci = told(light, 0, 1);"), 0, 500);
            c.things = "";
            expect_told(c.render(arrives + "Ci = told(light, 40, 1);"), 0, 500);
        }
}

}  // namespace
}  // namespace trapeze::testing
