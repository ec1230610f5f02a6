#include "sample/patterns/lens_shape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <random>
#include <vector>

#include "core/simd/targets_harness.h"
#include "sample/frame_harness.h"
#include "sample/patterns/stratified_pattern.h"

namespace trapeze {
namespace {

using testing::for_each_target;
using testing::frame_of_samples;
using testing::TestFrame;

const Aperture kShapes[] = {{3, 0, 0, 0},      {4, 45, 0, 0},   {5, 36, .5f, 0},  {5, 36, -.8f, .7f},
                            {6, 15, -1, -1},   {3, -77, -1, 1}, {4, 10, -1, 0},   {7, 123, 0, .4f},
                            {128, 5, 0, -.5f}, {8, 0, 1, 1},    {3, 20, 1, .01f}, {100, 350, -.3f, 0},
                            {6, 0, 0, -1},     {0, 0, 0, 1},    {2, 30, -1, -.6f}};

/// Points of a net over the square, its borders, diagonals and middle included.
std::vector<V2f> net(int side) {
    std::vector<V2f> points;
    for (int j = 0; j <= side; ++j)
        for (int i = 0; i <= side; ++i)
            points.push_back({std::min(static_cast<float>(i) / static_cast<float>(side), kBelowOne),
                              std::min(static_cast<float>(j) / static_cast<float>(side), kBelowOne)});
    return points;
}

TEST(LensShape, FewerThanThreeBladesAndFullRoundnessAreTheDiskBitForBit) {
    for (const Aperture& aperture :
         {Aperture{}, {1, 30, 0, 0}, {2, 0, -1, 0}, {6, 10, 1, 0}, {200, 0, 0, 0}}) {
        const LensShape shape(aperture);
        EXPECT_EQ(shape.outline().size(), 0u);
        for (const V2f& p : net(100)) {
            const V2f disk = disk_from_square(p.x, p.y), made = shape.from_square(p.x, p.y);
            ASSERT_EQ(std::bit_cast<uint32_t>(made.x), std::bit_cast<uint32_t>(disk.x));
            ASSERT_EQ(std::bit_cast<uint32_t>(made.y), std::bit_cast<uint32_t>(disk.y));
        }
        for (uint32_t i = 0; i < 12; ++i) EXPECT_EQ(shape.region(i, 4, 3), lens_region(i, 4, 3));
    }
}

/// Straight sides: every point is on the inner side of each, and every corner and side's middle is reached.
TEST(LensShape, APolygonsPointsLieInItAndFillIt) {
    for (const int blades : {3, 4, 5, 6, 9})
        for (const float angle : {0.0f, 17.0f, 200.0f, -90.0f}) {
            const LensShape shape({blades, angle, 0, 0});
            ASSERT_EQ(shape.outline().size(), static_cast<size_t>(blades));
            const double half = M_PI / blades;
            std::vector<double> nearest(static_cast<size_t>(2 * blades), 9);
            for (const V2f& p : net(240)) {
                const V2f at = shape.from_square(p.x, p.y);
                for (int k = 0; k < 2 * blades; ++k) {
                    const double turn = angle * M_PI / 180 + k * half;  // corners are even, middles are odd
                    const double along = at.x * std::cos(turn) + at.y * std::sin(turn);
                    const double rim = k % 2 == 0 ? 1 : std::cos(half);
                    ASSERT_LE(along, rim + 1e-6) << blades;
                    double& found = nearest[static_cast<size_t>(k)];
                    found =
                        std::min(found, std::hypot(at.x - rim * std::cos(turn), at.y - rim * std::sin(turn)));
                }
            }
            for (const double distance : nearest) EXPECT_LT(distance, 0.03) << blades;
        }
}

/// Area of the opening: triangles from the middle to straight chords, and segments of circles on them.
double area_of(const Aperture& a) {
    if (a.is_round()) return M_PI;
    const double half = M_PI / a.blades, c = std::sin(half), h = std::cos(half);
    const double bend = a.roundness * (a.roundness >= 0 ? half : std::min(half, M_PI / 2 - half));
    if (bend == 0) return a.blades * h * c;
    const double radius = c / std::sin(std::abs(bend)), arc = 2 * std::abs(bend);
    return a.blades * (h * c + std::copysign(radius * radius / 2 * (arc - std::sin(arc)), bend));
}

TEST(LensOutline, TrianglesHaveOneAreaAndTheShapesTogether) {
    for (const Aperture& aperture : kShapes) {
        const LensOutline outline(aperture);
        double least = 9, most = 0, sum = 0;
        for (size_t i = 0; i < outline.size(); ++i) {
            const double area = (static_cast<double>(outline.x[i]) * outline.dy[i] -
                                 static_cast<double>(outline.y[i]) * outline.dx[i]) /
                                2;
            least = std::min(least, area), most = std::max(most, area), sum += area;
            ASSERT_LE(std::hypot(outline.x[i], outline.y[i]), 1.000001);
        }
        ASSERT_LT(most - least, 1e-6) << aperture.blades << " " << aperture.roundness;
        EXPECT_NEAR(sum, area_of(aperture), 6e-4 * M_PI) << aperture.blades << " " << aperture.roundness;
    }
}

/// Triangles of the square map to triangles of the lens whose areas are in one proportion everywhere.
TEST(LensShape, KeepsAreasInProportion) {
    std::mt19937 engine(5);
    std::uniform_real_distribution<double> unit(0, 1);
    for (const Aperture& aperture : kShapes) {
        if (aperture.density != 0) continue;
        const LensShape shape(aperture);
        const double expected = area_of(aperture);
        int within = 0;
        constexpr int kTried = 2000;
        for (int n = 0; n < kTried; ++n) {
            const double x = unit(engine) * .99, y = unit(engine) * .99, s = 1e-2;
            const auto at = [&](double u, double v) {
                return shape.from_square(static_cast<float>(u), static_cast<float>(v));
            };
            const V2f o = at(x, y), p = at(x + s, y), q = at(x, y + s);
            const double area = (static_cast<double>(p.x) - o.x) * (static_cast<double>(q.y) - o.y) -
                                (static_cast<double>(p.y) - o.y) * (static_cast<double>(q.x) - o.x);
            within += std::abs(area / (s * s) / expected - 1) < 2e-3;
        }
        // Those across a ray of the fan are bent: with hundreds of rays many are, with few hardly any.
        EXPECT_GT(within, shape.outline().size() < 16 ? kTried * 9 / 10 : kTried / 10) << aperture.blades;
    }
}

struct Moments {
    double x = 0, y = 0, xx = 0, xy = 0, yy = 0;

