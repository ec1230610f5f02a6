#include "pipeline/compare/flip.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <functional>
#include <limits>

namespace trapeze {
namespace {

using Color = std::array<float, 3>;

Image picture_of(int width, int height, const std::function<Color(int x, int y)>& color) {
    Image image;
    image.width = width, image.height = height, image.window = {0, 0, width, height};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const Color c = color(x, y);
            image.rgba.insert(image.rgba.end(), {c[0], c[1], c[2], 1});
        }
    return image;
}

Image plain(const Color& color) {
    return picture_of(16, 12, [&](int, int) { return color; });
}

/// Colours of all kinds, with edges and points.
Color patterned(int x, int y) {
    return {static_cast<float>((x * 7 + y * 3) % 32) / 31, static_cast<float>((x * y) % 17) / 16,
            static_cast<float>((x / 4 + y / 4) % 2) * .75f};
}

/// That with a rectangle whose red is turned round, half the blue, and a pixel brighter than white.
Color changed(int x, int y) {
    Color c = patterned(x, y);
    if (x >= 8 && x < 20 && y >= 6 && y < 14) c[0] = 1 - c[0];
    c[2] *= .5f;
    return x == 3 && y == 18 ? Color{4, 0, 0} : c;
}

double flip(const Image& picture, const Image& reference) {
    return flip_difference(seen_picture(picture), seen_picture(reference));
}

TEST(Flip, EqualPicturesHaveNone) {
    const Image image = picture_of(32, 24, patterned);
    for (const float difference : flip_differences(seen_picture(image), seen_picture(image)))
        ASSERT_EQ(difference, 0);
    EXPECT_EQ(flip(plain({4, 1, -1}), plain({1, 1, 0})), 0) << "a screen shows no difference";
}

/// Plain pictures have no features, and filters leave them as they are: what is left is a closed form. The
/// largest distance is 41.2761 after its exponent, as the authors' program has it; white is at 100^.7.
TEST(Flip, PlainPicturesDifferByTheirColors) {
    const double most = 41.27609841185733, white = std::pow(100, .7);
    const double expected = .95 + (white - .4 * most) / (.6 * most) * .05;
    EXPECT_NEAR(expected, .9674, 5e-5);
    EXPECT_NEAR(flip(plain({0, 0, 0}), plain({1, 1, 1})), expected, 2e-6);
    EXPECT_NEAR(flip(plain({0, 1, 0}), plain({0, 0, 1})), 1, 2e-6);
    EXPECT_NEAR(flip(plain({.5f, .5f, .5f}), plain({.4f, .5f, .6f})), .26239423482660734, 1e-5);
}

/// Expected values are of a program of its own, in double and with filters in two dimensions, which was
/// written from the paper's formulas.
TEST(Flip, GivesThePapersValuesWhereThereAreEdges) {
    const std::vector<float> map = flip_differences(seen_picture(picture_of(32, 24, changed)),
                                                    seen_picture(picture_of(32, 24, patterned)));
    const auto at = [&](int x, int y) { return map[static_cast<size_t>(y * 32 + x)]; };
    EXPECT_NEAR(at(12, 10), .5246195854314517, 1e-4);
    EXPECT_NEAR(at(3, 18), .4825181689405579, 1e-4);
    EXPECT_NEAR(at(0, 0), .3094494496980508, 1e-4);
    EXPECT_NEAR(at(31, 23), .2911613994173996, 1e-4);
    EXPECT_NEAR(*std::ranges::max_element(map), .6496897100271618, 1e-4);
    EXPECT_NEAR(flip(picture_of(32, 24, changed), picture_of(32, 24, patterned)), .45946072087609496, 1e-4);
}

TEST(Flip, IsSymmetricAndBounded) {
    const SeenPicture
        one = seen_picture(picture_of(40, 30, patterned)),
        other = seen_picture(picture_of(40, 30, [](int x, int y) {
            return (x + y) % 2 ? Color{1, 1, 1} : Color{x % 3 ? 0.f : 1.f, 0, y % 5 ? 0.f : 1.f};
        }));
    const std::vector<float> there = flip_differences(one, other), back = flip_differences(other, one);
    EXPECT_EQ(there, back);
    for (const float difference : there) ASSERT_TRUE(difference >= 0 && difference <= 1) << difference;
}

TEST(Flip, GrowsAsColorsAndHuesPart) {
    double last = 0;
    for (int step = 1; step <= 10; ++step) {  // from red to green, in light
        const float part = static_cast<float>(step) / 10;
        const double difference = flip(plain({1 - part, part, 0}), plain({1, 0, 0}));
        EXPECT_GT(difference, last) << part;
        last = difference;
    }
    last = 0;
    for (int step = 1; step <= 10; ++step) {
        const float grey = static_cast<float>(step) / 10;
        const double difference = flip(plain({grey, grey, grey}), plain({0, 0, 0}));
        EXPECT_GT(difference, last) << grey;
        last = difference;
    }
}

/// An edge that comes or goes is noticed more than the colours at that place say.
TEST(Flip, AnEdgeCountsMoreThanItsColors) {
    const auto half = [](float right) {
        return picture_of(64, 8, [right](int x, int) {
            const float grey = x < 32 ? .5f : right;
            return Color{grey, grey, grey};
        });
    };
    const std::vector<float> map = flip_differences(seen_picture(half(.3f)), seen_picture(half(.5f)));
    const float at_edge = map[4 * 64 + 33], beside = map[4 * 64 + 56];
    EXPECT_NEAR(beside, flip(plain({.3f, .3f, .3f}), plain({.5f, .5f, .5f})), 1e-5);
    EXPECT_GT(at_edge, beside);
}

TEST(Flip, WhatIsNoNumberIsBlack) {
    const float nan = std::numeric_limits<float>::quiet_NaN(),
                infinity = std::numeric_limits<float>::infinity();
    EXPECT_EQ(flip(plain({nan, nan, nan}), plain({0, 0, 0})), 0);
    EXPECT_EQ(flip(plain({infinity, -infinity, nan}), plain({1, 0, 0})), 0);
    EXPECT_EQ(flip(Image{}, Image{}), 0);
}

TEST(Flip, ThreadsChangeNoBit) {
    const Image picture = picture_of(61, 47, changed), reference = picture_of(61, 47, patterned);
    const std::vector<float> all = flip_differences(seen_picture(picture), seen_picture(reference));
    for (const size_t threads : {1, 3}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        EXPECT_EQ(flip_differences(seen_picture(picture), seen_picture(reference)), all);
    }
}

}  // namespace
}  // namespace trapeze
