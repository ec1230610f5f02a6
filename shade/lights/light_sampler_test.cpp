/// Irradiance of lights by their samples next to closed forms [decision 0030].
#include "shade/lights/light_sampler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/random.h"
#include "core/ray_sequence.h"

namespace trapeze {
namespace {

constexpr double kPiOfLights = 3.14159265358979323846;

double dot(const V3f& a, const V3f& b) {
    return static_cast<double>(a.x * b.x + a.y * b.y + a.z * b.z);
}

/// What a face at P with the normal N gets of a light that shines with 1, over pi: by so many samples.
double seen(const LightSampler& light, const V3f& P, const V3f& N, int count, uint32_t seed = 1) {
    const RaySequence sequence(seed, count);
    double sum = 0;
    for (int i = 0; i < count; ++i) {
        const LightSample s = light.sample(P, N, sequence[i]);
        EXPECT_NEAR(s.N.length(), 1, 1e-5f);
        if (s.solid_angle == 0) continue;
        const V3f way = (s.P - P).normalized();
        EXPECT_LT(dot(way, s.N), 0) << "it shines towards P";
        sum += static_cast<double>(s.solid_angle * s.radiance.y) * std::max(0.0, dot(way, N));
    }
    return sum / count / kPiOfLights;
}

/// Of lights that are nowhere: N is along the light.
double seen_from_afar(const LightSampler& light, const V3f& N, int count, uint32_t seed = 1) {
    const RaySequence sequence(seed, count);
    double sum = 0;
    for (int i = 0; i < count; ++i) {
        const LightSample s = light.sample(V3f(0, 0, 1), N, sequence[i]);
        sum += static_cast<double>(s.solid_angle * s.radiance.y) * std::max(0.0, -dot(s.N, N));
    }
    return sum / count / kPiOfLights;
}

LightShape shape(LightShape::Kind kind) {
    LightShape made;
    made.kind = kind;
    return made;
}

/// Lambert's formula for polygons above the horizon: half the sum of their sides' angles, each by the cosine
/// between N and the normal of the plane through P and the side; over pi.
double of_polygon(const std::vector<V3f>& corners, const V3f& P, const V3f& N) {
    double sum = 0;
    for (size_t i = 0; i < corners.size(); ++i) {
        const V3d a = V3d(corners[i] - P).normalized(),
                  b = V3d(corners[(i + 1) % corners.size()] - P).normalized();
        sum += std::acos(std::clamp(a.dot(b), -1.0, 1.0)) * a.cross(b).normalized().dot(V3d(N));
    }
    return std::abs(sum) / (2 * kPiOfLights);
}

/// A rectangle of 3 by 2 in the plane z = 0, which shines along +z.
M44f stretched(float x, float y) {
    M44f m;
    m.setScale(V3f(x, y, 1));
    return m;
}

const V3f kPlaces[] = {V3f(0, 0, 1), V3f(2, 1, 0.5f), V3f(-1, 0.3f, 3), V3f(0.2f, -0.4f, 0.05f),
                       V3f(9, 8, 20)};

TEST(LightSamples, OfRectanglesGiveLambertsFormula) {
    const auto light = make_flat_sampler(shape(LightShape::Kind::Rect), stretched(3, 2));
    EXPECT_EQ(light->area(), 6);
    const std::vector<V3f> corners{V3f(-1.5f, -1, 0), V3f(1.5f, -1, 0), V3f(1.5f, 1, 0), V3f(-1.5f, 1, 0)};
    for (const V3f& P : kPlaces) {
        const double expected = of_polygon(corners, P, V3f(0, 0, -1));
        EXPECT_NEAR(seen(*light, P, V3f(0, 0, -1), 4096), expected, 0.003 * expected) << P;
    }
    // A face that stands upright, with all of the light above its horizon.
    const double upright = of_polygon(corners, V3f(-4, 0, 1), V3f(1, 0, 0));
    EXPECT_NEAR(seen(*light, V3f(-4, 0, 1), V3f(1, 0, 0), 4096), upright, 0.003 * upright);
    EXPECT_EQ(seen(*light, V3f(0.3f, 0, -1), V3f(0, 0, 1), 64), 0) << "behind it, it is dark";
    EXPECT_EQ(seen(*light, V3f(0.3f, 0, 0), V3f(0, 0, 1), 64), 0) << "and within its plane";
}

TEST(LightSamples, OfRectanglesThatAreAskewOrFarGiveLambertsFormula) {
    M44f askew;
    askew[0][0] = 2, askew[1][0] = 1, askew[1][1] = 1.5f;
    const auto light = make_flat_sampler(shape(LightShape::Kind::Rect), askew);
    const std::vector<V3f> corners{V3f(-1.5f, -.75f, 0), V3f(.5f, -.75f, 0), V3f(1.5f, .75f, 0),
                                   V3f(-.5f, .75f, 0)};
    for (const V3f& P : {V3f(0, 0, 1), V3f(2, 1, 2), V3f(300, 200, 400)}) {
        const double expected = of_polygon(corners, P, V3f(0, 0, -1));
        EXPECT_NEAR(seen(*light, P, V3f(0, 0, -1), 4096), expected, 0.003 * expected) << P;
    }
}

TEST(LightSamples, TwoSidedOnesShineToBothSides) {
    LightShape both = shape(LightShape::Kind::Rect);
    both.two_sided = true;
    const auto light = make_flat_sampler(both, stretched(3, 2));
    EXPECT_NEAR(seen(*light, V3f(0, 0, 1), V3f(0, 0, -1), 256),
                seen(*light, V3f(0, 0, -1), V3f(0, 0, 1), 256), 1e-4);
}

/// A disk of radius R, seen from a parallel face at a height and a distance from its axis.
double of_disk(double R, double height, double away) {
    const double h2 = height * height, a2 = away * away, sum = h2 + a2 + R * R;
    return (1 - (h2 + a2 - R * R) / std::sqrt(sum * sum - 4 * R * R * a2)) / 2;
}

/// Not even near the points from which it shines, where what rounds of the height would count for much.
TEST(LightSamples, WhatLiesInALightsPlaneIsDark) {
    M44f place;
    place.setAxisAngle(V3f(1, 2, 3).normalized(), 0.7f);
    place[3][0] = 30, place[3][1] = -7, place[3][2] = 11;
    for (const auto kind : {LightShape::Kind::Rect, LightShape::Kind::Disk}) {
        const auto light = make_flat_sampler(shape(kind), place);
        ASSERT_TRUE(light);
        int rounded = 0;
        for (uint32_t i = 0; i < 1000; ++i) {
            const V3f P = V3f(unit_float(hash(i, 1)) * 2 - 1, unit_float(hash(i, 2)) * 2 - 1, 0) * place;
            rounded += (P - V3f(30, -7, 11)).dot(V3f(place[2][0], place[2][1], place[2][2])) != 0;
            EXPECT_EQ(light->sample(P, V3f(0, 0, 1), V2f(.3f, .6f)).solid_angle, 0) << i;
        }
        EXPECT_GT(rounded, 200);
        const V3f above = V3f(.3f, .2f, -1e-4f) * place, below = V3f(.3f, .2f, 1e-4f) * place;
        EXPECT_NE(light->sample(above, V3f(0, 0, 1), V2f(.3f, .6f)).solid_angle == 0,
                  light->sample(below, V3f(0, 0, 1), V2f(.3f, .6f)).solid_angle == 0)
            << "one side";
    }
}

TEST(LightSamples, OfDisksGiveTheirFormFactor) {
    const auto light = make_flat_sampler(shape(LightShape::Kind::Disk), stretched(2, 2));
    EXPECT_NEAR(light->area(), static_cast<float>(kPiOfLights), 1e-5f);
    for (const V3f& P : kPlaces) {
        const double away = std::hypot(static_cast<double>(P.x), static_cast<double>(P.y)),
                     expected = of_disk(1, static_cast<double>(P.z), away);
        EXPECT_NEAR(seen(*light, P, V3f(0, 0, -1), 16384), expected, 0.01 * expected) << P;
    }
}

TEST(LightSamples, OfSpheresGiveTheSquaredSine) {
    M44f place = stretched(2, 2);
    place[2][2] = 2;
    place[3][2] = -4;
    const auto light = make_sphere_sampler(place);
    EXPECT_NEAR(light->area(), static_cast<float>(4 * kPiOfLights), 1e-4f);
    for (const V3f& P : {V3f(0, 0, 0), V3f(1, 2, 3), V3f(100, 0, 200), V3f(0, 0.1f, -2.9f)}) {
        const V3f N = (V3f(0, 0, -4) - P).normalized();
        const double expected = 1.0 / static_cast<double>((V3f(0, 0, -4) - P).length2());
        EXPECT_NEAR(seen(*light, P, N, 1024), expected, 0.002 * expected) << P;
    }
    EXPECT_EQ(seen(*light, V3f(0, 0.2f, -4), V3f(0, 0, 1), 64), 0) << "inside it is dark";
}

/// An ellipsoid is seen as its outline: here, from far away along z, as an ellipse.
TEST(LightSamples, OfEllipsoidsGiveTheirOutline) {
    M44f place = stretched(4, 1);
    place[3][2] = -100;
    const auto light = make_sphere_sampler(place);
    const double expected = 2 * 0.5 / (100 * 100);  // pi a b / d^2, over pi
    EXPECT_NEAR(seen(*light, V3f(0), V3f(0, 0, -1), 1024), expected, 0.005 * expected);
}

/// What a face gets of a cylinder around the x axis, open at its ends: by sums over its sides.
double of_cylinder(double radius, double length, const V3d& middle, const V3f& P, const V3f& N) {
    constexpr int kSteps = 1000;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i)
        for (int j = 0; j < kSteps; ++j) {
            const double angle = 2 * kPiOfLights * (i + 0.5) / kSteps;
            const V3d normal(0, std::cos(angle), std::sin(angle));
            const V3d way =
                V3d(P) - (middle + normal * radius + V3d(length * ((j + 0.5) / kSteps - 0.5), 0, 0));
            sum +=
                std::max(0.0, way.dot(normal)) * std::max(0.0, -way.dot(V3d(N))) / std::pow(way.length2(), 2);
        }
    return sum * 2 * kPiOfLights * radius * length / (double(kSteps) * kSteps) / kPiOfLights;
}

TEST(LightSamples, OfCylindersGiveTheirQuadrature) {
    M44f place = stretched(3, 2);
    place[2][2] = 2;
    place[3][2] = -4;
    const auto light = make_cylinder_sampler(place);
    EXPECT_NEAR(light->area(), static_cast<float>(6 * kPiOfLights), 1e-4f);
    for (const V3f& P : {V3f(0, 0, 0), V3f(1, 2, 3), V3f(4, 0, -1), V3f(0.3f, 0.1f, -2.8f)}) {
        const V3f N = (V3f(0, 0, -4) - P).normalized();
        const double expected = of_cylinder(1, 3, V3d(0, 0, -4), P, N);
        EXPECT_NEAR(seen(*light, P, N, 4096), expected, 0.003 * expected) << P;
    }
    EXPECT_EQ(seen(*light, V3f(0, 0.2f, -4), V3f(0, 0, 1), 64), 0) << "inside it is dark";
    EXPECT_EQ(seen(*light, V3f(9, 0.2f, -4), V3f(-1, 0, 0), 64), 0) << "its ends are open";
}

/// A tube flattened to an ellipse across, and skewed along: from far away it is its outline.
TEST(LightSamples, OfSkewedCylindersGiveTheirOutline) {
    M44f place = stretched(4, 1);
    place[2][2] = 3, place[0][1] = 2;
    place[3][2] = -200;
    const auto light = make_cylinder_sampler(place);
    const double expected = 4 * 1 / (200.0 * 200) / kPiOfLights;  // its length along x by its width along y
    EXPECT_NEAR(seen(*light, V3f(0), V3f(0, 0, -1), 4096), expected, 0.01 * expected);
}

/// A square of two triangles, and one of very many that has another order of corners.
TEST(LightSamples, OfMeshesGiveLambertsFormula) {
    const V3f a(-1, -1, 0), b(1, -1, 0), c(1, 1, 0), d(-1, 1, 0);
    LightMesh two;
    two.triangles = {{a, b, c}, {a, c, d}};
    LightMesh many;
    for (int j = 0; j < 16; ++j)
        for (int i = 0; i < 16; ++i) {
            const auto at = [&](int x, int y) {
                return V3f(static_cast<float>(x) / 8 - 1, static_cast<float>(y) / 8 - 1, 0);
            };
            many.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
            many.triangles.push_back({at(i + 1, j + 1), at(i, j + 1), at(i + 1, j)});
        }
    for (const LightMesh& mesh : {two, many}) {
        const auto light = make_mesh_sampler(mesh, false);
        EXPECT_NEAR(light->area(), 4, 1e-5f);
        for (const V3f& P : {V3f(0, 0, 1), V3f(2, 1, 0.5f), V3f(9, 8, 20)}) {
            const double expected = of_polygon({a, b, c, d}, P, V3f(0, 0, -1));
            EXPECT_NEAR(seen(*light, P, V3f(0, 0, -1), 16384), expected, 0.01 * expected) << P;
        }
        EXPECT_EQ(seen(*light, V3f(0, 0, -1), V3f(0, 0, 1), 64), 0);
    }
}

/// However wide the disk is, a face turned to it is as bright as the light says.
TEST(LightSamples, OfDisksInTheSkyLightWhatIsTurnedToThem) {
    for (const float angle : {0.0f, 0.0046f, 0.3f, 1.5f}) {
        const auto light = make_distant_sampler(angle, M44f());
        EXPECT_EQ(light->is_point(), angle == 0);
        EXPECT_NEAR(seen_from_afar(*light, V3f(0, 0, -1), 256), 1, 0.002) << angle;
        if (angle < 0.5f) {
            EXPECT_NEAR(seen_from_afar(*light, V3f(0, 0.8f, -0.6f), 1024), 0.6, 0.002) << angle;
        }
        EXPECT_NEAR(seen_from_afar(*light, V3f(0, 0, 1), 256), 0, angle > 1 ? 1.0 : 0.0);
    }
}

std::unique_ptr<LightSampler> dome_of(const SkyPicture& map, const M44f& space) {
    return std::move(make_dome_samplers(map, std::span(&space, 1)).front());
}

TEST(LightSamples, OfAWhiteDomeLightAllFacesAlike) {
    const auto light = dome_of({}, M44f());
    for (const V3f& N : {V3f(0, 0, -1), V3f(0.6f, 0, -0.8f), V3f(0, 1, 0), V3f(0, 0, 1)})
        EXPECT_NEAR(seen_from_afar(*light, N, 1024), 1, 0.01) << N;
    // Sixteen are near already, for most follow the normal.
    EXPECT_NEAR(seen_from_afar(*light, V3f(0, 0, -1), 16, 7), 1, 0.08);
}

/// A sky with a sun a thousand times as bright in one of its pixels, next to sums over all pixels.
TEST(LightSamples, OfAMapGiveItsQuadrature) {
    SkyPicture map;
    map.width = 32, map.height = 16;
    for (int i = 0; i < 32 * 16; ++i) {
        const float sky = 0.2f + 0.8f * unit_float(hash(static_cast<uint32_t>(i)));
        map.colors.emplace_back(i == 5 * 32 + 9 ? 1000 * sky : sky);
    }
    M44f turned;
    turned.rotate(V3f(0.4f, 0.7f, -1.1f));
    const auto light = dome_of(map, turned);
    for (const V3f& N : {V3f(0, 0, 1), V3f(0.6f, 0, -0.8f), V3f(0, 1, 0)}) {
        double expected = 0;
        constexpr int kParts = 16;  // of a pixel, each way
        for (int row = 0; row < 16 * kParts; ++row)
            for (int column = 0; column < 32 * kParts; ++column) {
                const double down = kPiOfLights * (row + 0.5) / (16 * kParts),
                             turn = 2 * kPiOfLights * (column + 0.5) / (32 * kParts);
                V3f way(static_cast<float>(std::cos(turn) * std::sin(down)),
                        static_cast<float>(std::sin(turn) * std::sin(down)),
                        static_cast<float>(std::cos(down)));
                turned.multDirMatrix(V3f(way), way);
                const V3f& color = map.colors[static_cast<size_t>(row / kParts * 32 + column / kParts)];
                expected += static_cast<double>(color.y) * std::max(0.0, dot(way, N)) * std::sin(down) *
                            (kPiOfLights / (16 * kParts)) * (2 * kPiOfLights / (32 * kParts)) / kPiOfLights;
            }
        EXPECT_NEAR(seen_from_afar(*light, N, 16384), expected, 0.01 * expected) << N;
    }
}

/// Over 16 seeds: four times as many samples make a quarter of the mean squared error at most, and strata
/// help.
TEST(LightSamples, ErrorsFallAtLeastAsOneOverTheirNumber) {
    const std::vector<V3f> corners{V3f(-.5f, -.5f, 0), V3f(.5f, -.5f, 0), V3f(.5f, .5f, 0),
                                   V3f(-.5f, .5f, 0)};
    const V3f P(0.4f, 0.2f, 0.6f), N(0, 0, -1);
    LightMesh mesh;
    mesh.triangles = {{corners[0], corners[1], corners[2]}, {corners[0], corners[2], corners[3]}};
    const double expected = of_polygon(corners, P, N);
    for (const auto& light : {make_flat_sampler(shape(LightShape::Kind::Rect), M44f()).release(),
                              make_mesh_sampler(mesh, false).release()}) {
        double before = 1;
        for (const int count : {4, 16, 64, 256}) {
            double square = 0;
            for (uint32_t seed = 0; seed < 256; ++seed)
                square += std::pow(seen(*light, P, N, count, hash(seed)) - expected, 2) / 256;
            EXPECT_LT(square, before / 4 * 1.15) << count;
            before = square;
        }
        delete light;
    }
}

TEST(LightSamples, ShapesOfNoAreaMakeNone) {
    M44f flat;
    flat[0][0] = 0;
    const auto not_finite = M44f(INFINITY, 0, 0, 0, 0, NAN, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1);
    for (const M44f& m : {flat, not_finite}) {
        EXPECT_EQ(make_flat_sampler(shape(LightShape::Kind::Rect), m), nullptr);
        EXPECT_EQ(make_flat_sampler(shape(LightShape::Kind::Disk), m), nullptr);
        EXPECT_EQ(make_sphere_sampler(m), nullptr);
        EXPECT_EQ(make_cylinder_sampler(m), nullptr);
    }
    LightMesh needle;
    needle.triangles = {{V3f(0), V3f(1), V3f(2)}, {V3f(0), V3f(NAN), V3f(1, 0, 0)}};
    EXPECT_EQ(make_mesh_sampler(needle, true), nullptr);
    EXPECT_EQ(make_mesh_sampler({}, true), nullptr);
    M44f no_axis;
    no_axis[2][2] = 0;
    EXPECT_EQ(make_distant_sampler(0.1f, no_axis), nullptr);
    SkyPicture black;
    black.width = 2, black.height = 1;
    black.colors.assign(2, V3f(0));
    EXPECT_EQ(dome_of(black, M44f()), nullptr);
}

}  // namespace
}  // namespace trapeze
