/// How many rays statistics tell of, by kind, next to what the shaders ask for.
#include <gtest/gtest.h>

#include "tests/rays/rays_harness.h"

namespace trapeze::testing {
namespace {

/// The square of 64 x 64 micropolygons: 4 x 4 grids of 17 x 17 vertices each.
constexpr uint64_t kRows = 4 * 17, kVertices = kRows * kRows;
/// Those of x <= 0: two grids of four across, and the border of the third.
constexpr uint64_t kLeft = kRows * (2 * 17 + 1);

/// Of a square below a wall that sends two rays of transmission from each hit that is shaded.
FrameStats stats_of(const std::string& body, int threads, const std::string& opacity = "Os") {
    const WorkFolder folder;
    folder.write("ask.sl", "surface ask() { vector up = vector(0, 0, -1); " + body + " Oi = 1; }");
    folder.write(
        "wall.sl",
        "surface wall() { Ci = transmission(P, P + vector(0, 0, 9), \"samples\", 2, \"samplecone\", .1);"
        "Oi = " +
            opacity + "; Ci *= Oi; }");
    folder.write("a.rib", kPicture + "Option \"searchpath\" \"string shader\" [\"" + folder.path().string() +
                              "\"] WorldBegin AttributeBegin " + kHidden + kSeen + "Surface \"wall\" " +
                              wall("0") +
                              "AttributeEnd Surface \"ask\" Patch \"bilinear\" "
                              "\"P\" [-1 1 5 1 1 5 -1 -1 5 1 -1 5] WorldEnd\n");
    return render_scene((folder / "a.rib").string(), {}, threads).at(0).stats;
}

struct Counted {
    const char* body;
    uint64_t points, specular, diffuse, transmission, shaded_hits;  ///< of each point
};

TEST(RayCounts, AreWhatShadersAskForHoweverManyThreads) {
    const Counted all[] = {
        {"Ci = trace(P, up);", kVertices, 1, 0, 2, 1},
        {"Ci = trace(P, up, \"samples\", 3, \"samplecone\", .1);", kVertices, 3, 0, 6, 3},
        {"float far = trace(P, up, \"samples\", 4, \"samplecone\", .1); Ci = far;", kVertices, 4, 0, 0, 0},
        {"Ci = environment(\"raytrace\", up);", kVertices, 1, 0, 2, 1},
        {"Ci = transmission(P, P + 9 * up, \"samples\", 5, \"samplecone\", .1);", kVertices, 0, 0, 5, 0},
        {"Ci = occlusion(P, up, 7);", kVertices, 0, 7, 0, 0},
        {"Ci = indirectdiffuse(P, up, 4, \"coneangle\", .1);", kVertices, 0, 4, 8, 4},
        {"color c = 0; gather(\"illuminance\", P, up, .1, 6, \"surface:Ci\", c) { Ci += c; }", kVertices, 6,
         0, 12, 6},
        {"gather(\"\", P, up, .1, 6, \"distribution\", \"cosine\") { Ci += 1; }", kVertices, 0, 6, 0, 0},
        {"gather(\"samplepattern\", P, up, .1, 6) { } else { Ci += 1; }", kVertices, 0, 0, 0, 0},
        {"if (xcomp(P) < .01) Ci = trace(P, up) + occlusion(P, up, 3);", kLeft, 1, 3, 2, 1},
        {"Ci = trace(P, up) + indirectdiffuse(P, up, 4, \"coneangle\", .1) + occlusion(P, up, 7) +"
         "  transmission(P, P + 9 * up, \"samples\", 5, \"samplecone\", .1);",
         kVertices, 1, 11, 15, 5},
    };
    for (const Counted& one : all)
        for (const int threads : {1, 2, 5}) {
            SCOPED_TRACE(one.body + std::to_string(threads));
            const ShadeStats stats = stats_of(one.body, threads).shade;
            EXPECT_EQ(stats.rays.specular, one.points * one.specular);
            EXPECT_EQ(stats.rays.diffuse, one.points * one.diffuse);
            EXPECT_EQ(stats.rays.transmission, one.points * one.transmission);
            EXPECT_EQ(stats.rays.shaded_hits, one.points * one.shaded_hits);
            EXPECT_EQ(stats.shaded_vertices, kVertices + 4 * one.points * one.shaded_hits)
                << "a hit is a micropolygon";
        }
}

/// Their colours, which would send rays, are not wanted.
TEST(RayCounts, OpacityIsAllThatRunsWhereItIsAllThatIsWanted) {
    const std::string asks = "Ci = transmission(P, P + 9 * up, \"samples\", 5, \"samplecone\", .1);";
    const ShadeStats stats = stats_of(asks, 2, "Os * (.5 + .25 * s)").shade;
    EXPECT_EQ(stats.rays.shaded_hits, kVertices * 5);
    EXPECT_EQ(stats.rays.transmission, kVertices * 5);
    // What follows from rays takes them.
    const ShadeStats seen = stats_of(asks, 2, "Os * (.5 + .25 * comp(Ci, 0))").shade;
    EXPECT_EQ(seen.rays.transmission, kVertices * (5 + 5 * 2));
}

/// One that is opaque, and says so, is not asked at all.
TEST(RayCounts, WhatIsOpaqueIsNotAsked) {
    const std::string asks = "Ci = transmission(P, P + 9 * up, \"samples\", 5, \"samplecone\", .1);";
    for (const char* opaque : {"1", "color(1, 1, 1)", "Os"}) {
        const ShadeStats stats = stats_of(asks, 2, opaque).shade;
        EXPECT_EQ(stats.rays.shaded_hits, 0u) << opaque;
        EXPECT_EQ(stats.rays.transmission, kVertices * 5) << opaque;
    }
}

}  // namespace
}  // namespace trapeze::testing
