/// Light that goes round and round in closed things: a cube and a sphere, next to their sums of powers, and a
/// cube whose walls differ, next to form factors. At rest, while they move (next to the mean over the
/// shutter), and blown up by a displacement from things of half their size. What is hit beyond the D bounces
/// that are allowed is black.
#include <gtest/gtest.h>

#include "tests/rays/rays_harness.h"

namespace trapeze::testing {
namespace {

std::string bounces(int count) {
    return "Attribute \"trace\" \"int maxdiffusedepth\" [" + std::to_string(count) + "] ";
}

const char* const kMotion = "MotionBegin [0 1] Translate 0 0 0 Translate .6 -.4 .5 MotionEnd ";

const char* const kTurningCube =
    "Translate 0 0 4.5 MotionBegin [0 1] Rotate 0 1 2 3 Rotate 40 1 2 3 MotionEnd Translate 0 0 -4.5 ";

/// How walls come to be where they are, and where they go while the shutter is open.
struct CubePose {
    const char* name;
    const char* motion = "";
    bool displaced = false;
    bool together = false;  ///< the square that asks goes with them

    /// Before what stands about the middle, and is half as large where it is displaced.
    std::string before(const std::string& middle) const {
        return motion + ("Translate " + middle + " ") +
               (displaced ? "Attribute \"displacementbound\" \"sphere\" [6] "
                            "Attribute \"trace\" \"int displacements\" [1] "
                            "Displacement \"blow\" "
                          : "");
    }
    double size() const { return displaced ? 0.5 : 1; }
};

void PrintTo(const CubePose& pose, std::ostream* out) {
    *out << pose.name;
}

Case closed(int depth) {
    Case c;
    c.shaders["blow"] =
        "displacement blow() { P = transform(\"object\", \"current\", 2 * transform(\"object\", P));"
        "  N = calculatenormal(P); }";
    c.options = "Shutter 0 1 ";
    c.asker = bounces(depth) + "Attribute \"trace\" \"int samplemotion\" 1 ";
    return c;
}

class RayRadiosity : public ::testing::TestWithParam<CubePose> {};

/// A box of 4 x 4 x 7 with the square that asks inside of it, in a larger one: a ray that begins at an edge
/// may do so a rounding outside, and is as good in there.
std::string boxes(double size) {
    std::string points;
    for (const V3d& half : {V3d(2, 2, 3.5), V3d(3, 3, 4.5)})
        for (int i = 0; i < 8; ++i)
            for (int k = 0; k < 3; ++k)
                points += std::to_string((i >> k & 1 ? half[k] : -half[k]) * size) + " ";
    return "PointsPolygons [4 4 4 4 4 4 4 4 4 4 4 4] [0 1 3 2 4 5 7 6 0 1 5 4 2 3 7 6 0 2 6 4 1 3 7 5 "
           "8 9 11 10 12 13 15 14 8 9 13 12 10 11 15 14 8 10 14 12 9 11 15 13] \"P\" [" +
           points + "] ";
}

/// Walls that emit E and give back rho of what comes: after D bounces each has the sum of E rho^k, k < D,
/// wherever its rays go, so that one ray a point is exact; without bias, for rays that begin beside an edge
/// meet the other wall at once.
TEST_P(RayRadiosity, OfAnIntegratingCubeIsAGeometricSeries) {
    const float rho[3] = {0.25f, 0.5f, 0.75f}, emitted[3] = {1, 0.5f, 0.125f};
    for (const int depth : {1, 2, 3, 4}) {
        Case c = closed(depth);
        if (GetParam().together) c.asker += GetParam().motion;
        c.shaders["wall"] =
            "surface wall() { Oi = 1; Ci = color(1, .5, .125) +"
            " color(.25, .5, .75) * indirectdiffuse(P, faceforward(normalize(N), I), 1, \"bias\", 0); }";
        c.things =
            bounces(depth) + "Surface \"wall\" " + GetParam().before("0 0 4.5") + boxes(GetParam().size());
        const Image image = c.render("Ci = indirectdiffuse(P, normal(0, 0, -1), 1);");
        int seen = 0;
        for (const Pixel& p : pixels(image)) {
            if (p.alpha == 0) continue;
            ++seen;
            const float found[3] = {p.red, p.green, p.blue};
            for (int k = 0; k < 3; ++k) {
                float sum = 0;
                for (int bounce = 0; bounce < depth; ++bounce) sum = emitted[k] + rho[k] * sum;
                ASSERT_NEAR(found[k], sum, 1e-6f) << depth;
            }
        }
        EXPECT_GT(seen, 2000);
    }
}

/// A cube of the side 4 about (0, 0, 4): the wall at z = 2 has the radiosity 1, the others 1/4. So a point
/// has 1/4 and 3/4 of its form factor to that wall, by Lambert's formula, averaged over the way of the cube.
TEST_P(RayRadiosity, OfACubesWallsIsThatOfTheirFormFactors) {
    Case c = closed(1);
    if (GetParam().together) c.asker += GetParam().motion;
    c.functions =
        "float side(point p, a, b) { vector u = normalize(a - p), v = normalize(b - p);"
        "  return acos(clamp(u . v, -1, 1)) * zcomp(normalize(u ^ v)) / (2 * PI); }"
        "float factor(point p; vector way) { point m = point(0, 0, 2) + way;"
        "  point a = m + vector(-2, -2, 0), b = m + vector(2, -2, 0), c = m + vector(2, 2, 0);"
        "  point d = m + vector(-2, 2, 0);"
        "  return abs(side(p, a, b) + side(p, b, c) + side(p, c, d) + side(p, d, a)); } ";
    c.shaders["wall"] = "surface wall() { Oi = 1; Ci = zcomp(transform(\"object\", P)) < -1.999 ? 1 : .25; }";
    const double r = 2 * GetParam().size();
    c.things = "Surface \"wall\" " + GetParam().before("0 0 4") +
               "PointsPolygons [4 4 4 4 4 4] "
               "[0 1 3 2 4 5 7 6 0 1 5 4 2 3 7 6 0 2 6 4 1 3 7 5] \"P\" [";
    for (int i = 0; i < 8; ++i)
        for (int k = 0; k < 3; ++k) c.things += std::to_string(i >> k & 1 ? r : -r) + " ";
    c.things += "] ";
    constexpr int kSamples = 64;
    const std::string way =
        GetParam().together || !*GetParam().motion ? "vector(0, 0, 0)" : "vector(.6, -.4, .5) * i / 32";
    const Image image = c.render(
        "float expected = .25, i; for (i = .5; i < 32; i += 1) expected += .75 / 32 * factor(P, " + way +
        ");"
        "Ci = color(comp(indirectdiffuse(P, normal(0, 0, -1), " +
        std::to_string(kSamples) + "), 0), expected, 1);");
    double error = 0, square = 0, independent = 0, seen = 0;
    for (const Pixel& p : pixels(image)) {
        if (p.alpha == 0) continue;
        const double part = (static_cast<double>(p.green) - 0.25) / 0.75,
                     off = static_cast<double>(p.red - p.green);
        ++seen, error += off, square += off * off;
        independent += 0.5625 * part * (1 - part) / kSamples;
    }
    EXPECT_GT(seen, 2000);
    EXPECT_LE(square, independent * 1.05);
    EXPECT_NEAR(error / seen, 0, 4 * std::sqrt(independent) / seen + 2e-4);
}

/// A sphere that gives back half, of which two fifths emit: its zone x > R / 5. Each point sees as much of
/// every part of a sphere as is its share of the area, so that after D bounces 2/5 of the sum of 2^-k, k < D,
/// arrives everywhere. The camera looks into it through the half in front.
TEST_P(RayRadiosity, OfAnIntegratingSphereIsTheSameEverywhere) {
    const std::string arrives =
        "normal in = normal(transform(\"object\", \"current\", point(0, 0, 0)) - P);"
        "color arrives = indirectdiffuse(P, in, raydepth() == 0 ? 16 : 1);"
        "color sent = .5 * arrives + (xcomp(transform(\"object\", P)) > .2 ? 1 : 0); ";
    for (const int depth : {1, 2, 4}) {
        Case c = closed(depth);
        c.shaders["wall"] = "surface wall() { " + arrives + "Oi = 1; Ci = sent; }";
        const auto half = [&](const std::string& from, const std::string& to) {
            const std::string r = std::to_string(GetParam().size());
            return bounces(depth) + "Attribute \"trace\" \"float bias\" .01 " + GetParam().before("0 0 4") +
                   "Sphere " + r + " " + from + " " + to + " 360 ";
        };
        const std::string r = std::to_string(GetParam().size());
        c.things = "Surface \"wall\" " + half("-" + r, "0");
        c.asks = "AttributeBegin " + kSeen + half("0", r) + "AttributeEnd ";
        const Image image = c.render(arrives + "Ci = raydepth() == 0 ? arrives : sent;");
        double seen = 0, sum = 0, squares = 0;
        for (const Pixel& p : pixels(image)) {
            if (p.alpha == 0) continue;
            const auto found = static_cast<double>(p.red);
            ++seen, sum += found, squares += found * found;
        }
        EXPECT_GT(seen, 2000);
        const double mean = sum / seen, deviation = std::sqrt((squares / seen - mean * mean) / seen);
        EXPECT_NEAR(mean, 0.4 * (2 - std::pow(0.5, depth - 1)), 4 * deviation + 1e-3) << depth;
        EXPECT_LT(deviation, 4e-3);
    }
}

INSTANTIATE_TEST_SUITE_P(, RayRadiosity,
                         ::testing::Values(CubePose{"AtRest"}, CubePose{"Moving", kMotion},
                                           CubePose{"MovingTogether", kMotion, false, true},
                                           CubePose{"TurningTogether", kTurningCube, false, true},
                                           CubePose{"DisplacedAndTurningTogether", kTurningCube, true, true},
                                           CubePose{"Displaced", "", true},
                                           CubePose{"DisplacedAndMoving", kMotion, true}),
                         [](const ::testing::TestParamInfo<CubePose>& pose) { return pose.param.name; });

}  // namespace
}  // namespace trapeze::testing
