#include "sample/patterns/stratified_pattern.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <random>
#include <set>

#include "core/random.h"
#include "core/simd/simd_limit.h"
#include "sample/frame_harness.h"
#include "sample/patterns/jittered_run.h"
#include "sample/patterns/magic_square.h"

namespace trapeze {
namespace {

using testing::frame_of_samples;
using testing::square_from_disk;
using testing::TestFrame;

SampleTile tile_of(const TestFrame& frame, const PixelRect& pixels) {
    SampleTile tile;
    StratifiedPattern(frame.context).make_tile(pixels, tile);
    return tile;
}

TEST(MagicSquare, HasEqualSumsAndEveryNumberOnce) {
    for (int n = 3; n <= 26; ++n) {
        const std::vector<uint32_t> square = magic_square(n);
        ASSERT_EQ(std::set<uint32_t>(square.begin(), square.end()).size(), static_cast<size_t>(n * n));
        ASSERT_EQ(*std::max_element(square.begin(), square.end()), static_cast<uint32_t>(n * n - 1));
        const auto magic = static_cast<uint32_t>(n * (n * n - 1) / 2);
        uint32_t falling = 0, rising = 0;
        for (int i = 0; i < n; ++i) {
            uint32_t row = 0, column = 0;
            for (int j = 0; j < n; ++j) row += square[i * n + j], column += square[j * n + i];
            ASSERT_EQ(row, magic) << n;
            ASSERT_EQ(column, magic) << n;
            falling += square[i * n + i], rising += square[i * n + n - 1 - i];
        }
        ASSERT_EQ(falling, magic) << n;
        ASSERT_EQ(rising, magic) << n;
    }
}

TEST(StratifiedPattern, TakesOneSampleFromEachRegionOfEachDomain) {
    for (const auto& [nx, ny] :
         {std::pair{1, 1}, {2, 2}, {3, 3}, {4, 4}, {6, 6}, {8, 8}, {4, 2}, {1, 5}, {13, 13}}) {
        const TestFrame frame = frame_of_samples(nx, ny);
        const SampleTile tile = tile_of(frame, {-1, -2, 3, 2});
        const int count = nx * ny;
        ASSERT_EQ(tile.samples_per_pixel, count);
        for (int py = -2; py < 2; ++py)
            for (int px = -1; px < 3; ++px) {
                std::set<int> places, lenses, times;
                for (int i = 0; i < count; ++i) {
                    const size_t at = tile.first_of_pixel(px, py) + static_cast<size_t>(i);
                    const float fx = tile.x[at] - static_cast<float>(px),
                                fy = tile.y[at] - static_cast<float>(py);
                    places.insert(static_cast<int>(fy * static_cast<float>(ny)) * nx +
                                  static_cast<int>(fx * static_cast<float>(nx)));
                    const V2f lens = square_from_disk(tile.lens_u[at], tile.lens_v[at]);
                    lenses.insert(static_cast<int>(lens.y * static_cast<float>(ny)) * nx +
                                  static_cast<int>(lens.x * static_cast<float>(nx)));
                    times.insert(static_cast<int>(tile.time[at] * static_cast<float>(count)));
                }
                // The map back from the disk rounds: a sample on a region's border may seem to be next door.
                ASSERT_EQ(places.size(), static_cast<size_t>(count));
                ASSERT_GE(lenses.size() + 1, static_cast<size_t>(count));
                ASSERT_EQ(times.size(), static_cast<size_t>(count));
            }
    }
}

/// One sample, as strata.h says it.
struct ScalarSample {
    float x = 0, y = 0, time = 0;
    V2f lens{0, 0};

