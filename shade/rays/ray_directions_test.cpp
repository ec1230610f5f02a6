/// Directions of rays next to closed forms: well spread, of unit length, within their cones.
#include "shade/rays/ray_directions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <vector>

namespace trapeze {
namespace {

constexpr float kHalfTurn = std::numbers::pi_v<float>;

TEST(RaySequence, LiesInTheUnitSquare) {
    for (uint32_t seed = 0; seed < 2000; ++seed)
        for (const int count : {1, 2, 3, 7, 64, 1000}) {
            const RaySequence sequence(seed * 2654435761u, count);
            for (const int i : {0, count / 2, count - 1})
                for (int k = 0; k < 2; ++k) {
                    ASSERT_GE(sequence[i][k], 0) << seed << " " << i << " of " << count;
                    ASSERT_LT(sequence[i][k], 1) << seed << " " << i << " of " << count;
                }
        }
}

TEST(RaySequence, EachStratumHoldsOnePoint) {
    for (uint32_t seed = 0; seed < 20; ++seed)
        for (const int count : {1, 3, 16, 100, 256}) {
            const RaySequence sequence(seed, count);
            std::vector<int> columns(static_cast<size_t>(count));
            for (int i = 0; i < count; ++i) {
                // A hair over, for x is rounded to float: (i + shift) / count * count may be just below i.
                const double column = static_cast<double>(sequence[i].x) * count + 1e-5;
                ++columns.at(std::min(static_cast<size_t>(column), columns.size() - 1));
            }
            for (const int held : columns) ASSERT_EQ(held, 1) << count << " points of seed " << seed;
        }
}

/// Any run of 2^k points that begins at a multiple of 2^k has one in each 2^k-th part: van der Corput's
/// numbers keep this when their bits are flipped alike.
TEST(RaySequence, HalvesQuartersAndSoOnHoldTheirShare) {
    for (uint32_t seed = 0; seed < 20; ++seed) {
        const RaySequence sequence(seed, 256);
        for (const int run : {2, 4, 16, 64, 256})
            for (int first = 0; first < 256; first += run) {
                std::set<int> rows;
                for (int i = first; i < first + run; ++i)
                    rows.insert(static_cast<int>(sequence[i].y * static_cast<float>(run)));
                ASSERT_EQ(rows.size(), static_cast<size_t>(run)) << seed << " from " << first;
            }
    }
}

TEST(RaySequence, SeedsShiftItEverywhere) {
    constexpr int kSeeds = 4096, kCount = 4;
    double x = 0, y = 0;
    std::set<std::pair<float, float>> firsts;
    for (uint32_t seed = 0; seed < kSeeds; ++seed) {
        const V2f point = RaySequence(seed, kCount)[1];
        firsts.insert({point.x, point.y});
        x += static_cast<double>(point.x) / kSeeds;
        y += static_cast<double>(point.y) / kSeeds;
    }
    EXPECT_GT(firsts.size(), kSeeds - 4u);
    // Four deviations of means of numbers that are uniform in [1/4, 1/2) and in [0, 1).
    const double deviation = std::sqrt(1.0 / 12 / kSeeds);
    EXPECT_NEAR(x, 0.375, 4 * deviation / kCount);
    EXPECT_NEAR(y, 0.5, 4 * deviation);
    EXPECT_EQ(RaySequence(77, 9)[5], RaySequence(77, 9)[5]);
}

const V3f kAxes[] = {{0, 0, 1},
                     {0, 0, -1},
                     {1, 0, 0},
                     {0, -1, 0},
                     {0.6f, 0, -0.8f},
                     V3f(1, 2, 3).normalized(),
                     {1e-4f, 0, -1},
                     V3f(-0.001f, 0.002f, 1).normalized(),
                     {0, 0.8f, -0.0f + 0.6f},
                     V3f(-1, -1, -0.0f).normalized()};

/// A cone's directions of many seeds.
std::vector<V3f> directions(const V3f& axis, float angle, bool by_cosine) {
    std::vector<V3f> all;
    const Cone cone(axis, angle);
    for (uint32_t seed = 0; seed < 64; ++seed) {
        const RaySequence sequence(seed, 256);
        for (int i = 0; i < 256; ++i)
            all.push_back(by_cosine ? cone.by_cosine(sequence[i]) : cone.uniform(sequence[i]));
    }
    return all;
}

TEST(Cone, DirectionsAreOfUnitLengthWithinTheAngle) {
    for (const V3f& axis : kAxes)
        for (const float angle : {0.0f, 0.01f, 0.5f, kHalfTurn / 2, 2.5f, kHalfTurn})
            for (const bool by_cosine : {false, true}) {
                const float rim = by_cosine ? std::min(angle, kHalfTurn / 2) : angle;
                float least = 1;
                for (const V3f& direction : directions(axis, angle, by_cosine)) {
                    ASSERT_NEAR(direction.length(), 1, 2e-6f) << axis << angle;
                    least = std::min(least, direction.dot(axis));
                }
                // Cosines of small angles are known to some 1e-7.
                EXPECT_GT(least, std::cos(rim) - 1e-6f) << axis << angle;
                EXPECT_LT(least, std::cos(rim * 0.98f) + 1e-6f) << axis << angle << " the rim is reached";
            }
}

/// Means over a cone of the cosine to its axis and of the square of that, and the mean direction.
TEST(Cone, MeansAreThoseOfTheDensities) {
    for (const V3f& axis : kAxes)
        for (const float angle : {0.3f, 1.0f, kHalfTurn / 2, 2.5f, kHalfTurn})
            for (const bool by_cosine : {false, true}) {
                const std::vector<V3f> all = directions(axis, angle, by_cosine);
                const double n = static_cast<double>(all.size());
                double cosine = 0, square = 0;
                V3d mean(0, 0, 0);
                for (const V3f& direction : all) {
                    const double c = static_cast<double>(direction.dot(axis));
                    cosine += c / n, square += c * c / n;
                    mean += V3d(direction) / n;
                }
                const double r =
                    std::cos(static_cast<double>(by_cosine ? std::min(angle, kHalfTurn / 2) : angle));
                // Uniform: the cosine is uniform in [r, 1]. By the cosine: its square is uniform in [r^2, 1].
                const double mean_cosine = by_cosine ? 2.0 / 3 * (1 - r * r * r) / (1 - r * r) : (1 + r) / 2;
                const double mean_square = by_cosine ? (1 + r * r) / 2 : (1 + r + r * r) / 3;
                EXPECT_NEAR(cosine, mean_cosine, 2e-3) << axis << angle << by_cosine;
                EXPECT_NEAR(square, mean_square, 2e-3) << axis << angle << by_cosine;
                const V3d expected = V3d(axis) * mean_cosine;
                EXPECT_LT((mean - expected).length(), 4e-3) << axis << angle << by_cosine;
            }
}

/// About the axis no direction is better than others: the tensor of second moments says so.
TEST(Cone, TurnsEvenlyAboutTheAxis) {
    for (const V3f& axis : kAxes) {
        const V3f across = axis.cross(std::abs(axis.x) < 0.6f ? V3f(1, 0, 0) : V3f(0, 1, 0)).normalized();
        const V3f along = axis.cross(across);
        double xx = 0, yy = 0, xy = 0;
        const std::vector<V3f> all = directions(axis, 1, false);
        for (const V3f& direction : all) {
            const double x = static_cast<double>(direction.dot(across));
            const double y = static_cast<double>(direction.dot(along));
            xx += x * x, yy += y * y, xy += x * y;
        }
        const double n = static_cast<double>(all.size());
        EXPECT_NEAR(xx / n, yy / n, 4e-3) << axis;
        EXPECT_NEAR(xy / n, 0, 4e-3) << axis;
    }
}

}  // namespace
}  // namespace trapeze
