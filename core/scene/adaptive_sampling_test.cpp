#include "core/scene/adaptive_sampling.h"

#include <gtest/gtest.h>

#include "core/samples.h"
#include "core/scene/camera.h"

namespace trapeze {
namespace {

Options options_of(float x, float y, float least = 0, float variance = 1e-4f) {
    Options options;
    options.samples_x = x, options.samples_y = y, options.least_samples = least;
    options.pixel_variance = variance, options.adaptive = true;
    return options;
}

void expect(const Options& options, int x, int y, int levels) {
    const AdaptiveSampling sampling = adaptive_sampling(options);
    EXPECT_EQ(sampling.samples_x, x);
    EXPECT_EQ(sampling.samples_y, y);
    EXPECT_EQ(sampling.levels, levels);
    EXPECT_EQ(sampling.is_on(), levels > 1);
}

TEST(AdaptiveSampling, HalvesCountsOnceOrTwice) {
    expect(options_of(8, 8), 8, 8, 2);
    expect(options_of(16, 16), 16, 16, 3);
    expect(options_of(64, 64), 64, 64, 3);
    expect(options_of(4, 4), 4, 4, 2);
    expect(options_of(8, 8, 2), 8, 8, 3);
    expect(options_of(16, 16, 8), 16, 16, 2);
    expect(options_of(8, 4), 8, 4, 2);
}

TEST(AdaptiveSampling, RoundsCountsUpToWhatHasLevels) {
    expect(options_of(5, 5), 6, 6, 2);
    expect(options_of(13, 13), 16, 16, 3);
    expect(options_of(3, 3), 4, 4, 2);
}

TEST(AdaptiveSampling, NeedsAVarianceAWishAndSamples) {
    expect(options_of(2, 2), 2, 2, 1);
    expect(options_of(1, 1), 1, 1, 1);
    expect(options_of(1, 8), 1, 8, 1);
    expect(options_of(8, 8, 0, 0), 8, 8, 1);
    Options unasked = options_of(5, 5);
    unasked.adaptive = false;
    expect(unasked, 5, 5, 1);
}

/// A crop samples whole squares, but nothing that the whole picture does not.
TEST(AdaptiveSampling, SamplesWholeTilesOfCrops) {
    Options options = options_of(8, 8);
    options.width = 100, options.height = 60;
    const auto sampled = [&] { return sampled_pixels(make_camera(options), options); };
    EXPECT_EQ(sampled(), (PixelRect{-1, -1, 101, 61}));
    options.crop_window = {.29f, .5f, .49f, 1};
    const PixelRect part = sampled();
    EXPECT_EQ(part, (PixelRect{16, 16, 64, 61}));
    options.adaptive = false;
    EXPECT_EQ(sampled(), (PixelRect{28, 29, 51, 61}));
}

}  // namespace
}  // namespace trapeze