    ScalarSample(const TestFrame& frame, const StratifiedPattern& pattern, const LensShape& shape, int px,
                 int py, int sample) {
        const auto nx = static_cast<uint32_t>(frame.context.samples_x);
        const int ny = frame.context.samples_y;
        const auto i = static_cast<uint32_t>(sample);
        const uint32_t pixel = hash(frame.context.seed, static_cast<uint32_t>(px), static_cast<uint32_t>(py));
        const auto jitter = [own = hash(pixel + i)](SampleDimension d) { return unit_float(hash(own + d)); };
        const uint32_t column = turned(i % nx, pattern.turn_x(pixel), nx),
                       row = turned(i / nx, pattern.turn_y(pixel), static_cast<uint32_t>(ny));
        x = within_pixel(px, place(column, jitter(kSubpixelX), static_cast<int>(nx)));
        y = within_pixel(py, place(row, jitter(kSubpixelY), ny));
        const uint32_t region = pattern.lens_region_of(sample);
        if (frame.context.camera.has_lens())
            lens = shape.from_square(place(region % nx, jitter(kLensU), static_cast<int>(nx)),
                                     place(region / nx, jitter(kLensV), ny));
        if (frame.context.motion)
            time = place(pattern.time_region_of(sample, pattern.time_shift(px, py)), jitter(kTime),
                         pattern.sample_count());
    }
};

TEST(StratifiedPattern, EqualsTheScalarFormOnEveryInstructionSet) {
    std::string error;
    int tried = 0;
    for (const std::string_view limit : simd_names()) {
        if (!limit_simd(limit, &error)) continue;
        ++tried;
        for (const auto& [nx, ny] :
             {std::pair{1, 1}, {2, 2}, {3, 3}, {2, 4}, {5, 4}, {8, 8}, {13, 13}, {17, 16}})
            for (int kind = 0; kind < 9; ++kind) {
                TestFrame frame = frame_of_samples(nx, ny, kind & 1, kind & 2 || kind == 8);
                if (kind == 8) frame.context.camera.aperture = {5, 20, -.4f, .6f};
                if (kind & 4) frame.options.projection = "orthographic", frame.update();
                const StratifiedPattern pattern(frame.context);
                const LensShape shape(frame.context.camera.aperture);
                for (const PixelRect& pixels : {PixelRect{-5, -2, 14, 1}, PixelRect{60, 4, 61, 5}}) {
                    const SampleTile tile = tile_of(frame, pixels);
                    size_t at = 0;
                    for (int py = pixels.y0; py < pixels.y1; ++py)
                        for (int px = pixels.x0; px < pixels.x1; ++px)
                            for (int i = 0; i < nx * ny; ++i, ++at) {
                                const ScalarSample s(frame, pattern, shape, px, py, i);
                                const AxisRay ray =
                                    frame.context.camera.ray(s.x, s.y, s.lens.x, s.lens.y, s.time);
                                const auto bits = [](auto... values) {
                                    return std::array{std::bit_cast<uint32_t>(values)...};
                                };
                                const AxisRay& made = tile.rays[at];
                                ASSERT_EQ(bits(tile.x[at], tile.y[at], tile.lens_u[at], tile.lens_v[at],
                                               tile.time[at]),
                                          bits(s.x, s.y, s.lens.x, s.lens.y, s.time))
                                    << limit << " " << nx << "x" << ny << " pixel " << px << " " << py;
                                ASSERT_EQ(bits(made.ox, made.oy, made.oz, made.ux, made.uy, made.time),
                                          bits(ray.ox, ray.oy, ray.oz, ray.ux, ray.uy, ray.time))
                                    << limit << " " << nx << "x" << ny << " pixel " << px << " " << py;
                            }
                    ASSERT_EQ(at, tile.size());
                }
            }
    }
    EXPECT_GT(tried, 1);
    limit_simd("best", &error);
}

TEST(Strata, TheDiskIsShirleysWithinAFewUlps) {
    std::mt19937 engine(3);
    std::uniform_real_distribution<float> unit(0, 1);
    double worst = 0;
    for (int n = 0; n < 100000; ++n) {
        // Edges, diagonals and the middle of the square among them.
        const float u = n % 11 == 0 ? 0.0f : (n % 13 == 0 ? 0.5f : unit(engine));
        const float v = n % 7 == 0 ? u : (n % 17 == 0 ? 1 - u : (n % 19 == 0 ? 0.5f : unit(engine)));
        const double a = 2 * u - 1, b = 2 * v - 1;
        double x = 0, y = 0;
        if (std::abs(a) > std::abs(b))
            x = a * std::cos(M_PI / 4 * (b / a)), y = a * std::sin(M_PI / 4 * (b / a));
        else if (b != 0)
            x = b * std::sin(M_PI / 4 * (a / b)), y = b * std::cos(M_PI / 4 * (a / b));
        const V2f found = disk_from_square(u, v);
        worst = std::max({worst, std::abs(found.x - x), std::abs(found.y - y)});
    }
    EXPECT_LT(worst, 3e-7);  // five ulps at the rim
}

TEST(Strata, TheLastPlaceOfAPixelIsJustBeforeTheNext) {
    for (const int pixel : {-100000, -3, -2, -1, 0, 1, 2, 63, 64, 16384, 100000}) {
        const auto low = static_cast<float>(pixel), high = static_cast<float>(pixel + 1);
        EXPECT_EQ(last_place_of(pixel), std::nextafter(high, low)) << pixel;
    }
}

TEST(StratifiedPattern, WithoutJitterSamplesLieInTheMiddlesOfTheirRegions) {
    TestFrame frame = frame_of_samples(4, 2);
    Scene scene;
    scene.options.hider_parameters.set({"jitter", {}, {0}, {}});
    frame.context.scene = &scene;
    frame.context.motion = false, frame.context.camera.lens_radius = 0;  // pixels turn where these matter
    const SampleTile tile = tile_of(frame, {3, 5, 5, 6});
    ASSERT_EQ(tile.size(), 16u);
    for (size_t i = 0; i < tile.size(); ++i) {
        EXPECT_FLOAT_EQ(tile.x[i],
                        3 + static_cast<float>(i / 8) + 0.125f + 0.25f * static_cast<float>(i % 4));
        EXPECT_FLOAT_EQ(tile.y[i], 5.25f + 0.5f * static_cast<float>(i / 4 % 2));
    }
}

TEST(Strata, TurnsTakeEachRegionToEachPlaceAlikeAndKeepBlocks) {
    for (const auto& [count, block] :
         {std::pair{1u, 1u}, {2u, 1u}, {7u, 1u}, {8u, 2u}, {12u, 4u}, {16u, 4u}}) {
        std::vector<int> seen(count * count);
        for (uint32_t bits = 0; bits < 256 * count; ++bits) {
            const uint32_t turn = turn_of(bits, count, block);
            std::set<uint32_t> places, blocks;
            for (uint32_t region = 0; region < count; ++region) {
                const uint32_t at = turned(region, turn, count);
                ASSERT_LT(at, count);
                places.insert(at), blocks.insert(region / block * count + at / block);
                ++seen[region * count + at];
            }
            ASSERT_EQ(places.size(), count);
            ASSERT_EQ(blocks.size(), count / block);
        }
        for (const int n : seen) ASSERT_EQ(n, 256) << count;
    }
}

/// The share of a pixel's samples for which `is_seen` holds, over many pixels: its mean and its spread.
struct Share {
    double mean = 0, deviation = 0;

