#include "pipeline/preview/preview_picture.h"

#include <gtest/gtest.h>

#include <cmath>

#include "pipeline/preview/preview_harness.h"

namespace trapeze {
namespace {

using testing::make_preview_picture;
using testing::NumberedPicture;

const PixelRect kWindow{5, 3, 60, 45};

TEST(PreviewPicture, TellsChangesInTheOrderInWhichTheyCame) {
    const NumberedPicture numbers(kWindow, 5);
    const auto picture = make_preview_picture(kWindow);
    EXPECT_EQ(picture->version(), 0u);
    EXPECT_TRUE(picture->changes_after(0).pixels.empty());
    picture->put({32, 16, 48, 32}, numbers.source());
    picture->put({18, 18, 30, 30}, numbers.source());
    auto changes = picture->changes_after(0);
    ASSERT_EQ(changes.pixels.size(), 2u);
    EXPECT_EQ(changes.pixels[0], (PixelRect{32, 16, 48, 32}));
    EXPECT_EQ(changes.pixels[1], (PixelRect{18, 18, 30, 30}));

    // The same tile, now whole: one change more, in place of its first.
    const uint64_t seen = changes.versions[1];
    picture->put({16, 16, 32, 32}, numbers.source());
    changes = picture->changes_after(seen);
    ASSERT_EQ(changes.pixels.size(), 1u);
    EXPECT_EQ(changes.pixels[0], (PixelRect{16, 16, 32, 32}));
    EXPECT_EQ(changes.versions[0], picture->version());
    EXPECT_EQ(picture->changes_after(0).pixels.size(), 2u);
    EXPECT_TRUE(picture->changes_after(picture->version()).pixels.empty());
}

TEST(PreviewPicture, HasTheValuesThatItWasGivenAndNoOthers) {
    // The source has a margin, as a film does whose picture glows.
    const NumberedPicture numbers({-4, -2, 64, 48}, 5);
    const auto picture = make_preview_picture(kWindow);
    picture->put({0, 0, 16, 16}, numbers.source());
    const std::vector<int> channels{4, 1};
    const PixelRect asked{5, 3, 18, 17};
    const auto values = picture->values(asked, channels);
    ASSERT_EQ(values.size(), 2u * 13 * 14);
    size_t at = 0;
    for (const int c : channels)
        for (int y = asked.y0; y < asked.y1; ++y)
            for (int x = asked.x0; x < asked.x1; ++x, ++at)
                if (x < 16 && y < 16)
                    EXPECT_EQ(values[at], NumberedPicture::value(static_cast<size_t>(c), x, y));
                else
                    EXPECT_TRUE(std::isnan(values[at]));
}

TEST(PreviewPicture, LeavesOutWhatIsBeyondItsWindow) {
    const NumberedPicture numbers({-16, -16, 80, 64}, 5);
    const auto picture = make_preview_picture(kWindow);
    picture->put({-16, -16, 0, 0}, numbers.source());
    picture->put({64, 0, 80, 16}, numbers.source());
    EXPECT_EQ(picture->version(), 0u);
}

TEST(PreviewPicture, OnlyTilesThatAnImagerHasChangedAreChangesAtTheEnd) {
    const NumberedPicture numbers(kWindow, 5);
    const auto picture = make_preview_picture(kWindow);
    size_t tiles = 0;
    for (int y = 0; y < 48; y += 16)
        for (int x = 0; x < 64; x += 16, ++tiles)
            if (tiles != 5) picture->put(intersection({x, y, x + 16, y + 16}, kWindow), numbers.source());
    const uint64_t seen = picture->version();
    NumberedPicture changed = numbers;
    changed.values[2][0] += 1;
    EXPECT_FALSE(picture->is_closed());
    picture->finish(changed.source());
    EXPECT_TRUE(picture->is_finished() && picture->is_closed());
    const auto changes = picture->changes_after(seen);
    ASSERT_EQ(changes.pixels.size(), 2u);
    EXPECT_EQ(changes.pixels[0], (PixelRect{5, 3, 16, 16}));
    EXPECT_EQ(changes.pixels[1], (PixelRect{16, 16, 32, 32}));
    EXPECT_EQ(picture->values({5, 3, 6, 4}, std::vector<int>{2})[0], NumberedPicture::value(2, 5, 3) + 1);
}

TEST(PreviewPicture, OneThatIsBrokenOffIsNotFinished) {
    const auto picture = make_preview_picture(kWindow);
    picture->close();
    EXPECT_TRUE(picture->is_closed());
    EXPECT_FALSE(picture->is_finished());
}

}  // namespace
}  // namespace trapeze
