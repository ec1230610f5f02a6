#include "pipeline/frame/tiles/tile_order.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace trapeze {
namespace {

TEST(Tiles, CoverTheRectangleAlignedToTheRaster) {
    const auto tiles = tiles_of({-3, 5, 40, 33});
    int pixels = 0;
    for (const PixelRect& tile : tiles) {
        pixels += tile.width() * tile.height();
        EXPECT_TRUE(tile.x0 == -3 || tile.x0 % kTileSide == 0);
        EXPECT_LE(tile.width(), kTileSide);
    }
    EXPECT_EQ(pixels, 43 * 28);
    EXPECT_EQ(tiles.front(), (PixelRect{-3, 5, 0, 16}));
}

TEST(CoarseFirst, GoesFromEveryEighthTileToAll) {
    const auto tiles = tiles_of({0, 0, 20 * 16, 10 * 16}, 16);
    const auto ordered = coarse_first(tiles);
    ASSERT_EQ(ordered.size(), 200u);
    EXPECT_EQ(ordered[0], (PixelRect{0, 0, 16, 16}));
    EXPECT_EQ(ordered[1], (PixelRect{128, 0, 144, 16}));
    EXPECT_EQ(ordered[2], (PixelRect{256, 0, 272, 16}));
    EXPECT_EQ(ordered[3], (PixelRect{0, 128, 16, 144}));
    // Then every fourth that was not there yet.
    EXPECT_EQ(ordered[6], (PixelRect{64, 0, 80, 16}));
    EXPECT_EQ(ordered.back(), (PixelRect{304, 144, 320, 160}));
}

TEST(CoarseFirst, HasEveryTileOnce) {
    for (const PixelRect& pixels :
         {PixelRect{-3, -5, 77, 131}, PixelRect{5, 5, 6, 6}, PixelRect{0, 0, 400, 1}, PixelRect{}}) {
        const auto tiles = tiles_of(pixels, 16);
        auto ordered = coarse_first(tiles);
        const auto by_place = [](const PixelRect& a, const PixelRect& b) {
            return std::pair(a.y0, a.x0) < std::pair(b.y0, b.x0);
        };
        std::ranges::sort(ordered, by_place);
        EXPECT_EQ(ordered, tiles);
    }
}

/// Any first part of the order is spread over the picture: of each quarter it has about as much.
TEST(CoarseFirst, IsSpreadOverThePicture) {
    const auto ordered = coarse_first(tiles_of({0, 0, 32 * 16, 32 * 16}, 16));
    for (const size_t part : {16u, 64u, 256u}) {
        int quarters[4] = {};
        for (size_t i = 0; i < part; ++i)
            ++quarters[(ordered[i].x0 >= 256 ? 1 : 0) + (ordered[i].y0 >= 256 ? 2 : 0)];
        for (const int count : quarters) EXPECT_EQ(count, static_cast<int>(part) / 4) << part;
    }
}

}  // namespace
}  // namespace trapeze
