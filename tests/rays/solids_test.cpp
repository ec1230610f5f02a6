/// Rays of shaders and solids: what is left of balls, next to intervals along the rays.
#include <gtest/gtest.h>

#include "tests/rays/rays_harness.h"

namespace trapeze::testing {
namespace {

/// Two balls on a ray along -z through (x, y): they hold z within these.
const std::string kIntervals =
    "float x = xcomp(P), y = ycomp(P), r2 = x * x + y * y;"
    "float a = sqrt(max(0, 1 - r2)), b = sqrt(max(0, .36 - r2));"
    "float a0 = 3 - a, a1 = 3 + a, b0 = 3.8 - b, b1 = 3.8 + b; float none = 1e30;"
    "float sure = abs(r2 - 1) < .06 || abs(r2 - .36) < .05 || abs(a1 - b0) < .03 || abs(a1 - b1) < .03 ? 0 : 1;"
    "float in_a = r2 < 1 ? 1 : 0, in_b = r2 < .36 ? 1 : 0;";

std::string solid(const std::string& operation, const std::string& attributes = "") {
    return "SolidBegin \"" + operation + "\" SolidBegin \"primitive\" " + attributes + sphere("0 0 3", "1") +
           "SolidEnd SolidBegin \"primitive\" " + attributes + sphere("0 0 3.8", ".6") + "SolidEnd SolidEnd ";
}

constexpr float kChord = 4e-3f;  ///< of micropolygons that are seen at a slant

const std::string kNearest = "Ci = color(min(float trace(P, vector(0, 0, -1)), 1e30), d, sure);";

TEST(RaySolids, AreCutAsTheirTreesSay) {
    Case c;
    c.things = solid("difference");
    // From z = 5: the ball's outside, or the hollow's inside, behind which the ball begins.
    expect_near(c.render(kIntervals +
                         "float top = in_b == 1 && b0 < a1 && a1 < b1 ? b0 : a1;"
                         "float d = in_a == 0 ? none : 5 - top;" +
                         kNearest),
                kChord);
    c.things = solid("intersection");
    expect_near(c.render(kIntervals + "float d = in_b == 1 && b0 < a1 ? 5 - min(a1, b1) : none;" + kNearest),
                kChord);
    c.things = solid("union");
    expect_near(
        c.render(kIntervals + "float d = in_a == 0 ? none : 5 - (in_b == 1 ? max(a1, b1) : a1);" + kNearest),
        kChord);
}

TEST(RaySolids, RaysMayBeginInside) {
    Case c;
    c.things = solid("difference");
    // In the middle of the ball, upwards: to the hollow, or out.
    expect_near(c.render(kIntervals + "float d = in_a == 0 ? none : min(a1, in_b == 1 ? b0 : a1) - 3;"
                                      "point o = point(x, y, 3);"
                                      "Ci = color(min(float trace(o, vector(0, 0, 1)), 1e30), d, sure);"),
                kChord, 2500);
    // Within the hollow, downwards: into the ball.
    expect_near(c.render(kIntervals + "float d = 3.8 - b0; point o = point(x, y, 3.8);"
                                      "Ci = color(min(float trace(o, vector(0, 0, -1)), 1e30), d, "
                                      "in_b * sure * (a1 > b0 ? 1 : 0));"),
                kChord, 800);
}

/// Each surface of the solid takes half of the light.
TEST(RaySolids, ShadowsAreOfTheirOwnSurfacesAlone) {
    Case c;
    const std::string count =
        "float hollow = in_b == 1 && b0 < a1 ? 1 : 0; float split = hollow == 1 && b1 < a1 ? 1 : 0;";
    const std::string ask = "Ci = color(comp(transmission(P, P - vector(0, 0, 5)), 0), d, sure);";
    c.things = solid("difference", "Opacity .5 .5 .5 Surface \"constant\" ");
    expect_near(c.render(kIntervals + count + "float d = in_a == 0 ? 1 : split == 1 ? .0625 : .25;" + ask),
                1e-5f);
    c.things = solid("intersection", "Opacity .5 .5 .5 Surface \"constant\" ");
    expect_near(c.render(kIntervals + count + "float d = hollow == 1 ? .25 : 1;" + ask), 1e-5f);
    // What stands before, and behind, is no part of it; opaque.
    c.things = solid("intersection") + wall("0");
    expect_near(c.render(kIntervals + "float d = in_b == 1 && b0 < a1 ? 5 - min(a1, b1) : 5;" + kNearest),
                kChord);
    c.things = solid("intersection") + wall("4.5");
    expect_near(c.render(kIntervals + "float d = .5;" + kNearest), 1e-5f);
}

/// Media are inside of the solid as a whole.
TEST(RaySolids, MediaFillTheWhole) {
    Case c;
    c.shaders["haze"] =
        "volume haze() { float t = exp(-.5 * length(I)); Ci *= t; Oi = mix(color 1, Oi, t); }";
    c.things = solid("difference", "Interior \"haze\" Opacity 0 0 0 Surface \"constant\" ");
    expect_near(c.render(kIntervals + "float hollow = in_b == 1 ? max(0, min(a1, b1) - max(a0, b0)) : 0;"
                                      "float d = in_a == 0 ? 1 : exp(-.5 * (a1 - a0 - hollow));"
                                      "Ci = color(comp(transmission(P, P - vector(0, 0, 5)), 0), d, sure);"),
                kChord);
}

TEST(RaySolids, MoveWithTheShutter) {
    Case c;
    c.options = "Shutter 0 1 ";
    c.asker = "Attribute \"trace\" \"int samplemotion\" 1 ";
    c.things = "MotionBegin [0 1] Translate 0 0 -1 Translate 0 0 0 MotionEnd " + solid("intersection");
    expect_near(
        c.render(kIntervals +
                 "float d = in_b == 1 && b0 < a1 ? 5.5 - min(a1, b1) : none;"
                 "Ci = color(min(float trace(P, vector(0, 0, -1), \"samples\", 81), 1e30), d, sure);"),
        kChord + 1.0f / 81);
}

}  // namespace
}  // namespace trapeze::testing
