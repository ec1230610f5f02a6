/// Rays in time: Attribute "trace" "samplemotion" next to closed forms, averaged over the shutter.
#include <gtest/gtest.h>

#include "tests/rays/rays_harness.h"

namespace trapeze::testing {
namespace {

const std::string kInTime = "Attribute \"trace\" \"int samplemotion\" 1 ";
/// A power of the sequence's base: of so many times exactly one is in each of as many parts of the shutter,
/// so that the part of them within a stretch of time is off by less than two of them.
constexpr int kMoments = 81;
constexpr float kOfATime = 2.0f / kMoments;

Case in_time() {
    Case c;
    c.options = "Shutter 0 1 ";
    c.asker = kInTime;
    return c;
}

std::string moves(const std::string& from, const std::string& to, const std::string& thing) {
    return "AttributeBegin MotionBegin [0 1] Translate " + from + " Translate " + to + " MotionEnd " + thing +
           "AttributeEnd ";
}

/// A sheet of the width 1 passes along x: each point is dark for as long as it is behind it.
TEST(RayMotion, AShadowIsAsDarkAsItIsLong) {
    Case c = in_time();
    c.things = moves("-1.5 0 2", ".5 0 2", "Patch \"bilinear\" \"P\" [0 6 0 1 6 0 0 -6 0 1 -6 0] ");
    const std::string expected =
        "float x = xcomp(P); float from = clamp((x + .5) / 2, 0, 1), to = clamp((x + 1.5) / 2, 0, 1); ";
    const std::string times = std::to_string(kMoments);
    expect_near(c.render(expected + "Ci = color(comp(transmission(P, P - vector(0, 0, 9), \"samples\", " +
                         times + "), 0), 1 - (to - from), 1);"),
                kOfATime);
    expect_near(c.render(expected + "Ci = color(occlusion(P, normal(0, 0, -1), " + times +
                         ", \"coneangle\", 1e-4), to - from, 1);"),
                kOfATime + 1e-3f);
    expect_near(c.render(expected + "float sum = 0; gather(\"illuminance\", P, vector(0, 0, -1), 0, " +
                         times + ") { sum += 1; } else { } Ci = color(sum / " + times + ", to - from, 1);"),
                kOfATime);
    // Without the attribute all rays go out as the shutter opens.
    c.asker = "";
    expect_near(
        c.render("float x = xcomp(P); Ci = color(comp(transmission(P, P - vector(0, 0, 9), \"samples\", " +
                 times + "), 0), x > -1.5 && x < -.5 ? 0 : 1, abs(x + .5) < .05 ? 0 : 1);"),
        0);
}

/// From z = 1 to z = 3, seen from z = 5; the mean of N times in N parts is off by half of a part at most.
TEST(RayMotion, ADistanceIsTheMeanOverTheShutter) {
    Case c = in_time();
    c.things = moves("0 0 1", "0 0 3", wall("0"));
    expect_near(c.render("Ci = color(float trace(P, vector(0, 0, -1), \"samples\", " +
                         std::to_string(kMoments) + "), 3, 1);"),
                1.0f / kMoments);
    // On a bent path: keys of 0, 2, 0 have the mean 1.
    c.things =
        "AttributeBegin MotionBegin [0 .5 1] Translate 0 0 1 Translate 0 0 3 Translate 0 0 1 MotionEnd " +
        wall("0") + "AttributeEnd ";
    expect_near(c.render("Ci = color(float trace(P, vector(0, 0, -1), \"samples\", " +
                         std::to_string(kMoments) + "), 3, 1);"),
                2.0f / kMoments);
}

/// Deforming geometry, too: a wall that turns into another one.
TEST(RayMotion, DeformingThingsAreMetAsTheyAreThen) {
    Case c = in_time();
    c.things = "MotionBegin [0 1] " + wall("1") + wall("3") + "MotionEnd ";
    expect_near(c.render("Ci = color(float trace(P, vector(0, 0, -1), \"samples\", " +
                         std::to_string(kMoments) + "), 3, 1);"),
                1.0f / kMoments);
}

/// What moves with the point that asks hides it as if all stood still.
TEST(RayMotion, PointsAskFromWhereTheyAreThen) {
    Case c = in_time();
    const std::string sheet = "Patch \"bilinear\" \"P\" [0 6 3 1 6 3 0 -6 3 1 -6 3] ";
    c.things = moves("0 0 0", ".3 .2 4", sheet);
    c.asker = kInTime + kSeen + "MotionBegin [0 1] Translate 0 0 0 Translate .3 .2 4 MotionEnd ";
    // Towards (1, 0, -2): the sheet, two units nearer, hides what is within -1 .. 0.
    const std::string way = "vector(1, 0, -2)";
    const std::string body =
        "float x = xcomp(P); float hidden = x > -1 && x < 0 ? 1 : 0;"
        "float sure = abs(x) < .05 || abs(x + 1) < .05 ? 0 : 1; ";
    expect_near(c.render(body + "Ci = color(occlusion(P, normal(" + way +
                         "), 16, \"coneangle\", 1e-5), hidden, sure);"),
                0);
    expect_near(c.render(body + "Ci = color(float trace(P, " + way +
                         ", \"samples\", 16) < 1e6 ? 1 : 0, hidden, sure);"),
                0);
}

/// A light stands where it is; the nearer one of a ray's two ends is the one that moves.
TEST(RayMotion, ShadowsOfLightsStartAtEitherEnd) {
    Case c = in_time();
    // The asker comes along z from 5 to 4, a sheet stands at z = 3, the light at the origin.
    c.things = "Patch \"bilinear\" \"P\" [0 6 3 9 6 3 0 -6 3 9 -6 3] ";
    c.asker = kInTime + "MotionBegin [0 1] Translate 0 0 0 Translate 0 0 -1 MotionEnd ";
    const std::string samples = ", \"samples\", " + std::to_string(kMoments) + ")";
    // On the way to (4, 0, 0) from (x, y, z) the ray is at x + (4 - x) (z - 3) / z as it passes the sheet:
    // dark where that is above 0. For x < 0 it is the whole shutter's part with z > 3 (x - 4) / ... solved
    // for z.
    const std::string expected =
        "float x = xcomp(P); float z = 12 / (4 - x);"  // dark from this z on
        "float dark = x >= 0 ? 1 : clamp(5 - z, 0, 1); ";
    for (const char* ends : {"P, point(4, 0, 0)", "point(4, 0, 0), P"})
        expect_near(
            c.render(expected + "Ci = color(comp(transmission(" + ends + samples + ", 0), 1 - dark, 1);"),
            kOfATime);
}

/// A mirror and what it shows move together, past a point that stands still; what the mirror's own rays meet
/// is met at the time at which the mirror was hit.
TEST(RayMotion, BouncesKeepTheirTime) {
    Case c = in_time();
    c.shaders["deep"] =
        "surface deep() { Ci = 1 - occlusion(P, normal(-1, 0, 2), 1, \"coneangle\", 1e-5); Oi = 1; }";
    // The wall moves from z = 1 to 3 and a sheet, one unit in front of it, with it: seen in the wall's own
    // space nothing moves. The sheet is out of the first rays' sight by Attribute "visibility".
    c.things = "Attribute \"visibility\" \"int diffuse\" 0 Surface \"deep\" " +
               moves("0 0 1", "0 0 3", wall("0")) +
               "Attribute \"visibility\" \"int specular\" 0 \"int diffuse\" 1 " +
               moves("0 0 1", "0 0 3", "Patch \"bilinear\" \"P\" [0 6 1 .5 6 1 0 -6 1 .5 -6 1] ");
    // At the height 1 the ray has come half a unit along -x.
    expect_near(
        c.render("float x = xcomp(P); Ci = color(comp(trace(P, vector(0, 0, -1), \"samples\", 16), 0), "
                 "x > .5 && x < 1 ? 0 : 1, abs(x - .5) < .08 || abs(x - 1) < .08 ? 0 : 1);"),
        1e-6f);
}

/// A camera that turns and comes nearer changes nothing of what rays of points see that stand still; nor does
/// it of what goes with it.
TEST(RayMotion, TheCamerasOwnMotionIsNotTheScenes) {
    Case c = in_time();
    c.options +=
        "MotionBegin [0 1] Rotate 0 0 0 1 Rotate 70 0 0 1 MotionEnd MotionBegin [0 1] Translate 0 0 0 Translate .1 "
        "-.2 2 MotionEnd ";
    c.things = "Patch \"bilinear\" \"P\" [0 6 2 1 6 2 0 -6 2 1 -6 2] ";
    const std::string body =
        "float x = xcomp(P); float hidden = x > -1 && x < 0 ? 1 : 0;"
        "float sure = abs(x) < .05 || abs(x + 1) < .05 ? 0 : 1; ";
    const std::string asks = body +
                             "Ci = color(float trace(P, vector(1, 0, -3), \"samples\", 16) < 1e6 ? 1 : 0, "
                             "hidden, sure);";
    c.asks = "Patch \"bilinear\" \"P\" [-2 2 5 2 2 5 -2 -2 5 2 -2 5] ";
    expect_near(c.render(asks), 0);
    // What moves in the world is met as it moves there.
    c.things = moves("0 0 1", "0 0 3", wall("0"));
    expect_near(c.render("Ci = color(float trace(P, vector(0, 0, -1), \"samples\", " +
                         std::to_string(kMoments) + "), 3, 1);"),
                1.0f / kMoments + 1e-4f);
}

/// The mean of what a sphere hides over its way: the form factor, over the shutter.
TEST(RayMotion, OcclusionOfAMovingSphereIsItsMeanFormFactor) {
    Case c = in_time();
    c.things = moves("-1 0 3", "1 0 3", "Sphere .5 -.5 .5 360 ");
    const std::string body =
        "float expected = 0, i; for (i = .5; i < 64; i += 1) {"
        "  vector m = point(i / 32 - 1, 0, 3) - P; float d2 = m . m; expected += .25 / d2 * (2 / sqrt(d2)) / 64; }";
    double before = 1;
    for (const int samples : {16, 64, 256}) {
        const Image image = c.render(body + "Ci = color(occlusion(P, normal(0, 0, -1), " +
                                     std::to_string(samples) + "), expected, 1);");
        double independent = 0, square = 0, bias = 0;
        for (const Pixel& p : pixels(image)) {
            const double expected = static_cast<double>(p.green),
                         error = static_cast<double>(p.red) - expected;
            independent += expected * (1 - expected) / samples / 4096;
            square += error * error / 4096, bias += error / 4096;
        }
        EXPECT_LE(square, independent * 1.05) << samples;
        EXPECT_LE(square, before / 4 * 1.1) << "falls at least as 1 / N";
        EXPECT_NEAR(bias, 0, 4 * std::sqrt(independent / 4096) + 2e-4) << samples;
        before = square;
    }
}

/// Rays from inside of closed things that move, turn and bend; all hit something.
TEST(RayMotion, MovingThingsLetNothingThrough) {
    const std::string cube = "[4 4 4 4 4 4] [0 1 3 2 5 4 6 7 1 0 4 5 2 3 7 6 0 2 6 4 3 1 5 7] ";
    const std::string small = "\"P\" [-1 -1 -1 1 -1 -1 -1 1 -1 1 1 -1 -1 -1 1 1 -1 1 -1 1 1 1 1 1] ";
    const std::string large = "\"P\" [-2 -1 -1 1 -2 -1 -1 1 -2 1 1 -1 -1 -2 1 2 -1 1 -1 1 1 1.5 1 2] ";
    const std::string mesh =
        "SubdivisionMesh \"catmull-clark\" " + cube + "[\"crease\"] [5 1] [0 1 3 2 0] [2.5] ";
    const std::string turns = "MotionBegin [0 1] Rotate 0 1 2 3 Rotate 90 1 2 3 MotionEnd ";
    const std::string bends = "MotionBegin [0 1] " + mesh + small + mesh + large + "MotionEnd ";
    for (const std::string& thing :
         {turns + "Sphere 1 -1 1 360 ", turns + mesh + small, bends, turns + bends})
        for (const char* rate : {".5", "20"}) {
            Case c = in_time();
            c.things = std::string("ShadingRate ") + rate + " Translate 0 0 5 " + thing;
            const Image image = c.render(
                "point o = point(0, 0, 5); float leaks = 0; uniform float i;"
                "for (i = 0; i < 64; i += 1) {"
                "vector w = vector(random() - .5, random() - .5, random() - .5);"
                "if (float trace(o + .1 * w, w) > 1e20) leaks += 1; } Ci = told(leaks, 0, 1);");
            SCOPED_TRACE(thing + rate);
            expect_told(image, 0, 64 * 64);
        }
}

/// Threads, the memory that bricks may take, and instruction sets change nothing.
TEST(RayMotion, PicturesAreTheSameBitsForEveryOrderOfWork) {
    Case c = in_time();
    c.things = moves("-1 0 3", "1 0 3", "Surface \"matte\" Sphere .5 -.5 .5 360 ") +
               moves("1 1 2", "0 0 4", "Opacity .5 .5 .5 Surface \"matte\" Torus .6 .2 0 360 360 ");
    const std::string body =
        "Ci = occlusion(P, normal(0, 0, -1), 16) + trace(P, vector(.2, 0, -1)) + "
        "transmission(P, point(0, 0, 0));";
    c.threads = 1;
    const Image one = c.render(body);
    c.threads = 4;
    EXPECT_TRUE(same_bits(one, c.render(body)));
    c.may_say = "memory-budget";  // of the region that asks
    c.settings.memory_bytes = size_t{3} << 20;
    EXPECT_TRUE(same_bits(one, c.render(body)));
}

}  // namespace
}  // namespace trapeze::testing
