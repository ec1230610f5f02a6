#include "shade/clouds/surfel_tree.h"

#include <gtest/gtest.h>

#include <fstream>
#include <limits>

#include "shade/clouds/cloud_library.h"
#include "shade/clouds/clouds_harness.h"
#include "shade/clouds/surfels_harness.h"

namespace trapeze::testing {
namespace {

/// Solid angles of all sides that are seen, and what they send.
struct Seen {
    double front = 0, back = 0;
    V3d light{0, 0, 0};

    void add(double more_front, double more_back, const V3d& color) {
        front += more_front, back += more_back;
        light += color * (more_front + more_back);
    }
};

V3d as_double(const V3f& v) {
    return V3d(v);
}

/// Disc by disc, those whose middle is above the horizon and within the distance.
Seen all_discs(const Surfels& surfels, const SurfelPlace& place) {
    Seen seen;
    for (size_t i = 0; i < surfels.size(); ++i) {
        const V3d way = as_double(surfels.positions[i]) - as_double(place.position);
        const double d = way.length(), facing = -way.dot(as_double(surfels.normals[i])) / d;
        if (way.dot(as_double(place.normal)) <= 0 || d > static_cast<double>(place.max_distance)) continue;
        const double angle = static_cast<double>(surfels.areas[i]) * std::abs(facing) / (d * d);
        seen.add(facing > 0 ? angle : 0, facing > 0 ? 0 : angle,
                 surfels.radiosities.empty() ? V3d(0) : as_double(surfels.radiosities[i]));
    }
    return seen;
}

Seen all_pieces(const SurfelTree& tree, const SurfelPlace& place) {
    std::vector<SurfelPiece> pieces;
    tree.cut(place, pieces);
    Seen seen;
    for (const SurfelPiece& piece : pieces) {
        const auto d2 = static_cast<double>(piece.distance) * static_cast<double>(piece.distance);
        if (piece.way.dot(place.normal) > 0)
            seen.add(static_cast<double>(piece.front) / d2, static_cast<double>(piece.back) / d2,
                     as_double(tree.radiosity(piece)));
    }
    return seen;
}

/// Balls that look different from all sides: a blue one and a red one, which is green below.
Surfels two_balls() {
    Surfels surfels = sphere(3000, {1, .5f, 3}, 1);
    const Surfels other = sphere(2000, {-1.5f, 0, 2}, .7);
    for (size_t i = 0; i < other.size(); ++i)
        add_disc(surfels, other.positions[i], other.normals[i], static_cast<double>(other.areas[i]));
    for (size_t i = 0; i < surfels.size(); ++i)
        surfels.radiosities.push_back(i < 3000                   ? V3f(.1f, .2f, .9f)
                                      : surfels.normals[i].z < 0 ? V3f(.1f, .8f, .1f)
                                                                 : V3f(.9f, .1f, .1f));
    return surfels;
}

/// What clusters show comes to what their discs show, the nearer the smaller the clusters may be.
TEST(SurfelTree, ComesToWhatAllDiscsShow) {
    const Surfels surfels = two_balls();
    const SurfelTree tree(surfels);
    double last = 1;
    for (const float angle : {.3f, .03f, .001f}) {
        double worst = 0, worst_light = 0;
        Numbers numbers(4);
        for (int i = 0; i < 100; ++i) {
            SurfelPlace place;
            place.position = {numbers.between(-2, 2), numbers.between(-2, 2), numbers.between(-2, 0)};
            place.normal = {0, 0, 1}, place.max_solid_angle = angle;
            const Seen expected = all_discs(surfels, place), found = all_pieces(tree, place);
            worst = std::max({worst, std::abs(found.front / expected.front - 1),
                              std::abs(found.back / expected.back - 1)});
            for (int k = 0; k < 3; ++k)
                worst_light = std::max(worst_light, std::abs(found.light[k] / expected.light[k] - 1));
        }
        EXPECT_LT(worst, last / 2) << angle;
        last = worst;
        EXPECT_LT(worst, angle < .01f ? .005 : angle < .1f ? .05 : .3) << angle;
        EXPECT_LT(worst_light, angle < .01f ? .01 : angle < .1f ? .1 : .5) << angle;
    }
}

/// Discs that all look one way are seen as one disc of their area by nine harmonics and what these lack.
TEST(SurfelTree, SeesFlatClustersExactly) {
    Surfels surfels;
    add_sheet(surfels, 8, {-.5f, -.5f, 0}, {1, 0, 0}, {0, 1, 0});
    const SurfelTree tree(surfels);
    for (const double tilt : {0.0, .5, 1.0, 1.4, 1.8, 2.5, 3.1}) {
        SurfelPlace place;
        place.position = V3f(V3d(100 * std::sin(tilt), 0, 100 * std::cos(tilt)));
        place.normal = -place.position.normalized();
        std::vector<SurfelPiece> pieces;
        tree.cut(place, pieces);
        ASSERT_EQ(pieces.size(), 1u);
        EXPECT_TRUE(pieces[0].is_cluster);
        EXPECT_NEAR(static_cast<double>(pieces[0].front), std::max(0.0, std::cos(tilt)), 2e-5);
        EXPECT_NEAR(static_cast<double>(pieces[0].back), std::max(0.0, -std::cos(tilt)), 2e-5);
    }
}

TEST(SurfelTree, LooksNoFartherThanItIsAsked) {
    const Surfels surfels = two_balls();
    const SurfelTree tree(surfels);
    SurfelPlace place;
    place.position = V3f(0), place.normal = {0, 0, 1}, place.max_solid_angle = 1e-4f;
    for (const float distance : {.5f, 2.0f, 3.0f}) {
        place.max_distance = distance;
        const Seen expected = all_discs(surfels, place), found = all_pieces(tree, place);
        EXPECT_NEAR(found.front, expected.front, .01 * expected.front + 1e-9);
        EXPECT_EQ(found.front > 0, distance > 1);
    }
}

/// Far fewer pieces than discs, and no more where a cloud is finer.
TEST(SurfelTree, TakesFewPieces) {
    std::vector<SurfelPiece> pieces;
    for (const int count : {10'000, 100'000}) {
        SurfelPlace place;
        place.position = V3f(0), place.normal = {0, 0, 1};
        SurfelTree(sphere(count, {0, 0, 3}, 1)).cut(place, pieces);
        EXPECT_GT(pieces.size(), 5u);
        EXPECT_LT(pieces.size(), 200u);
    }
}

TEST(SurfelTree, LeavesOutWhatIsNoDisc) {
    Surfels surfels;
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    for (const float x : {nan, inf, 1e30f}) add_disc(surfels, {x, 0, 1}, {0, 0, 1}, 1);
    add_disc(surfels, {0, 0, 1}, {0, nan, 1}, 1);
    for (const double area : {0.0, -1.0, static_cast<double>(nan), static_cast<double>(inf)})
        add_disc(surfels, {0, 0, 1}, {0, 0, 1}, area);
    EXPECT_TRUE(SurfelTree(surfels).empty());
    // Any number may lie in one place.
    for (int i = 0; i < 1000; ++i) add_disc(surfels, {0, 0, 2}, {0, 0, -1}, .001);
    const SurfelTree tree(surfels);
    EXPECT_EQ(tree.surfels().size(), 1000u);
    SurfelPlace place;
    place.position = V3f(0), place.normal = {0, 0, 1};
    EXPECT_NEAR(all_pieces(tree, place).front, .25, 1e-4);
    place.position = {nan, 0, 0};
    EXPECT_EQ(all_pieces(tree, place).front, 0);
}

/// Clouds and their trees share one bound.
TEST(SurfelTree, TakesNoMoreMemoryThanCloudsMay) {
    const std::string name = ::testing::TempDir() + "surfels.ptc", file = ptc_of(some_cloud(1000));
    std::ofstream(name, std::ios::binary) << file;
    for (const bool fits : {false, true}) {
        CloudLibrary library(Options(), nullptr, kEverything);
        // What is read may take twice its file.
        library.set_limit((fits ? 20 : 2) * file.size() + 1000);
        ASSERT_TRUE(library.find(name, {}));
        std::string problem;
        EXPECT_EQ(library.surfels(name, &problem) != nullptr, fits);
        EXPECT_EQ(problem.find("MiB") != std::string::npos, !fits) << problem;
    }
}

}  // namespace
}  // namespace trapeze::testing
