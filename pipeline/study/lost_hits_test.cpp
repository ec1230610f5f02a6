#include "pipeline/study/lost_hits.h"

#include <gtest/gtest.h>

namespace trapeze {
namespace {

Image grey(int width, int height) {
    Image image;
    image.width = width, image.height = height, image.window = {0, 0, width, height};
    image.rgba.assign(static_cast<size_t>(width) * height * 4, .5f);
    return image;
}

TEST(LostHits, PixelsDifferInAnyChannel) {
    const Image right = grey(4, 2);
    EXPECT_EQ(pixels_that_differ(right, right), 0u);
    Image wrong = right;
    wrong.rgba[4 * 3 + 1] = 0;
    wrong.rgba[4 * 5 + 3] = .25f;  // coverage alone
    EXPECT_EQ(pixels_that_differ(right, wrong), 2u);
}

TEST(LostHits, AreRedAndTheRestIsDarker) {
    const Image right = grey(2, 1);
    Image wrong = right;
    wrong.rgba[4] = 0;
    const StudyCloseUps pictures = pictures_of_lost_hits("flakes", right, wrong);
    ASSERT_EQ(pictures.pictures.size(), 3u);
    EXPECT_EQ(pictures.pictures[0].second.rgb, std::vector<float>(6, .5f));
    EXPECT_EQ(pictures.pictures[1].second.rgb[3], 0);
    EXPECT_EQ(pictures.pictures[2].second.rgb, (std::vector<float>{.125f, .125f, .125f, 1, 0, 0}));
}

}  // namespace
}  // namespace trapeze
