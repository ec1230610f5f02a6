/// What every pattern of samples promises.
#include "sample/patterns/sample_pattern.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "sample/frame_harness.h"

namespace trapeze {
namespace {

using testing::frame_of_samples;
using testing::TestFrame;

/// Each pattern of the table, with each value of its options.
std::vector<std::string> every_pattern() {
    std::vector<std::string> names;
    for (const PatternKind& kind : sample_patterns()) {
        if (kind.options.empty()) names.emplace_back(kind.name);
        for (const SpecOption& option : kind.options)
            for (const std::string_view value : option.values)
                names.push_back(std::string(kind.name) + ':' + std::string(option.name) + '=' +
                                std::string(value));
    }
    return names;
}

/// A point of a lens, in its own measure: in which of 2 * blades sectors from a corner to a side's middle,
/// and how far out, as a part of the way to the rim.
struct OnBlades {
    int sector;
    double out;
};

/// A side is an arc of a circle through two corners. Where it does not bow it is half of the way around the
/// middle, seen from the middle of the lens, at the chord.
OnBlades on_blades(const Aperture& lens, double u, double v) {
    const double half = M_PI / lens.blades, chord = std::cos(half);
    double turn = std::remainder(std::atan2(v, u) - lens.angle * M_PI / 180, 2 * M_PI);
    if (turn < 0) turn += 2 * M_PI;
    const int sector = std::min(static_cast<int>(turn / half), 2 * lens.blades - 1);
    const double from_middle = turn - (sector / 2 * 2 + 1) * half;  // of the side
    const double bend = lens.roundness * (lens.roundness >= 0 ? half : std::min(half, M_PI / 2 - half));
    double rim = chord / std::cos(from_middle);
    if (bend != 0) {
        const double radius = std::sin(half) / std::sin(std::abs(bend)), sign = std::copysign(1, bend);
        const double centre = chord - sign * radius * std::cos(bend);
        const double aside = centre * std::sin(from_middle);
        rim = centre * std::cos(from_middle) + sign * std::sqrt(radius * radius - aside * aside);
    }
    return {sector, std::hypot(u, v) / rim};
}

class EveryPattern : public ::testing::TestWithParam<std::string> {
  protected:
    static SampleTile tile_of(const TestFrame& frame, const PixelRect& pixels) {
        std::string error;
        const auto spec = parse_pattern(GetParam(), &error);
        SampleTile tile;
        if (!spec)
            ADD_FAILURE() << error;
        else
            make_sample_pattern(frame.context, *spec)->make_tile(pixels, tile);
        return tile;
    }
};

TEST_P(EveryPattern, StaysInThePixelTheDiskAndTheShutter) {
    TestFrame frame = frame_of_samples(8, 8);
    frame.options.width = 20000, frame.update();
    for (const PixelRect& pixels : {PixelRect{-16, -16, 0, 0},
                                    {-15, -16, 0, 3},
                                    {16384, 4096, 16400, 4112},
                                    {16384, 4097, 16400, 4112}}) {
        const SampleTile tile = tile_of(frame, pixels);
        ASSERT_EQ(tile.size(), static_cast<size_t>(pixels.width() * pixels.height() * 64));
        for (size_t i = 0; i < tile.size(); ++i) {
            const int pixel = static_cast<int>(i) / tile.samples_per_pixel;
            ASSERT_EQ(std::floor(tile.x[i]), static_cast<float>(pixels.x0 + pixel % pixels.width()));
            ASSERT_EQ(std::floor(tile.y[i]), static_cast<float>(pixels.y0 + pixel / pixels.width()));
            ASSERT_LE(std::hypot(tile.lens_u[i], tile.lens_v[i]), 1.00001f);
            ASSERT_GE(tile.time[i], 0);
            ASSERT_LT(tile.time[i], 1);
        }
    }
}

TEST_P(EveryPattern, LooksThroughTheOpenPartOfTheLens) {
    TestFrame frame = frame_of_samples(8, 8);
    frame.context.camera.aperture = {4, 0, 0, 0};
    const SampleTile tile = tile_of(frame, {0, 0, 16, 16});
    float most = 0;
    for (size_t i = 0; i < tile.size(); ++i) {
        const float from_middle = std::abs(tile.lens_u[i]) + std::abs(tile.lens_v[i]);
        ASSERT_LE(from_middle, 1.00001f);  // a square on its corner
        most = std::max(most, from_middle);
    }
    EXPECT_GT(most, .98f);
}

/// All sectors have one area. The light in a part of it, from the middle to the share s of a sector's area,
/// is s + d (s^2 - s) of the sector's with the density d.
TEST_P(EveryPattern, LooksThroughAllPartsOfTheLensAsTheirLightSays) {
    constexpr int kRings = 4;
    for (const Aperture& lens : {Aperture{5, 36, 0, 0},
                                 {3, -20, 0, .8f},
                                 {6, 15, 0, -1},
                                 {4, 10, .6f, 0},
                                 {5, 20, -.8f, 0},
                                 {7, 77, -.4f, .9f},
                                 {3, 100, .5f, -.7f}}) {
        TestFrame frame = frame_of_samples(24, 24);
        frame.context.camera.aperture = lens;
        const SampleTile tile = tile_of(frame, {-4, 0, 4, 8});
        std::set<std::pair<float, float>> points;  // patterns may repeat theirs
        for (size_t i = 0; i < tile.size(); ++i) points.insert({tile.lens_u[i], tile.lens_v[i]});
        ASSERT_GE(points.size(), size_t{24 * 24});
        std::vector<double> found(static_cast<size_t>(2 * lens.blades * kRings));
        for (const auto& [u, v] : points) {
            const auto [sector, out] = on_blades(lens, u, v);
            ASSERT_LE(out, 1.0005) << lens.blades << " " << lens.roundness;  // arcs are chains of chords
            const int ring = std::min(static_cast<int>(out * out * kRings), kRings - 1);
            ++found[static_cast<size_t>(sector * kRings + ring)];
        }
        double chi_square = 0;
        for (size_t cell = 0; cell < found.size(); ++cell) {
            const double inner = static_cast<double>(cell % kRings) / kRings, outer = inner + 1.0 / kRings;
            const auto light = [&](double share) { return share + lens.density * (share * share - share); };
            const double expected =
                static_cast<double>(points.size()) * (light(outer) - light(inner)) / (2 * lens.blades);
            chi_square += (found[cell] - expected) * (found[cell] - expected) / expected;
        }
        // What independent points pass once in a thousand times [Wilson, Hilferty]; these are more even.
        const double freedom = static_cast<double>(found.size()) - 1, part = 2 / (9 * freedom);
        EXPECT_LT(chi_square, freedom * std::pow(1 - part + 3.09 * std::sqrt(part), 3))
            << lens.blades << " " << lens.roundness << " " << lens.density;
    }
}

TEST_P(EveryPattern, APixelsSamplesDoNotDependOnTheTile) {
    const TestFrame frame = frame_of_samples(3, 3);
    const SampleTile large = tile_of(frame, {-4, -4, 12, 12}), small = tile_of(frame, {5, -1, 7, 3});
    for (int py = -1; py < 3; ++py)
        for (int px = 5; px < 7; ++px)
            for (size_t i = 0; i < 9; ++i) {
                const size_t a = large.first_of_pixel(px, py) + i, b = small.first_of_pixel(px, py) + i;
                ASSERT_EQ(large.x[a], small.x[b]);
                ASSERT_EQ(large.y[a], small.y[b]);
                ASSERT_EQ(large.lens_u[a], small.lens_u[b]);
                ASSERT_EQ(large.lens_v[a], small.lens_v[b]);
                ASSERT_EQ(large.time[a], small.time[b]);
                ASSERT_EQ(large.rays[a].ux, small.rays[b].ux);
            }
}

TEST_P(EveryPattern, RaysAreTheCameras) {
    const TestFrame frame = frame_of_samples(2, 2);
    const SampleTile tile = tile_of(frame, {3, 3, 6, 6});
    for (size_t i = 0; i < tile.size(); ++i) {
        const AxisRay ray =
            frame.context.camera.ray(tile.x[i], tile.y[i], tile.lens_u[i], tile.lens_v[i], tile.time[i]);
        ASSERT_EQ(tile.rays[i].ox, ray.ox);
        ASSERT_EQ(tile.rays[i].oy, ray.oy);
        ASSERT_EQ(tile.rays[i].ux, ray.ux);
        ASSERT_EQ(tile.rays[i].uy, ray.uy);
        ASSERT_EQ(tile.rays[i].time, tile.time[i]);
    }
}

TEST_P(EveryPattern, WithoutMotionOrLensTheseAreZero) {
    const SampleTile tile = tile_of(frame_of_samples(4, 4, false, false), {0, 0, 8, 8});
    for (size_t i = 0; i < tile.size(); ++i) {
        ASSERT_EQ(tile.time[i], 0);
        ASSERT_EQ(tile.lens_u[i], 0);
        ASSERT_EQ(tile.lens_v[i], 0);
    }
}

TEST_P(EveryPattern, SeedsGiveOtherSamples) {
    TestFrame frame = frame_of_samples(4, 4);
    const SampleTile first = tile_of(frame, {0, 0, 4, 4});
    frame.context.seed = 8;
    const SampleTile second = tile_of(frame, {0, 0, 4, 4});
    size_t same_place = 0, same_lens = 0;
    for (size_t i = 0; i < first.size(); ++i)
        same_place += first.x[i] == second.x[i], same_lens += first.lens_u[i] == second.lens_u[i];
    EXPECT_LT(same_place, first.size() / 20);
    EXPECT_LT(same_lens, first.size() / 20);
}

INSTANTIATE_TEST_SUITE_P(Names, EveryPattern, ::testing::ValuesIn(every_pattern()),
                         [](const ::testing::TestParamInfo<std::string>& tested) {
                             std::string name = tested.param;
                             std::replace_if(
                                 name.begin(), name.end(), [](char c) { return !std::isalnum(c); }, '_');
                             return name;
                         });

}  // namespace
}  // namespace trapeze