    template <class Seen>
    Share(const SampleTile& tile, const Seen& is_seen) {
        const auto count = static_cast<size_t>(tile.samples_per_pixel), pixels = tile.size() / count;
        double sum = 0, squares = 0;
        for (size_t pixel = 0; pixel < pixels; ++pixel) {
            int seen = 0;
            for (size_t i = pixel * count; i < (pixel + 1) * count; ++i)
                seen += is_seen(tile.x[i] - std::floor(tile.x[i]), tile.y[i] - std::floor(tile.y[i]), i);
            const double share = static_cast<double>(seen) / static_cast<double>(count);
            sum += share, squares += share * share;
        }
        mean = sum / static_cast<double>(pixels);
        deviation = std::sqrt(std::max(0.0, squares / static_cast<double>(pixels) - mean * mean));
    }
};

/// What a blurred edge covers, across the pixel or along it: right in the mean, within what is left of
/// chance, and with many samples with half the spread of random ones at most.
void expect_right(const Share& seen, double right, int n) {
    const double random = std::sqrt(right * (1 - right)) / n;
    EXPECT_NEAR(seen.mean, right, 4 * random / 64) << n;
    if (n >= 8) {
        EXPECT_LT(seen.deviation, random / 2) << n;
    }
}

constexpr int kSides[] = {2, 3, 4, 6, 8, 12, 16};

/// An edge .1 beyond the middle of the pixel, blurred by the lens over a pixel to each side: in closed form
/// the strip of a disk of radius 1, integrated over the pixel.
TEST(StratifiedPattern, DefocusIsRightAndItsNoiseFallsFasterThanRandom) {
    const auto strip = [](double at) {  // of the unit disk's area, left of `at`
        return at <= -1 ? 0 : at >= 1 ? 1 : .5 + (at * std::sqrt(1 - at * at) + std::asin(at)) / M_PI;
    };
    double right = 0;
    for (int i = 0; i < 4000; ++i) right += strip(.1 - ((i + .5) / 4000 - .5)) / 4000;
    for (const int n : kSides) {
        const TestFrame frame = frame_of_samples(n, n, false, true);
        const SampleTile tile = tile_of(frame, {0, 0, 64, 64});
        expect_right({tile, [&](float x, float, size_t i) { return x - .5f + tile.lens_u[i] < .1f; }}, right,
                     n);
        expect_right({tile, [&](float, float y, size_t i) { return y - .5f + tile.lens_v[i] < .1f; }}, right,
                     n);
    }
}

/// An edge that moves by a pixel, past 1.1 as the shutter opens: all samples but those of a triangle of legs
/// .9.
TEST(StratifiedPattern, MotionIsRightAndItsNoiseFallsFasterThanRandom) {
    const double right = 1 - .9 * .9 / 2;
    for (const int n : kSides)
        for (const bool lens : {false, true}) {
            const TestFrame frame = frame_of_samples(n, n, true, lens);
            const SampleTile tile = tile_of(frame, {0, 0, 64, 64});
            expect_right({tile, [&](float x, float, size_t i) { return x + tile.time[i] < 1.1f; }}, right, n);
            expect_right({tile, [&](float, float y, size_t i) { return y + tile.time[i] < 1.1f; }}, right, n);
        }
}

/// Over many pixels each lens region meets each time region alike.
TEST(StratifiedPattern, TimeAndLensAreIndependent) {
    constexpr int kSide = 4, kCount = kSide * kSide, kPixels = 128;
    const TestFrame frame = frame_of_samples(kSide, kSide);
    const SampleTile tile = tile_of(frame, {0, 0, kPixels, kPixels});
    std::vector<int> bins(kCount * kCount);
    double u_time = 0, v_time = 0;
    for (size_t i = 0; i < tile.size(); ++i) {
        const V2f lens = square_from_disk(tile.lens_u[i], tile.lens_v[i]);
        const auto region = [](float at, int n) {
            return std::min(static_cast<int>(at * static_cast<float>(n)), n - 1);
        };
        ++bins[(region(lens.y, kSide) * kSide + region(lens.x, kSide)) * kCount +
               region(tile.time[i], kCount)];
        u_time += tile.lens_u[i] * (tile.time[i] - 0.5f), v_time += tile.lens_v[i] * (tile.time[i] - 0.5f);
    }
    const double expected = static_cast<double>(tile.size()) / (kCount * kCount);
    double chi_square = 0;
    for (const int n : bins) chi_square += (n - expected) * (n - expected) / expected;
    EXPECT_LT(chi_square, 330);  // at most 255 degrees of freedom, one in a thousand
    const double scale = static_cast<double>(tile.size()) * 0.5 * std::sqrt(1 / 12.0);
    EXPECT_LT(std::abs(u_time / scale), 0.01);
    EXPECT_LT(std::abs(v_time / scale), 0.01);
}

TEST(StratifiedPattern, TheTimeShiftIsLeftOutWithoutDefocus) {
    const TestFrame frame = frame_of_samples(4, 4, true, false);
    const SampleTile tile = tile_of(frame, {0, 0, 8, 8});
    for (size_t pixel = 1; pixel < 64; ++pixel)
        for (size_t i = 0; i < 16; ++i)
            ASSERT_EQ(static_cast<int>(tile.time[i] * 16), static_cast<int>(tile.time[pixel * 16 + i] * 16));
}

/// Each column and row of a pixel's regions spreads over the lens and the shutter: what magic squares are
/// for.
TEST(StratifiedPattern, RowsSpreadOverTime) {
    const TestFrame frame = frame_of_samples(8, 8, true, false);
    const SampleTile tile = tile_of(frame, {0, 0, 1, 1});
    for (size_t row = 0; row < 8; ++row) {
        double mean = 0;
        for (size_t i = 0; i < 8; ++i) mean += tile.time[row * 8 + i] / 8;
        EXPECT_NEAR(mean, 0.5, 0.02);
    }
}

}  // namespace
}  // namespace trapeze
