/// Rays that begin on the micropolygon below their point (decision 0034): what they find of their own
/// surface.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "shade/rays/inside_search.h"
#include "tests/program_harness.h"
#include "tests/rays/ray_world_harness.h"
#include "tests/scene_harness.h"

namespace trapeze::testing {
namespace {

/// What a surface sees that is about the point (0, 0, 5), of which the least and the most are told in red;
/// the greenest pixel tells that something is there.
struct Seen {
    float least = kInfinity, most = -kInfinity, green = 0;
};

Seen seen_of(const std::string& surface, const std::string& things, const std::string& options = "") {
    const WorkFolder folder;
    folder.write("s.sl", "surface s() { Oi = Os; " + surface + " }");
    folder.write("flat.sl", "displacement flat() { P += 0; N = calculatenormal(P); }");
    folder.write(
        "a.rib",
        "Format 64 64 1 PixelSamples 1 1 PixelFilter \"box\" 1 1 Projection \"perspective\" \"fov\" 40 "
        "Shutter 0 1 " +
            options +
            "\nWorldBegin ShadingInterpolation \"constant\" "
            "Attribute \"visibility\" \"int diffuse\" 1 \"int transmission\" 1 \"int specular\" 1 "
            "Attribute \"trace\" \"int displacements\" 1 \"int samplemotion\" 1 "
            "Attribute \"displacementbound\" \"sphere\" [.1] Surface \"s\" Translate 0 0 5 " +
            things + "\nWorldEnd\n");
    const auto frames = render_scene((folder / "a.rib").string(), RenderSettings());
    Seen seen;
    for (size_t i = 0; !frames.empty() && i < frames.front().image.rgba.size(); i += 4) {
        const float* const pixel = frames.front().image.rgba.data() + i;
        if (!(pixel[1] > 0)) continue;
        seen.least = std::min(seen.least, pixel[0]), seen.most = std::max(seen.most, pixel[0]);
        seen.green = std::max(seen.green, pixel[1]);
    }
    return seen;
}

/// A square of 80 x 80 faces, each a grid of its own, that deforms into one that has turned by 60 degrees.
std::string dense_sheet() {
    constexpr int kFaces = 80;
    std::string faces, corners, before, after;
    for (int j = 0; j <= kFaces; ++j)
        for (int i = 0; i <= kFaces; ++i) {
            const double x = 2.0 * i / kFaces - 1, y = 2.0 * j / kFaces - 1;
            before += text(V3f(static_cast<float>(x), static_cast<float>(y), 0));
            after +=
                text(V3f(static_cast<float>(x), static_cast<float>(y * .5), static_cast<float>(y * .866)));
            if (i == kFaces || j == kFaces) continue;
            faces += "4 ";
            for (const int corner : {0, 1, kFaces + 2, kFaces + 1})
                corners += std::to_string(j * (kFaces + 1) + i + corner) + ' ';
        }
    const std::string head = "PointsPolygons [" + faces + "] [" + corners + "] \"P\" [";
    return "MotionBegin [0 1] " + head + before + "] " + head + after + "] MotionEnd ";
}

TEST(RayStarts, WhatDeformsAndIsFlatHidesNothingOfItself) {
    const Seen seen = seen_of(
        "normal n = faceforward(normalize(N), I); Ci = color(occlusion(P, n, 64), 1, 0);", dense_sheet());
    EXPECT_EQ(seen.most, 0);
    EXPECT_GT(seen.green, 0);
}

/// Along a pipe's wall all rays come to the wall across from where they begin, and to no other.
TEST(RayStarts, AWallIsMetOnceFromWithin) {
    const std::string along =
        "point c = transform(\"object\", P); vector out = vtransform(\"object\", \"current\", "
        "vector(xcomp(c), ycomp(c), 0)), side = vtransform(\"object\", \"current\", vector(-ycomp(c), xcomp(c), 0));"
        "normal g = normalize(Ng); if (g . out > 0) g = -g; side = normalize(side - g * (g . side));";
    const std::string pipe =
        "Translate 0 0 -4 Rotate 30 1 2 0 Rotate 90 1 0 0 Displacement \"flat\" Cylinder 2 -6 6 360 ";
    for (const std::string way : {".02", ".1", ".5"}) {
        const Seen seen =
            seen_of(along + "Ci = color(comp(transmission(P, P + 20 * (side + " + way + " * g)), 0), 1, 0);",
                    "Opacity .5 .5 .5 " + pipe);
        EXPECT_GT(seen.green, 0);
        EXPECT_NEAR(seen.least / seen.green, .5f, 1e-3f) << way;
        EXPECT_NEAR(seen.most / seen.green, .5f, 1e-3f) << way;
    }
    // What is in front of the end by less than two sides is not in the way.
    const Seen near = seen_of(
        along + "Ci = color(comp(transmission(P, P + .001 * normalize(side + .005 * g)), 0), 1, 0);", pipe);
    EXPECT_EQ(near.least, 1);
}

/// A square that is displaced but stays where it is, whose vertices are those of what rays meet.
const std::string kFlatSquare =
    "Displacement \"flat\" Patch \"bilinear\" \"P\" [-1.2 1.2 0 1.2 1.2 0 -1.2 -1.2 0 1.2 -1.2 0] ";
const std::string kMirroredSquare =
    "Displacement \"flat\" Patch \"bilinear\" \"P\" [1.2 1.2 0 -1.2 1.2 0 1.2 -1.2 0 -1.2 -1.2 0] ";

/// On a slope behind it the way back tells where a ray began: an eighth of a side beside its point at most.
TEST(RayStarts, RaysBeginAtTheirPoints) {
    const std::string slope =
        "AttributeBegin Attribute \"visibility\" \"int camera\" 0 Patch \"bilinear\" \"P\" "
        "[-9 9 -13 9 9 5 -9 -9 -13 9 -9 5] AttributeEnd ";
    for (const std::string& square : {kFlatSquare, kMirroredSquare})
        for (const auto& [rate, side] : {std::pair("1 ", .06f), {"16 ", .24f}}) {
            const Seen seen = seen_of(
                "float t; point Q = transform(\"world\", P); color c = trace(P, vector(0, 0, -1), t);"
                "Ci = color(abs(zcomp(Q) - 1 - xcomp(Q) - t), 1, 0);",
                slope + "ShadingRate " + rate + square);
            EXPECT_GT(seen.green, 0);
            EXPECT_LT(seen.most, side / 8) << rate;
        }
}

/// Rays below the surface go behind it, as they do where nothing is displaced.
TEST(RayStarts, RaysBelowTheSurfaceGoBehindIt) {
    const Seen seen = seen_of("Ci = color(occlusion(P, vector(sqrt(.75), 0, -.5), 256), 1, 0);", kFlatSquare);
    EXPECT_GT(seen.green, 0);
    EXPECT_LT(seen.most, .01f);
}

/// The other way round is the same, wherever the lamp stands.
TEST(RayStarts, ConvexThingsAreLitFromAllThatTheyFace) {
    for (const char* lamp : {"(0, 5, 5)", "(1.2, 0, 5)", "(-3, 2, -1)"})
        for (const char* rate : {"1 ", "20 ", "60 "})
            for (const char* ends : {"P, L", "L, P"}) {
                const Seen seen = seen_of("point L = point \"world\" " + std::string(lamp) +
                                              "; if ((L - P) . normalize(Ng) > 0) "
                                              "Ci = color(comp(transmission(" +
                                              ends + "), 0), 1, 0); else Ci = 0;",
                                          "ShadingRate " + std::string(rate) +
                                              "Displacement \"flat\" Rotate 30 1 2 0 Sphere 1 -1 1 360 ");
                EXPECT_EQ(seen.least, 1) << lamp << rate << ends;
            }
}

/// Also where rays begin on what they meet.
TEST(RayStarts, HitsKnowWhereRaysComeFrom) {
    const Seen seen = seen_of(
        "float d = 0; rayinfo(\"depth\", d); Ci = d > 0 ? color(length(I) > 1e-6 ? 0 : 1, 0, 0) :"
        "  color(comp(indirectdiffuse(P, faceforward(normalize(N), I), 64), 0), 1, 0);",
        "Translate 0 0 -5 Displacement \"flat\" Sphere 2 -2 2 360 ", "PixelSamples 1 1 ");
    EXPECT_GT(seen.green, 0);
    EXPECT_EQ(seen.most, 0);
}

/// Looking ahead changes nothing: a ray through many sheets, some of them in one place or opaque, meets the
/// same ones in the same order.
TEST(RaysAhead, FindWhatIsFoundOneByOne) {
    RayNumbers number;
    std::string things = "Attribute \"visibility\" \"int specular\" 1 ";
    for (int i = 0; i < 60; ++i) {
        const V3f at = number.in_cube(1);
        things += i % 20 == 19 ? "Opacity 1 1 1 Sides 2 "
                  : i % 3 == 0 ? "Opacity .5 .5 .5 Sides 1 "
                               : "Opacity .1 .1 .1 Sides 2 ";
        const std::string z = std::to_string(i % 5 == 4 ? 3.0f : 3 + at.z);
        things += i % 2 == 0 ? "Patch \"bilinear\" \"P\" [-2 -2 " + z + " 2 -2 " + z + " -2 2 " + z +
                                   " 2 2 " + z + "] "
                             : "TransformBegin Translate " + text(V3f(at.x, at.y, 3 + at.z)) +
                                   " Sphere .7 -.7 .7 360 TransformEnd ";
    }
    for (const std::string options : {"Format 64 64 1 ", kLevels.c_str()}) {
        const RayWorldScene scene(things, options);
        size_t most = 0;
        for (int i = 0; i < 300; ++i) {
            const V3f from = number.in_cube(1) + V3f(0, 0, 3), way = number.in_cube(1);
            RaySegment plain = ray_to(from, way, 0), looking = plain;
            const std::unique_ptr<RayAhead> ahead = scene.world().look_ahead();
            ASSERT_NE(ahead, nullptr);
            looking.ahead = ahead.get();
            for (size_t layer = 0; layer < 200; ++layer) {
                const auto one = scene.world().closest(plain, RayKind::Diffuse),
                           other = scene.world().closest(looking, RayKind::Diffuse);
                ASSERT_EQ(one.has_value(), other.has_value()) << layer;
                most = std::max(most, layer);
                if (!one) break;
                ASSERT_EQ(one->distance, other->distance) << layer;
                ASSERT_EQ(one->primitive, other->primitive) << layer;
                ASSERT_EQ(one->place.id, other->place.id) << layer;
                go_behind(scene.world(), *one, plain), go_behind(scene.world(), *other, looking);
            }
        }
        EXPECT_GT(most, 20u);
    }
}

}  // namespace
}  // namespace trapeze::testing
