/// Larger micropolygons of flat faces, which rays meet: as few as there may be, but what is told of their
/// hits is as of small ones.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/rays/ray_world_harness.h"

namespace trapeze::testing {
namespace {

constexpr size_t kEnoughBytes = size_t{1} << 30;
/// Sides of a pixel are as long as that, where the view is orthographic.
constexpr float kPixelSide = 1.0f / 32;
const std::string kPixelView = "Format 64 64 1 Shutter 0 1 ";

uint64_t count_of(const RayDicer& dicer) {
    return dicer.tessellation().stats().micropolygons;
}

/// How many times more there are where flat faces are cut as all others.
double times_more(const RayWorldScene& scene) {
    const RayDicer larger(scene.context(), scene.shading(), kEnoughBytes);
    const RayDicer fine(larger, RaySides{0, false}, kEnoughBytes);
    return static_cast<double>(count_of(fine)) / static_cast<double>(count_of(larger));
}

const std::string kSquareOfTwo = "Polygon \"P\" [-1 -1 0 1 -1 0 1 1 0 -1 1 0] ";
const std::string kFlatTrapezoid = "Polygon \"P\" [-1 -1 0 1 -1 0 .3 1 0 -.5 .9 0] ";
/// One corner lies so far beside the plane of the others.
std::string bent_patch(float by) {
    return "Patch \"bilinear\" \"P\" [-1 -1 0 1 -1 0 -1 1 0 1 1 " + std::to_string(by) + "] ";
}

const std::string kTriangle = "Polygon \"P\" [-1 -1 0 1 -1 0 0 1 0] ";
const std::string kFan = "Patch \"bilinear\" \"P\" [0 -1 0 0 -1 0 -1 1 0 1 1 0] ";  // about its first corner

std::string moving(const std::string& from, const std::string& to) {
    return "Attribute \"trace\" \"int samplemotion\" 1 MotionBegin [0 1] " + from + to + "MotionEnd ";
}

TEST(FlatFaces, HaveFewMicropolygons) {
    for (const std::string& turn : {std::string(), std::string("Rotate 50 1 2 3 ")})
        for (const std::string& thing :
             {kSquareOfTwo, bent_patch(0), kFlatTrapezoid, kTriangle, kFan,
              moving("Rotate 0 1 0 0 ", "Rotate 40 1 0 0 ") + kFlatTrapezoid,
              // Linear at each moment, whatever way they deform.
              moving(kSquareOfTwo, "Polygon \"P\" [-1 -1 0 1 -.5 0 1.1 1 1 -.9 .5 1] "),
              moving(kTriangle, "Polygon \"P\" [-1 -1 .5 1 -1 0 0 1 1] ")})
            EXPECT_GT(times_more(RayWorldScene(turn + thing, kPixelView)), 100) << turn << thing;
}

TEST(FlatFaces, AreNotThoseThatBend) {
    // Flat, but its lines cross, and its outline is curved.
    const std::string crossed = "Patch \"bilinear\" \"P\" [-1 -1 0 -1 0 0 0 0 0 1 -1 0] ";
    const std::string folded = "Patch \"bilinear\" \"P\" [-1 -1 0 1 -1 0 -1 1 0 -.95 -.95 0] ";
    for (const std::string& thing :
         {bent_patch(.1f), folded, crossed, std::string("Sphere 1 -1 1 360 "),
          "Attribute \"displacementbound\" \"sphere\" [.1] " + kSquareOfTwo,
          std::string("Patch \"bicubic\" \"P\" [-1 -1 0 -.3 -1 0 .3 -1 0 1 -1 0 -1 -.3 0 -.3 -.3 0 .3 -.3 0 "
                      "1 -.3 0 -1 .3 0 -.3 .3 0 .3 .3 0 1 .3 0 -1 1 0 -.3 1 0 .3 1 0 1 1 0] "),
          // Flat as the shutter opens and closes, but not in between.
          moving("Patch \"bilinear\" \"P\" [-1 -1 0 1 -1 0 -.5 .9 0 .3 1 0] ",
                 "Patch \"bilinear\" \"P\" [-1 -1 0 1 -1 1 -1 1 0 .2 .2 .6] ")})
        EXPECT_EQ(times_more(RayWorldScene(thing, kPixelView)), 1) << thing;
}

/// A little beside the plane is flat enough: what lies between the corners is off by a 256th of a side.
TEST(FlatFaces, MayBendByLittle) {
    EXPECT_GT(times_more(RayWorldScene(bent_patch(1e-4f), kPixelView)), 100);
    EXPECT_EQ(times_more(RayWorldScene(bent_patch(2e-2f), kPixelView)), 1);
}

/// Where values at corners are all that is told of a hit there are more of them, unless the face is linear.
TEST(FlatFaces, AreCutForTheirColors) {
    const std::string colors = "\"varying color Cs\" [1 0 0 0 1 0 0 0 1 1 1 1] ";
    EXPECT_GT(times_more(RayWorldScene(kSquareOfTwo + colors, kPixelView)), 200);
    EXPECT_GT(times_more(RayWorldScene(kTriangle + "\"varying color Cs\" [1 0 0 0 1 0 0 0 1] ", kPixelView)),
              100);
    const double times = times_more(RayWorldScene(kFan + colors, kPixelView));
    EXPECT_GT(times, 10);
    EXPECT_LT(times, 100);
}

/// What is told of a hit is where the ray has met it, in all variables (those of polygons are x and y in
/// object space); and what it is filtered over is as large as if all micropolygons were small.
void expect_told_as_of_small_ones(const std::string& thing, int least_met) {
    SCOPED_TRACE(thing);
    const bool is_polygon = thing.starts_with("P") && thing[1] == 'o';
    const RayWorldScene scene("Rotate 30 1 2 3 " + thing, kPixelView);
    M44f object_from_camera;
    object_from_camera = scene.scene().primitives.front().camera_from_object.front().inverse();
    RayNumbers number;
    ShadingGrid grid;
    int met = 0;
    for (int i = 0; i < 4000; ++i) {
        const V3f from = number.in_cube(3), target = number.in_cube(.6f);
        const RaySegment ray = ray_to(from, target - from, 0);
        const std::optional<RaySurfaceHit> hit = scene.world().closest(ray, RayKind::Diffuse);
        if (!hit) continue;
        ++met;
        const auto vertex = static_cast<size_t>(scene.world().dice(*hit, grid));
        const V3f P = from + ray.direction * hit->distance, own = P * object_from_camera;
        ASSERT_LT((grid.P[0].at(vertex) - P).length(), kPixelSide / 100) << P;
        if (is_polygon) {
            ASSERT_NEAR(grid.u[vertex], own.x, kPixelSide / 100) << own;
            ASSERT_NEAR(grid.t[vertex], own.y, kPixelSide / 100) << own;
        }
        const V3f u = grid.P[0].at(1) - grid.P[0].at(0), v = grid.P[0].at(2) - grid.P[0].at(0);
        ASSERT_LT(std::max(u.length(), v.length()), 1.6f * kPixelSide);
    }
    EXPECT_GT(met, least_met);
}

TEST(FlatFaces, TellPlacesAndSizesAsSmallOnes) {
    const std::string five = "Polygon \"P\" [-1 -1 0 .2 -1 0 1 .1 0 .4 1 0 -.8 .6 0] ";
    const std::string two =
        "PointsPolygons [4 4] [0 1 4 3 1 2 5 4] \"P\" [-1 -1 0 .5 -1 0 .8 -.9 0 "
        "-1 1 0 .3 .9 0 1 1 0] ";
    for (const std::string& thing : {kSquareOfTwo, kFlatTrapezoid, kTriangle, kFan, five, two})
        expect_told_as_of_small_ones(thing, 700);
}

/// Pieces of triangles with edges of one micropolygon have corners on the next piece.
TEST(FlatFaces, TellPlacesOnTrianglesOfOneMicropolygon) {
    for (const char* const size : {".05", ".1", ".2", ".3", ".4", ".5"}) {
        const std::string s = size;
        expect_told_as_of_small_ones(
            "Polygon \"P\" [-" + s + " -" + s + " 0 " + s + " -" + s + " 0 0 " + s + " 0] ", 3);
    }
    expect_told_as_of_small_ones("Polygon \"P\" [-.9 -.9 0 .9 0 0 .9 .2 0] ", 100);
    // A mesh of triangles.
    std::string faces, corners, points;
    for (int j = 0; j < 10; ++j)
        for (int i = 0; i < 10; ++i) {
            const int at = 11 * j + i;
            faces += "3 3 ";
            corners += fmt::format("{} {} {} {} {} {} ", at, at + 1, at + 12, at, at + 12, at + 11);
        }
    RayNumbers number;
    for (int j = 0; j <= 10; ++j)
        for (int i = 0; i <= 10; ++i)
            points += fmt::format("{} {} 0 ", .2f * static_cast<float>(i) - 1 + number(-.05f, .05f),
                                  .2f * static_cast<float>(j) - 1 + number(-.05f, .05f));
    expect_told_as_of_small_ones("PointsPolygons [" + faces + "] [" + corners + "] \"P\" [" + points + "] ",
                                 700);
}

}  // namespace
}  // namespace trapeze::testing
