#include "shade/maps/sky_parts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "core/random.h"

namespace trapeze {
namespace {

constexpr double kPiOfSky = std::numbers::pi;

SkyPicture picture_of(int width, int height, const std::function<V3f(int, int)>& color) {
    SkyPicture picture{width, height, {}};
    for (int row = 0; row < height; ++row)
        for (int column = 0; column < width; ++column) picture.colors.push_back(color(column, row));
    return picture;
}

/// A sky of noise with a sun a thousand times as bright in one pixel.
SkyPicture sunny_sky() {
    return picture_of(64, 32, [](int x, int y) {
        const float sky = 0.2f + 0.8f * unit_float(hash(static_cast<uint32_t>(y * 64 + x)));
        return V3f(sky, 0.5f * sky, 0.25f) * (x == 19 && y == 9 ? 1000.0f : 1.0f);
    });
}

V3f direction(double column, double row, int width, int height) {
    const double down = kPiOfSky * row / height, turn = 2 * kPiOfSky * column / width;
    return V3f(static_cast<float>(std::cos(turn) * std::sin(down)),
               static_cast<float>(std::sin(turn) * std::sin(down)), static_cast<float>(std::cos(down)));
}

/// The integral over the sphere of the picture times a function of the direction, by parts of its pixels.
template <class Function>
V3d integral(const SkyPicture& picture, const Function& f) {
    constexpr int kParts = 8;  // of a pixel, each way
    const int width = picture.width * kParts, height = picture.height * kParts;
    V3d sum(0, 0, 0);
    for (int row = 0; row < height; ++row) {
        const double solid = (std::cos(kPiOfSky * row / height) - std::cos(kPiOfSky * (row + 1) / height)) *
                             2 * kPiOfSky / width;
        for (int column = 0; column < width; ++column) {
            const V3f& color =
                picture.colors[static_cast<size_t>(row / kParts * picture.width + column / kParts)];
            sum += V3d(color) * (f(direction(column + 0.5, row + 0.5, width, height)) * solid);
        }
    }
    return sum;
}

double by_cosine(const V3f& way, const V3f& N) {
    return std::max(0.0, static_cast<double>(way.dot(N)));
}

TEST(SkyParts, HaveAllOfTheLight) {
    const SkyPicture white = picture_of(64, 32, [](int, int) { return V3f(1, 2, 3); });
    for (const SkyPicture& picture : {white, sunny_sky()}) {
        const SkyParts parts(picture);
        const V3d expected = integral(picture, [](const V3f&) { return 1.0; });
        for (const int count : {1, 2, 3, 7, 64, 500}) {
            V3d sum(0, 0, 0);
            double sphere = 0;
            for (int i = 0; i < count; ++i) {
                const SkyParts::Part part = parts.part(i, count);
                sum += V3d(part.color) * static_cast<double>(part.solid_angle);
                sphere += static_cast<double>(part.solid_angle);
                EXPECT_GT(part.solid_angle, 0);
                EXPECT_NEAR(part.direction.length(), 1, 1e-5f);
            }
            EXPECT_NEAR(sphere, 4 * kPiOfSky, 1e-4) << count;
            for (int k = 0; k < 3; ++k) EXPECT_NEAR(sum[k], expected[k], 1e-4 * expected[k]) << count;
        }
    }
    const V3d closed = integral(white, [](const V3f&) { return 1.0; });
    EXPECT_NEAR(closed.x, 4 * kPiOfSky, 1e-6);
}

TEST(SkyParts, OfAWhiteSkyAreAsLarge) {
    const SkyParts parts(picture_of(64, 32, [](int, int) { return V3f(2); }));
    for (int i = 0; i < 48; ++i) {
        const SkyParts::Part part = parts.part(i, 48);
        EXPECT_NEAR(part.solid_angle, 4 * kPiOfSky / 48, 1e-4);
        EXPECT_NEAR(part.color.y, 2, 1e-4f);
    }
    for (const V3f& N : {V3f(0, 0, 1), V3f(0.6f, 0, -0.8f), V3f(0, -1, 0)}) {
        double sum = 0;
        for (int i = 0; i < 256; ++i) {
            const SkyParts::Part part = parts.part(i, 256);
            sum += static_cast<double>(part.color.x * part.solid_angle) * by_cosine(part.direction, N);
        }
        EXPECT_NEAR(sum, 2 * kPiOfSky, 0.02 * 2 * kPiOfSky) << N;
    }
}

TEST(SkyParts, LieWhereTheLightIs) {
    const SkyPicture picture = sunny_sky();
    const SkyParts parts(picture);
    const V3f sun = direction(19.5, 9.5, 64, 32);
    int near_sun = 0;
    const V3d all = integral(picture, [](const V3f&) { return 1.0; });
    const double of_sun =
        integral(picture, [&](const V3f& way) { return way.dot(sun) > 0.995f ? 1.0 : 0.0; }).x;
    for (int i = 0; i < 256; ++i) near_sun += parts.part(i, 256).direction.dot(sun) > 0.995f;
    EXPECT_NEAR(near_sun / 256.0, of_sun / all.x, 0.03);
    // What it does to faces, by the parts' middles and by directions within them.
    for (const V3f& N : {V3f(0, 0, 1), V3f(0.6f, 0, -0.8f), V3f(0, 1, 0)}) {
        const V3d expected = integral(picture, [&](const V3f& way) { return by_cosine(way, N); });
        constexpr int kCount = 4096;
        double by_middles = 0, within = 0;
        for (int i = 0; i < kCount; ++i) {
            const SkyParts::Part part = parts.part(i, kCount);
            const double light = static_cast<double>(part.color.y) * static_cast<double>(part.solid_angle);
            const V2f square(unit_float(hash(static_cast<uint32_t>(i), 1)),
                             unit_float(hash(static_cast<uint32_t>(i), 2)));
            by_middles += light * by_cosine(part.direction, N);
            within += light * by_cosine(parts.direction_in(part, square), N);
        }
        EXPECT_NEAR(by_middles, expected.y, 0.01 * expected.y) << N;
        EXPECT_NEAR(within, expected.y, 0.01 * expected.y) << N;
    }
}

TEST(SkyParts, DirectionsAreAsLikelyAsTheirLight) {
    const SkyPicture picture = sunny_sky();
    const SkyParts parts(picture);
    const SkyParts::Part whole = parts.part(0, 1);
    const V3f N(0, 0.8f, 0.6f);
    const V3d all = integral(picture, [](const V3f&) { return 1.0; }),
              expected = integral(picture, [&](const V3f&way) { return by_cosine(way, N); });
    double mean = 0;
    constexpr int kSide = 64;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            const V2f square((static_cast<float>(x) + 0.5f) / kSide, (static_cast<float>(y) + 0.5f) / kSide);
            mean += by_cosine(parts.direction_in(whole, square), N) / (kSide * kSide);
        }
    const V3d weights(0.2126, 0.7152, 0.0722);
    EXPECT_NEAR(mean, expected.dot(weights) / all.dot(weights), 0.005);
}

TEST(SkyParts, OfDarkSkiesCoverTheSphere) {
    for (const bool one_lit : {false, true}) {
        const SkyParts parts(picture_of(
            8, 4, [&](int x, int y) { return one_lit && x == 7 && y == 3 ? V3f(1e30f) : V3f(0); }));
        double sphere = 0;
        for (int i = 0; i < 100; ++i) {
            const SkyParts::Part part = parts.part(i, 100);
            sphere += static_cast<double>(part.solid_angle);
            const V3f way = parts.direction_in(part, V2f(0, 1));
            EXPECT_NEAR(way.length(), 1, 1e-5f);
            EXPECT_TRUE(std::isfinite(part.color.x));
            EXPECT_TRUE(one_lit || part.color == V3f(0));
        }
        EXPECT_NEAR(sphere, 4 * kPiOfSky, 1e-3);
    }
}

}  // namespace
}  // namespace trapeze
