#include "composite/filters/glow_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "core/scene/camera.h"

namespace trapeze {
namespace {

Camera camera_of(int width, int height) {
    Camera camera;
    camera.width = width, camera.height = height;
    camera.crop = {0, 0, width, height};
    return camera;
}

Image black(int width, int height) {
    Image image;
    image.width = width, image.height = height;
    image.window = {0, 0, width, height};
    image.rgba.assign(static_cast<size_t>(4 * width * height), 0);
    return image;
}

/// Mostly dim, some pixels thousands of times as bright.
Image noisy(int width, int height, uint32_t seed) {
    Image image = black(width, height);
    std::mt19937 engine(seed);
    std::uniform_real_distribution<float> unit(0, 1);
    for (size_t i = 0; i < image.rgba.size(); ++i)
        image.rgba[i] = unit(engine) * (i / 4 % 37 == 0 ? 3000.0f : 1.0f);
    return image;
}

/// The picture of the kept pixels, of the window that they need.
Image glowing(const Glow& glow, const Image& whole, const PixelRect& kept, bool backwards = false) {
    const Camera camera = camera_of(whole.width, whole.height);
    Image image = whole;
    trim(glow_window(glow, camera, kept), image);
    GlowFilter filter(glow, camera, kept, image);
    const int rows = image.window.height();
    for (int i = 0; i < rows; ++i) filter.spread_row(image.window.y0 + (backwards ? rows - 1 - i : i));
    for (int i = 0; i < kept.height(); ++i) filter.add_to_row(backwards ? kept.y1 - 1 - i : kept.y0 + i);
    trim(kept, image);
    return image;
}

double sum_of(const Image& image, size_t channel) {
    double sum = 0;
    for (size_t i = channel; i < image.rgba.size(); i += 4) sum += static_cast<double>(image.rgba[i]);
    return sum;
}

/// The share of a Gaussian's light in a pixel so far from its middle, cut at three deviations.
double gaussian(double pixels, int at) {
    const int reach = static_cast<int>(std::ceil(3 * pixels));
    if (std::abs(at) > reach) return 0;
    double total = 0;
    for (int i = -reach; i <= reach; ++i) total += std::exp(-i * i / (2 * pixels * pixels));
    return std::exp(-at * at / (2 * pixels * pixels)) / total;
}

/// What a light of 1 becomes at an offset, where the widest part has the deviations x and y.
double response(const Glow& glow, double x, double y, int dx, int dy) {
    const double direct = dx == 0 && dy == 0 ? 1 - static_cast<double>(glow.amount) : 0;
    double spread = 0;
    for (const auto& [size, share] : {std::pair{1.0, .2}, {1 / 3.0, .3}, {1 / 9.0, .5}})
        spread += share * gaussian(size * x, dx) * gaussian(size * y, dy);
    return direct + static_cast<double>(glow.amount) * spread;
}

TEST(GlowFilter, APointIsSpreadByThreeGaussians) {
    for (const float aspect : {1.0f, .5f}) {
        Glow glow{.3f, .08f, 0, aspect};
        Image image = black(100, 80);
        const float light[] = {1000, 10, 1};
        std::copy_n(light, 3, &image.rgba[4 * image.index(50, 40)]);
        image.rgba[4 * image.index(50, 40) + 3] = .25f;
        const Image result = glowing(glow, image, image.window);
        for (int y = 0; y < 80; ++y)
            for (int x = 0; x < 100; ++x) {
                const double expected = response(glow, 8, 8 * static_cast<double>(aspect), x - 50, y - 40);
                const float* rgba = &result.rgba[4 * result.index(x, y)];
                for (int c = 0; c < 3; ++c)
                    ASSERT_NEAR(rgba[c], light[c] * expected, 2e-6 * static_cast<double>(light[c]));
                ASSERT_EQ(rgba[3], x == 50 && y == 40 ? .25f : 0.0f) << "opacity does not glow";
            }
        for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(sum_of(result, c) / sum_of(image, c), 1, 2e-6);
    }
}

/// Light stays in the picture, all of it: also of pixels at its edges, and where these are nearer to each
/// other than light reaches.
TEST(GlowFilter, KeepsAllLight) {
    for (const auto& [threshold, height] : {std::pair{0.0f, 90}, {2.0f, 90}, {0.0f, 5}}) {
        const Glow glow{1, .05f, threshold};
        const Image image = noisy(120, height, 3);
        const Image result = glowing(glow, image, image.window);
        EXPECT_FALSE(result.rgba == image.rgba);
        for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(sum_of(result, c) / sum_of(image, c), 1, 2e-6);
    }
}

TEST(GlowFilter, WhatIsBrightToTheEdgeStaysSo) {
    Image image = black(60, 40);
    std::ranges::fill(image.rgba, 1.0f);
    const Image result = glowing({.4f, .1f, 0}, image, image.window);
    for (const float value : result.rgba) ASSERT_NEAR(value, 1, 2e-6f);
}

/// Every pixel is the sum of all others' responses, and of those that are their mirrors beyond the edges.
TEST(GlowFilter, IsTheSumOfWhatPixelsSpread) {
    const Glow glow{.6f, .1f, 0};
    const Image image = noisy(30, 20, 4), result = glowing(glow, image, image.window);
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 30; ++x) {
            double expected = 0;
            for (int from_y = 0; from_y < 20; ++from_y)
                for (int from_x = 0; from_x < 30; ++from_x)
                    for (const int place_y : {-1 - from_y, from_y, 39 - from_y})
                        for (const int place_x : {-1 - from_x, from_x, 59 - from_x})
                            expected += static_cast<double>(image.rgba[4 * image.index(from_x, from_y)]) *
                                        response(glow, 3, 3, x - place_x, y - place_y);
            ASSERT_NEAR(result.rgba[4 * result.index(x, y)] / expected, 1, 1e-5);
        }
    EXPECT_NEAR(sum_of(result, 0) / sum_of(image, 0), 1, 2e-6);
}

TEST(GlowFilter, ACropIsThePartOfTheWholePictureBitForBit) {
    for (const Glow& glow : {Glow{.4f, .04f, 0}, {1, .1f, 1.5f}, {.2f, .03f, 0, 2}, {.5f, .001f, 0}}) {
        const Image image = noisy(150, 70, 5), whole = glowing(glow, image, image.window);
        for (const PixelRect& crop :
             {PixelRect{0, 0, 20, 20}, {60, 30, 61, 31}, {10, 1, 149, 70}, {77, 0, 150, 9}}) {
            Image part = whole;
            trim(crop, part);
            EXPECT_TRUE(glowing(glow, image, crop) == part);
            EXPECT_TRUE(glowing(glow, image, crop, true) == part) << "rows in another order";
        }
    }
}

TEST(GlowFilter, ATooSmallMarginWouldShow) {
    const Glow glow{.4f, .04f, 0};
    const PixelRect kept{60, 30, 80, 40}, window = glow_window(glow, camera_of(150, 70), kept);
    EXPECT_EQ(window, (PixelRect{42, 12, 98, 58}));  // 3 * .04 * 150 to each side
    const Image image = noisy(150, 70, 5), before = glowing(glow, image, kept);
    const auto brighter_at = [&](int x) {
        Image changed = image;
        changed.rgba[4 * changed.index(x, 35)] += 1e6f;
        return glowing(glow, changed, kept);
    };
    EXPECT_FALSE(brighter_at(window.x0) == before) << "the margin's last column counts";
    EXPECT_TRUE(brighter_at(window.x0 - 1) == before) << "and none beyond";
}

TEST(GlowFilter, BelowTheThresholdNothingChanges) {
    Image image = black(40, 40);
    std::mt19937 engine(7);
    std::uniform_real_distribution<float> unit(-.1f, 1);
    for (float& value : image.rgba) value = unit(engine);
    EXPECT_TRUE(glowing({1, .05f, 1}, image, image.window) == image);
    image.rgba[4 * image.index(20, 20)] = 3;
    const Image result = glowing({1, .05f, 1}, image, image.window);
    const double spread = response({1, .05f, 0}, 2, 2, 0, 0);
    EXPECT_NEAR(result.rgba[4 * result.index(20, 20)], 1 + 2 * spread, 1e-5) << "what is above it is spread";
}

TEST(GlowFilter, WhatIsNoNumberStaysWhereItIs) {
    constexpr float kInfinite = std::numeric_limits<float>::infinity();
    Image image = noisy(30, 30, 8);
    image.rgba[4 * image.index(15, 15)] = kInfinite;
    image.rgba[4 * image.index(3, 3) + 1] = std::numeric_limits<float>::quiet_NaN();
    const Image result = glowing({.5f, .1f, 0}, image, image.window);
    for (int y = 0; y < 30; ++y)
        for (int x = 0; x < 30; ++x) {
            if ((x == 15 && y == 15) || (x == 3 && y == 3)) continue;
            for (size_t c = 0; c < 3; ++c)
                ASSERT_TRUE(std::isfinite(result.rgba[4 * result.index(x, y) + c])) << x << " " << y;
        }
    EXPECT_EQ(result.rgba[4 * result.index(15, 15)], kInfinite);
}

TEST(GlowFilter, TrimsAllPlanes) {
    Image image = noisy(10, 8, 9);
    image.aov_channels = 2;
    for (int i = 0; i < 80; ++i) {
        image.z.push_back(static_cast<float>(i)), image.id.push_back(static_cast<uint32_t>(i));
        image.aovs.push_back(static_cast<float>(2 * i)), image.aovs.push_back(static_cast<float>(2 * i + 1));
    }
    const Image whole = image;
    trim({3, 2, 5, 7}, image);
    ASSERT_EQ(image.z.size(), 10u);
    for (int y = 2; y < 7; ++y)
        for (int x = 3; x < 5; ++x) {
            const size_t at = image.index(x, y), from = whole.index(x, y);
            EXPECT_EQ(image.z[at], whole.z[from]);
            EXPECT_EQ(image.id[at], whole.id[from]);
            EXPECT_EQ(image.aovs[2 * at + 1], whole.aovs[2 * from + 1]);
            EXPECT_EQ(image.rgba[4 * at + 2], whole.rgba[4 * from + 2]);
        }
}

}  // namespace
}  // namespace trapeze
