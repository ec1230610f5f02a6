#include "pipeline/frame/tiles/pixel_noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/random.h"
#include "core/scene/camera.h"
#include "sample/patterns/stratified_pattern.h"

namespace trapeze {
namespace {

constexpr int kSide = 8;
constexpr SampleDomains kBoth{true, true};

/// What a sample shows, of its place in the pixel, its lens point and its time.
using Shows = std::function<float(float x, float y, float u, float v, float t)>;

/// Mean over many pixels of pixel_noise() of the first level, and the variance of what all samples are worth:
/// of a first level's mean, times its samples.
struct Noise {
    double estimated = 0, true_one = 0, plain = 0;
};

Noise noise_of(const Shows& shows) {
    RenderContext context;
    context.samples_x = context.samples_y = kSide, context.sample_levels = 2;
    context.motion = true, context.camera.lens_radius = 1;
    const StratifiedPattern pattern(context);
    const SampleLevels& levels = *pattern.levels();
    const size_t count = levels.samples(0);
    SampleTile tile;
    std::vector<float> rgba(4 * count), times(count);
    Noise noise;
    double sum = 0, squares = 0;
    int pixels = 0;
    for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 40; ++x, ++pixels) {
            const PixelPlace pixel{x, y};
            pattern.make_levels({x, y, x + 1, y + 1}, {&pixel, 1}, 0, 0, tile);
            double mean = 0, square = 0;
            for (size_t s = 0; s < count; ++s) {
                const float value =
                    shows(tile.x[s] - static_cast<float>(x), tile.y[s] - static_cast<float>(y),
                          tile.lens_u[s], tile.lens_v[s], tile.time[s]);
                for (size_t c = 0; c < 4; ++c) rgba[4 * s + c] = value;
                times[s] = tile.time[s];
                mean += value / static_cast<double>(count),
                    square += value * value / static_cast<double>(count);
            }
            noise.estimated += pixel_noise(rgba.data(), times.data(), count,
                                           levels.neighbours(pattern.variant_of(pixel)), kBoth)
                                   .sum();
            noise.plain += square - mean * mean;
            sum += mean, squares += mean * mean;
        }
    noise.estimated /= pixels, noise.plain /= pixels;
    noise.true_one = (squares / pixels - sum / pixels * (sum / pixels)) * static_cast<double>(count);
    return noise;
}

/// What strata even out is far below the samples' own variance, and the estimate is between the two: never
/// below what is true.
void expect_evened_out(const Shows& shows, double most_part) {
    const Noise noise = noise_of(shows);
    EXPECT_LT(noise.true_one, .4 * noise.plain);
    EXPECT_GT(noise.estimated, noise.true_one);
    EXPECT_LT(noise.estimated, most_part * noise.plain);
}

TEST(PixelNoise, SeesThatEdgesAreEvenedOut) {
    expect_evened_out([](float x, float, float, float, float) { return x < .4f ? 1.0f : 0.0f; }, .55);
    expect_evened_out([](float x, float y, float, float, float) { return x + 2 * y < 1.2f ? 1.0f : 0.0f; },
                      .5);
}

TEST(PixelNoise, SeesBlurOfTheLens) {
    expect_evened_out([](float, float, float u, float, float) { return u < .2f ? 1.0f : 0.0f; }, .6);
}

TEST(PixelNoise, SeesBlurOfMotion) {
    expect_evened_out([](float, float, float, float, float t) { return t < .3f ? 1.0f : 0.0f; }, .5);
}

TEST(PixelNoise, SeesThatSumsOfThemAreEvenedOut) {
    expect_evened_out([](float x, float, float u, float, float t) { return x + u + 2 * t; }, .5);
}

/// What changes with all of them at once is noise: nothing evens it out, and the estimate says so.
TEST(PixelNoise, IsTheVarianceOfWhatNothingEvensOut) {
    const Noise noise = noise_of([](float x, float y, float u, float v, float t) {
        const auto bits = static_cast<uint32_t>(x * 4096) * 31 + static_cast<uint32_t>(y * 4096) * 57 +
                          static_cast<uint32_t>((u + 1) * 4096) * 71 + static_cast<uint32_t>((v + 1) * 4096) +
                          static_cast<uint32_t>(t * 65536) * 13;
        return unit_float(hash(bits));
    });
    EXPECT_NEAR(noise.true_one, 1.0 / 12, .01);
    EXPECT_GT(noise.estimated, .6 / 12);
    EXPECT_LT(noise.estimated, 1.1 / 12);
}

TEST(PixelNoise, IsNothingWhereAllSamplesAreAlikeAndMuchWhereOneIsInfinite) {
    EXPECT_EQ(noise_of([](float, float, float, float, float) { return .3f; }).estimated, 0);
    RenderContext context;
    context.samples_x = context.samples_y = 4, context.sample_levels = 2;
    const StratifiedPattern pattern(context);
    float rgba[16] = {}, times[4] = {};
    for (const float wrong : {1e30f, INFINITY, NAN}) {
        rgba[5] = wrong;
        EXPECT_GE(pixel_noise(rgba, times, 4, pattern.levels()->neighbours(0), {}).sum(), 0) << wrong;
    }
}

}  // namespace
}  // namespace trapeze
