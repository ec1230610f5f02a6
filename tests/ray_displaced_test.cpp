/// Rays that meet displaced surfaces, next to the closed forms of what these have become.
#include <gtest/gtest.h>

#include "tests/rays_harness.h"

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

}  // namespace
}  // namespace trapeze::testing
