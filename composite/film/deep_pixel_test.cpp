#include "composite/film/deep_pixel.h"

#include <gtest/gtest.h>

#include "core/random.h"

namespace trapeze {
namespace {

/// Puts samples over each other, front to back.
std::array<float, 4> flattened(const std::vector<DeepSample>& samples) {
    std::array<float, 4> sum{};
    for (const DeepSample& sample : samples) {
        const float let_through = 1 - sum[3];
        for (size_t c = 0; c < 4; ++c) sum[c] += let_through * sample.rgba[c];
    }
    return sum;
}

TEST(DeepPixel, FlattenedIsTheMeanOfTheSamples) {
    for (uint32_t seed = 0; seed < 200; ++seed) {
        uint32_t drawn = 0;
        const auto draw = [&] { return unit_float(hash(seed, drawn++)); };
        DeepPixel pixel;
        pixel.begin();
        std::array<double, 4> mean{};
        constexpr int kSamples = 16;
        for (int s = 0; s < kSamples; ++s) {
            std::vector<SeenLayer> layers;
            float transmission = 1, depth = 1;
            for (int layer = 0; layer < static_cast<int>(seed % 5); ++layer) {
                const float alpha = seed % 3 == 0 ? 1 : draw();
                depth += draw();
                SeenLayer seen{depth, static_cast<uint32_t>(3 * draw())};
                for (int c = 0; c < 3; ++c) seen.rgba[c] = transmission * alpha * draw();
                seen.rgba[3] = transmission * alpha;
                transmission *= 1 - alpha;
                if (seen.rgba[3] > 0) layers.push_back(seen);
                for (size_t c = 0; c < 4; ++c) mean[c] += seen.rgba[c] / kSamples;
            }
            pixel.add(layers);
        }
        for (const float tolerance : {0.0f, .01f, 1.0f}) {
            DeepPixel copy = pixel;
            const std::vector<DeepSample> samples = copy.samples(tolerance);
            const auto flat = flattened(samples);
            for (size_t c = 0; c < 4; ++c) ASSERT_NEAR(flat[c], mean[c], 1e-5) << seed << ' ' << tolerance;
            for (size_t i = 0; i < samples.size(); ++i) {
                ASSERT_TRUE(i == 0 || samples[i - 1].depth <= samples[i].depth);
                ASSERT_GE(samples[i].rgba[3], 0);
                ASSERT_LE(samples[i].rgba[3], 1);
            }
        }
    }
}

TEST(DeepPixel, DepthsOfOneSurfaceMergeWithinTheTolerance) {
    DeepPixel pixel;
    pixel.begin();
    for (const float depth : {10.0f, 10.05f, 10.09f, 10.3f})
        pixel.add(std::vector<SeenLayer>{{depth, 7, {1, 1, 1, 1}}});
    pixel.add(std::vector<SeenLayer>{{10.31f, 8, {1, 1, 1, 1}}});
    DeepPixel unmerged = pixel;
    EXPECT_EQ(unmerged.samples(0).size(), 5u);
    const std::vector<DeepSample> samples = pixel.samples(.01f);
    ASSERT_EQ(samples.size(), 3u);
    EXPECT_NEAR(samples[0].depth, (10 + 10.05f + 10.09f) / 3, 1e-4f);
    EXPECT_NEAR(samples[0].rgba[3], .6f, 1e-6f);
    EXPECT_NEAR(samples[1].rgba[3], .5f, 1e-6f) << "of what the first lets through";
    EXPECT_NEAR(samples[2].rgba[3], 1, 1e-6f);
}

TEST(DeepPixel, WhatSamplesDoNotSeeIsNotThere) {
    DeepPixel pixel;
    pixel.begin();
    EXPECT_TRUE(pixel.samples(.01f).empty());
    pixel.add({}), pixel.add({});
    EXPECT_TRUE(pixel.samples(.01f).empty());
    // Light without opacity is kept.
    pixel.add(std::vector<SeenLayer>{{2, 0, {.5f, 0, 0, 0}}});
    const std::vector<DeepSample> samples = pixel.samples(.01f);
    ASSERT_EQ(samples.size(), 1u);
    EXPECT_NEAR(samples[0].rgba[0], .5f / 3, 1e-6f);
    EXPECT_EQ(samples[0].rgba[3], 0);
}

}  // namespace
}  // namespace trapeze
