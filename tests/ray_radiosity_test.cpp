/// Light that goes round and round: an integrating cube, and white furnaces of concave and displaced things,
/// next to their sums of powers. What is hit beyond the D bounces that are allowed is black.
#include <gtest/gtest.h>

#include "tests/rays_harness.h"

namespace trapeze::testing {
namespace {

std::string bounces(int count) {
    return "Attribute \"trace\" \"int maxdiffusedepth\" [" + std::to_string(count) + "] ";
}

/// A closed box with the square that asks inside of it, from z = 1 to 8, in another one: a ray that begins at
/// an edge may do so a rounding outside, and is as good in there.
const std::string kBoxes =
    "PointsPolygons [4 4 4 4 4 4 4 4 4 4 4 4] [0 1 3 2 4 5 7 6 0 1 5 4 2 3 7 6 0 2 6 4 1 3 7 5 "
    "8 9 11 10 12 13 15 14 8 9 13 12 10 11 15 14 8 10 14 12 9 11 15 13] \"P\" "
    "[-2 -2 1 2 -2 1 -2 2 1 2 2 1 -2 -2 8 2 -2 8 -2 2 8 2 2 8 "
    "-3 -3 0 3 -3 0 -3 3 0 3 3 0 -3 -3 9 3 -3 9 -3 3 9 3 3 9] ";

/// Walls that emit E and give back rho of what comes: after D bounces each has the sum of E rho^k, k < D,
/// wherever its rays go, so that one ray a point is exact; without bias, for rays that begin beside an edge
/// meet the other wall at once.
TEST(RayRadiosity, AnIntegratingCubeIsAGeometricSeries) {
    const float rho[3] = {0.25f, 0.5f, 0.75f}, emitted[3] = {1, 0.5f, 0.125f};
    for (const int depth : {1, 2, 3, 4}) {
        Case c;
        c.shaders["wall"] =
            "surface wall() { Oi = 1; Ci = color(1, .5, .125) +"
            " color(.25, .5, .75) * indirectdiffuse(P, faceforward(normalize(N), I), 1, \"bias\", 0); }";
        c.asker = bounces(depth);
        c.things = bounces(depth) + "Surface \"wall\" " + kBoxes;
        const Image image = c.render("Ci = indirectdiffuse(P, normal(0, 0, -1), 1);");
        for (const Pixel& p : pixels(image)) {
            const float found[3] = {p.red, p.green, p.blue};
            for (int k = 0; k < 3; ++k) {
                float sum = 0;
                for (int bounce = 0; bounce < depth; ++bounce) sum = emitted[k] + rho[k] * sum;
                ASSERT_NEAR(found[k], sum, 1e-6f) << depth;
            }
        }
    }
}

/// A white thing under a white sky: what misses adds the sky, the first time by 16 rays, then by one.
const std::string kWhite =
    "color k = 0, sum = 0; uniform float rays = raydepth() == 0 ? 16 : 1;"
    "gather(\"illuminance\", P, in, PI / 2, rays, \"distribution\", \"cosine\", \"surface:Ci\", k) sum += k;"
    "else sum += 1; Ci = sum / rays;";

/// The mean of a thing's radiosity, where it is white and sees itself and a white sky.
double white(const std::string& thing, const std::string& inwards, int depth) {
    Case c;
    c.shaders["blow"] =
        "displacement blow() { P = transform(\"shader\", \"current\", 2 * transform(\"shader\", P));"
        "  N = calculatenormal(P); }";
    c.asker = kSeen + bounces(depth);
    c.asks = "AttributeBegin " + thing + " AttributeEnd ";
    const Image image = c.render(inwards + kWhite);
    for (const Pixel& p : pixels(image)) EXPECT_LE(p.red, 1 + 1e-5f);
    return mean_red(image);
}

/// In a bowl that is half of a sphere every point sees as much of the bowl as every other one: its share of
/// the sphere's area, 1/2. So after D bounces 2^-(D + 1) of the light is on its way.
void expect_half_and_half(const std::string& bowl) {
    const std::string inwards = "normal in = normal(normalize(point(0, 0, 4) - P)); ";
    for (const int depth : {1, 2, 3, 5}) {
        const double left = std::pow(0.5, depth + 1);
        // Some 3200 pixels of 16 rays, each of which is 0 or 1: twice four deviations, since rays of pixels
        // beside each other are not wholly independent.
        const double deviation = std::sqrt(left * (1 - left) / (3200 * 16));
        EXPECT_NEAR(white(bowl, inwards, depth), 1 - left, 8 * deviation + 1e-3) << depth;
    }
}

TEST(RayFurnace, ABowlLosesHalfAtEachBounce) {
    expect_half_and_half("Translate 0 0 4 Sphere 1 0 1 360");
}

/// The same bowl, blown up from half its radius.
TEST(RayFurnace, ADisplacedBowlDoes) {
    expect_half_and_half(
        "Attribute \"displacementbound\" \"sphere\" [.6] Attribute \"trace\" \"int displacements\" [1] "
        "Translate 0 0 4 Displacement \"blow\" Sphere .5 0 .5 360");
}

/// A corner of three squares. Of no point more is hidden than `most`, which is measured: After D
/// bounces at most that to the power of D + 1 is on its way.
TEST(RayFurnace, ACornerLosesNoMoreThanItHides) {
    const std::string corner =
        "Translate 0 0 5 Rotate -35.26 1 0 0 Rotate 45 0 1 0 Translate .5 -.5 .5 "
        "Polygon \"P\" [0 0 0 -1 0 0 -1 0 -1 0 0 -1] Polygon \"P\" [0 0 0 0 1 0 0 1 -1 0 0 -1] "
        "Polygon \"P\" [0 0 0 0 1 0 -1 1 0 -1 0 0] ";
    const std::string inwards = "normal in = faceforward(normalize(N), I); ";
    Case c;
    c.asker = kSeen;
    c.asks = "AttributeBegin " + corner + "AttributeEnd ";
    double most = 0, mean = 0, seen = 0;
    for (const Pixel& p : pixels(c.render(inwards + "Ci = occlusion(P, in, 256);")))
        if (p.alpha > 0)
            most = std::max(most, static_cast<double>(p.red)), mean += static_cast<double>(p.red), ++seen;
    mean /= seen;
    EXPECT_GT(seen, 1000);
    EXPECT_GT(mean, 0.1);
    EXPECT_LT(most, 0.9);
    for (const int depth : {1, 3, 7}) {
        const double found = white(corner, inwards, depth);
        EXPECT_GE(found, 1 - std::pow(most, depth + 1) - 5e-3) << depth;
        EXPECT_LE(found, 1 + 1e-5);
    }
}

}  // namespace
}  // namespace trapeze::testing
