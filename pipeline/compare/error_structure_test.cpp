#include "pipeline/compare/error_structure.h"

#include <gtest/gtest.h>

#include <random>

namespace trapeze {
namespace {

constexpr int kSide = 256, kBlock = 8;

/// An image of a window that does not begin at 0, of which `value` says every number.
template <class Value>
Image image_of(Value value) {
    Image image;
    image.width = image.height = kSide + 3;
    image.window = {3, 3, kSide + 3, kSide + 3};
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x)
            for (int c = 0; c < 4; ++c) image.rgba.push_back(c == 3 ? 1 : value(x, y, c));
    image.z.resize(image.rgba.size() / 4);
    return image;
}

const Image& grey_reference() {
    static const Image image = image_of([](int, int, int) { return .5f; });
    return image;
}

TEST(PictureError, OfNoiseIsEveryPixelsOwn) {
    std::mt19937 random(7);
    std::normal_distribution<float> normal(0, .1f);
    const Image noisy = image_of([&](int, int, int) { return .5f + normal(random); });
    const PictureError error = picture_error(noisy, grey_reference(), kBlock);
    EXPECT_NEAR(error.rmse, .1, .001);
    EXPECT_NEAR(error.pixels_together, 1, .1);
}

TEST(PictureError, OfWhatBlocksShareIsTheirPixels) {
    const Image shifted = image_of([](int, int, int) { return .6f; });
    const PictureError error = picture_error(shifted, grey_reference(), kBlock);
    EXPECT_NEAR(error.rmse, .1, 1e-6);
    EXPECT_NEAR(error.pixels_together, kBlock * kBlock, 1e-3);
}

/// Noise that repeats: a tile of numbers, as of samples that all of the picture shares.
TEST(PictureError, FallsWithTheSizeOfTilesThatRepeat) {
    double last = 1e30;
    for (const int tile : {1, 2, 4, 8}) {
        std::mt19937 random(9);
        std::normal_distribution<float> normal(0, .1f);
        std::vector<float> values;
        for (int i = 0; i < 3 * tile * tile; ++i) values.push_back(normal(random));
        const Image repeated = image_of([&](int x, int y, int c) {
            return .5f + values[static_cast<size_t>(3 * ((y % tile) * tile + x % tile) + c)];
        });
        const double together = picture_error(repeated, grey_reference(), kBlock).pixels_together;
        EXPECT_LT(together, last) << tile;
        last = together;
    }
}

TEST(PictureError, OfAlternatingPixelsIsNone) {
    const Image board = image_of([](int x, int y, int) { return (x + y) % 2 ? .6f : .4f; });
    EXPECT_NEAR(picture_error(board, grey_reference(), kBlock).pixels_together, 0, 1e-6);
}

TEST(BlockMeans, KeepWhatABlockSharesAndLoseTheRest) {
    const Image board = image_of([](int x, int y, int c) {
        return (x < kBlock ? .1f : .7f) * static_cast<float>(c + 1) + ((x + y) % 2 ? .05f : -.05f);
    });
    const Image means = block_means(board, kBlock);
    EXPECT_EQ(means.window, board.window);
    for (size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(means.rgba[4 * means.index(3, 3) + c], .1f * static_cast<float>(c + 1), 1e-6f);
        EXPECT_NEAR(means.rgba[4 * means.index(3 + kBlock, 90) + c], .7f * static_cast<float>(c + 1), 1e-6f);
    }
}

TEST(PictureError, OfTheReferenceIsNothing) {
    const PictureError error = picture_error(grey_reference(), grey_reference(), kBlock);
    EXPECT_EQ(error.rmse, 0);
    EXPECT_EQ(error.pixels_together, 0);
}

TEST(PictureError, OfLessThanABlockIsOneBlock) {
    const Image black = image_of([](int, int, int) { return 0.f; });
    EXPECT_NEAR(picture_error(black, grey_reference(), kSide + 1).pixels_together, kSide * kSide, 1);
}

TEST(PictureError, OfSmallerBlocksAtTheBordersCountsToo) {
    std::mt19937 random(8);
    std::normal_distribution<float> normal(0, .1f);
    const Image noisy = image_of([&](int, int, int) { return .5f + normal(random); });
    EXPECT_NEAR(picture_error(noisy, grey_reference(), 7).pixels_together, 1, .1);
}

}  // namespace
}  // namespace trapeze