    explicit Moments(const LensShape& shape) {
        constexpr int kSide = 1000;
        for (int j = 0; j < kSide; ++j)
            for (int i = 0; i < kSide; ++i) {
                const V2f p = shape.from_square((static_cast<float>(i) + .5f) / kSide,
                                                (static_cast<float>(j) + .5f) / kSide);
                const double px = p.x, py = p.y, weight = 1.0 / (kSide * kSide);
                x += px * weight, y += py * weight;
                xx += px * px * weight, xy += px * py * weight, yy += py * py * weight;
            }
    }
};

/// Regular polygons' second moments are (2 + cos(2 pi / n)) / 12 about any axis.
TEST(LensShape, PolygonsHaveTheirMoments) {
    for (const int blades : {3, 4, 5, 6, 8, 11})
        for (const float density : {0.0f, 1.0f, -1.0f, 0.3f}) {
            const Moments found(LensShape({blades, 25, 0, density}));
            // The mean of r'^2 is 1/2 where all is even: integral of s (1 + d (2 s - 1)) over s = r'^2 else.
            const double spread = (0.5 + density / 6) / 0.5;
            const double second = (2 + std::cos(2 * M_PI / blades)) / 12 * spread;
            EXPECT_NEAR(found.x, 0, 1e-4);
            EXPECT_NEAR(found.y, 0, 1e-4);
            EXPECT_NEAR(found.xx, second, 2e-4) << blades << " " << density;
            EXPECT_NEAR(found.yy, second, 2e-4) << blades << " " << density;
            EXPECT_NEAR(found.xy, 0, 2e-4) << blades << " " << density;
        }
}

TEST(LensShape, BrightnessIsLinearInTheAreaWithin) {
    constexpr int kRings = 10, kSide = 1000;
    std::mt19937 engine(6);
    std::uniform_real_distribution<float> unit(0, 1);
    for (const float density : {-1.0f, -.4f, .4f, 1.0f}) {
        const LensShape shape({6, 0, 0, density});
        std::vector<double> rings(kRings);
        for (int j = 0; j < kSide; ++j)
            for (int i = 0; i < kSide; ++i) {
                const V2f p = shape.from_square((static_cast<float>(i) + unit(engine)) / kSide,
                                                (static_cast<float>(j) + unit(engine)) / kSide);
                double rim = 0;  // distance in the polygon's own measure
                for (int k = 0; k < 6; ++k) {
                    const double turn = (k + .5) * M_PI / 3;
                    rim = std::max(rim, (p.x * std::cos(turn) + p.y * std::sin(turn)) / std::cos(M_PI / 6));
                }
                ++rings[static_cast<size_t>(std::min(rim * rim * kRings, kRings - 1.0))];
            }
        for (int ring = 0; ring < kRings; ++ring) {
            const double middle = (ring + .5) / kRings;
            EXPECT_NEAR(rings[static_cast<size_t>(ring)] * kRings / (kSide * kSide),
                        1 + density * (2 * middle - 1), .01)
                << density << " " << ring;
        }
    }
}

/// As for the disk: the box holds all of its region, and little more.
TEST(LensShape, RegionsHoldTheirPointsTightly) {
    for (const Aperture& aperture : kShapes) {
        const LensShape shape(aperture);
        for (const auto& [nx, ny] : {std::pair{1, 1}, {2, 2}, {3, 3}, {8, 8}, {4, 2}, {1, 5}, {13, 13}})
            for (int cell = 0; cell < nx * ny; ++cell) {
                const LensBox box = shape.region(static_cast<uint32_t>(cell), nx, ny);
                LensBox seen{2, 2, -2, -2};
                for (const V2f& p : net(64)) {
                    const V2f at = shape.from_square(place(static_cast<uint32_t>(cell % nx), p.x, nx),
                                                     place(static_cast<uint32_t>(cell / nx), p.y, ny));
                    seen = {std::min(seen.min_u, at.x), std::min(seen.min_v, at.y),
                            std::max(seen.max_u, at.x), std::max(seen.max_v, at.y)};
                }
                ASSERT_LE(box.min_u, seen.min_u);
                ASSERT_LE(box.min_v, seen.min_v);
                ASSERT_GE(box.max_u, seen.max_u);
                ASSERT_GE(box.max_v, seen.max_v);
                const float wide = seen.max_u - seen.min_u, high = seen.max_v - seen.min_v;
                const float slack = .25f * std::max(wide, high) + 1e-4f;
                ASSERT_LE(box.max_u - box.min_u, wide + slack) << aperture.blades << " " << nx << " " << cell;
                ASSERT_LE(box.max_v - box.min_v, high + slack) << aperture.blades << " " << nx << " " << cell;
            }
    }
}

/// A pixel's samples on the lens are one of each cell: over a pixel, random numbers could be all on one side.
TEST(LensShape, SamplesOfPixelsFillItEvenly) {
    constexpr int kSectors = 6, kRings = 6, kCells = kSectors * kRings;
    TestFrame frame = frame_of_samples(6, 6);
    frame.context.camera.aperture = {6, 0, 0, 0};
    const StratifiedPattern pattern(frame.context);
    SampleTile tile;
    pattern.make_tile({0, 0, 64, 64}, tile);
    std::vector<double> cells(kCells);
    for (size_t i = 0; i < tile.size(); ++i) {
        const double u = tile.lens_u[i], v = tile.lens_v[i];
        double turn = std::atan2(v, u) / (M_PI / 3);
        if (turn < 0) turn += 6;
        const auto sector = std::min(static_cast<size_t>(turn), size_t{kSectors - 1});
        const double middle = (static_cast<double>(sector) + .5) * M_PI / 3;
        const double r = (u * std::cos(middle) + v * std::sin(middle)) / std::cos(M_PI / 6);
        ++cells[sector * kRings + static_cast<size_t>(std::min(r * r * kRings, kRings - 1.0))];
    }
    const double expected = static_cast<double>(tile.size()) / kCells;
    double chi_square = 0;
    for (const double n : cells) chi_square += (n - expected) * (n - expected) / expected;
    EXPECT_LT(chi_square, 66);  // 35 degrees of freedom, one in a thousand
}

TEST(LensShape, EveryInstructionSetMakesTheSamePoints) {
    for (const Aperture& aperture : kShapes)
        for (const int side : {1, 3, 8}) {
            TestFrame frame = frame_of_samples(side, side);
            frame.context.camera.aperture = aperture;
            const StratifiedPattern pattern(frame.context);
            std::vector<LensBox> boxes;
            for (int sample = 0; sample < side * side; ++sample) boxes.push_back(pattern.lens_bounds(sample));
            std::vector<uint32_t> first;
            for_each_target([&] {
                SampleTile tile;
                pattern.make_tile({-3, 0, 20, 7}, tile);
                std::vector<uint32_t> bits;
                for (size_t i = 0; i < tile.size(); ++i) {
                    const LensBox& box = boxes[i % boxes.size()];
                    ASSERT_TRUE(tile.lens_u[i] >= box.min_u && tile.lens_u[i] <= box.max_u);
                    ASSERT_TRUE(tile.lens_v[i] >= box.min_v && tile.lens_v[i] <= box.max_v);
                    bits.push_back(std::bit_cast<uint32_t>(tile.lens_u[i]));
                    bits.push_back(std::bit_cast<uint32_t>(tile.lens_v[i]));
                }
                if (first.empty()) first = bits;
                EXPECT_TRUE(bits == first) << aperture.blades;
            });
        }
}

}  // namespace
}  // namespace trapeze
