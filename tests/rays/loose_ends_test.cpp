/// Rays that end in free space, as at a lamp, or begin beside their surface: all that is in their way counts,
/// however near it is to the end, but what the end lies on.
#include <gtest/gtest.h>

#include <string>

#include "tests/program_harness.h"
#include "tests/rays/rays_harness.h"
#include "tests/scene_harness.h"

namespace trapeze::testing {
namespace {

const std::string kLitFloor = "Patch \"bilinear\" \"P\" [-9 -1 9 9 -1 9 -9 -1 1 9 -1 1] ";

/// Shadows of a lamp at (8, 0, -200), where a pixel's side is 6.
Case lit_floor(const std::string& call, const std::string& rate) {
    Case c;
    c.options = "Projection \"perspective\" \"fov\" 90 ";
    c.shaders["lamp"] = "light lamp(point from = point(8, 0, -200);) { illuminate(from) Cl = " + call + "; }";
    c.asker = "LightSource \"lamp\" 1 ShadingRate " + rate;
    c.asks = kLitFloor;
    return c;
}

const char* const kCalls[] = {"transmission(from, Ps)", "transmission(Ps, from)",
                              "1 - shadow(\"raytrace\", Ps)"};

void expect_light(Case c, float light) {
    const Image image = c.render(
        "color open = 0; illuminance(P, normal(0, 1, 0), PI) { open += Cl; } "
        "Ci = color(comp(open, 0), " +
        std::to_string(light) + ", 1);");
    expect_near(image, 0, 1000);
}

TEST(RayLooseEnds, AShadeAroundALampHidesIt) {
    for (const std::string call : kCalls)
        for (const char* rate : {"1 ", "9 "})
            for (const char* radius : {"8", "12", "20"}) {
                SCOPED_TRACE(call + rate + radius);
                Case c = lit_floor(call, rate);
                c.things = std::string("Translate 8 0 -200 Sphere ") + radius + " -" + radius + ' ' + radius +
                           " 360 ";
                expect_light(c, 0);
            }
}

/// It is half a pixel's side in front of the lamp, or behind it.
TEST(RayLooseEnds, AWallBesideALampHidesItFromOneSide) {
    for (const std::string call : kCalls)
        for (const bool before : {true, false}) {
            SCOPED_TRACE(call + (before ? " before" : " behind"));
            Case c = lit_floor(call, "1 ");
            c.things = std::string("Translate 8 0 ") + (before ? "-197" : "-203") +
                       " Patch \"bilinear\" \"P\" [-90 90 0 90 90 0 -90 -90 0 90 -90 0] ";
            expect_light(c, before ? 0 : 1);
        }
}

/// What a lamp is fixed to does not count, from either side.
TEST(RayLooseEnds, ALampOnAWallShines) {
    for (const std::string call : kCalls) {
        SCOPED_TRACE(call);
        Case c = lit_floor(call, "1 ");
        c.things =
            "Translate 8 0 -200 Rotate 20 1 2 0 "
            "Patch \"bilinear\" \"P\" [-90 90 0 90 90 0 -90 -90 0 90 -90 0] ";
        expect_light(c, 1);
    }
}

/// The mean of a picture of a floor under a sphere that shines from both of its sides or from the outer one,
/// seen from afar, near by, and through a telescope.
double mean_under_light(const std::string& attributes, const std::string& field) {
    const WorkFolder folder;
    folder.write("a.rib",
                 "Format 64 64 1 PixelSamples 1 1 Projection \"perspective\" \"fov\" " + field +
                     " WorldBegin AttributeBegin Attribute \"visibility\" \"int camera\" 0 " + attributes +
                     " AreaLightSource \"arealight\" 1 \"intensity\" 10 \"float samples\" 64 "
                     "Translate 0 1 5 Sphere .5 -.5 .5 360 AttributeEnd Illuminate 1 1 "
                     "Surface \"matte\" " +
                     kLitFloor + "Patch \"bilinear\" \"P\" [-9 -1 9 9 -1 9 -9 9 9 9 9 9] WorldEnd\n");
    const auto frames = render_scene((folder / "a.rib").string(), RenderSettings());
    double sum = 0;
    for (size_t i = 0; !frames.empty() && i < frames.front().image.rgba.size(); i += 4)
        sum += frames.front().image.rgba[i];
    return sum / (64 * 64);
}

/// Its front hides its back, but not itself, however fine what rays meet of it is: a twentieth of a pixel's
/// side, or 40.
TEST(RayLooseEnds, ALightThatRaysMeetHidesItsBackAlone) {
    for (const char* field : {"60", "6", ".6"}) {
        const double outer = mean_under_light("Sides 1 ", field);
        const double both = mean_under_light("Attribute \"visibility\" \"int transmission\" 1 ", field);
        EXPECT_GT(outer, .1);
        EXPECT_NEAR(both / outer, 1, .015) << field;
    }
}

/// A wall a third of a pixel's side in front of a square, seen from points in between.
TEST(RayLooseEnds, PointsBesideASurfaceSeeWhatIsNear) {
    Case c;
    c.things = "Patch \"bilinear\" \"P\" [-3 3 4.99 3 3 4.99 -3 -3 4.99 3 -3 4.99] ";
    c.asker = kSeen;
    for (const char* height : {".001", ".002", ".004"}) {
        SCOPED_TRACE(height);
        const std::string from = std::string("point from = P - vector(0, 0, ") + height + "); ";
        expect_told(c.render(from + "Ci = told(trace(from, vector(0, 0, -1)), .01 - " + height + ", 1);"),
                    2e-6f);
        expect_told(c.render(from + "Ci = told(occlusion(from, vector(0, 0, -1), 16), 1, 1);"), 0);
        expect_told(c.render(from + "Ci = told(comp(transmission(from, P - vector(0, 0, 1)), 0), 0, 1);"), 0);
    }
}

/// Hair and particles a third of a pixel's side in front of a wall: it hides all behind them, but they do not
/// hide themselves.
TEST(RayLooseEnds, WhatTurnsToTheEyeIsHiddenByWhatIsNear) {
    const std::string turning[] = {
        "Curves \"linear\" [2] \"nonperiodic\" \"P\" [-1 0 2 1 .1 2] \"constantwidth\" .2 ",
        "Points \"P\" [-.5 0 2 .5 0 2] \"constantwidth\" .4 "};
    for (const std::string& things : turning)
        for (const bool behind : {true, false}) {
            SCOPED_TRACE(things + (behind ? "behind" : "in front"));
            Case c;
            c.asker = kSeen;
            c.asks = things;
            c.things = wall("2.01");
            expect_told(c.render(std::string("Ci = told(occlusion(P, vector(0, 0, ") +
                                 (behind ? "1), 16), 1, 1);" : "-1), 16), 0, 1);")),
                        0, 200);
        }
}

/// Nor do they see the surface from which they have been moved, be it bent.
TEST(RayLooseEnds, PointsBesideABallDoNotSeeIt) {
    Case c;
    c.asker = kSeen + "Translate 0 0 5 ";
    c.asks = "AttributeBegin Sphere 1 -1 1 360 AttributeEnd ";
    for (const char* height : {"0", "1e-6", ".0001", ".001", ".01", ".1"}) {
        SCOPED_TRACE(height);
        const std::string from =
            std::string("vector out = P - point(0, 0, 5); point from = P + ") + height + " * out; ";
        expect_told(c.render(from + "Ci = told(occlusion(from, out, 16), 0, 1);"), 0, 3000);
    }
}

/// From within it they see nothing else.
TEST(RayLooseEnds, PointsBesideTheWallsOfABallSeeNothingElse) {
    Case c;
    c.asker = kSeen + "Translate 0 0 5 ";
    c.asks = "AttributeBegin Sphere 1 -1 1 360 AttributeEnd ";
    for (const char* height : {"0", "1e-6", ".0001", ".001", ".01", ".1"}) {
        SCOPED_TRACE(height);
        const std::string from =
            std::string("vector in = point(0, 0, 5) - P; point from = P + ") + height + " * in; ";
        expect_told(c.render(from + "Ci = told(occlusion(from, in, 16), 1, 1);"), 0, 3000);
    }
}

}  // namespace
}  // namespace trapeze::testing
