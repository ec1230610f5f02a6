#include "core/picture_tile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace trapeze {
namespace {

TEST(PictureTile, EveryPixelIsInOneTile) {
    for (const PixelRect crop : {PixelRect{0, 0, 96, 64}, PixelRect{5, 7, 18, 18}, PixelRect{3, 2, 4, 3}})
        for (const auto& [columns, rows] : {std::pair{1, 1}, {3, 2}, {4, 3}, {13, 11}}) {
            if (!can_divide(crop, {columns, rows, 1})) continue;
            std::vector<int> seen(static_cast<size_t>(crop.width() * crop.height()));
            int least = 1 << 30, most = 0;
            for (int number = 1; number <= columns * rows; ++number) {
                const PixelRect part = part_of(crop, {columns, rows, number});
                ASSERT_FALSE(part.empty());
                EXPECT_EQ(intersection(part, crop), part);
                least = std::min(least, part.width()), most = std::max(most, part.width());
                for (int y = part.y0; y < part.y1; ++y)
                    for (int x = part.x0; x < part.x1; ++x)
                        ++seen[static_cast<size_t>((y - crop.y0) * crop.width() + x - crop.x0)];
            }
            EXPECT_LE(most - least, 1);
            EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<long>(seen.size()))
                << columns << "x" << rows << " of " << crop.width() << "x" << crop.height();
        }
}

TEST(PictureTile, CountsRowByRow) {
    const PixelRect crop{10, 20, 20, 26};
    EXPECT_EQ(part_of(crop, {5, 2, 1}), (PixelRect{10, 20, 12, 23}));
    EXPECT_EQ(part_of(crop, {5, 2, 5}), (PixelRect{18, 20, 20, 23}));
    EXPECT_EQ(part_of(crop, {5, 2, 6}), (PixelRect{10, 23, 12, 26}));
    EXPECT_EQ(part_of(crop, {4, 1, 2}), (PixelRect{12, 20, 15, 26}));
    EXPECT_EQ(part_of({0, 0, 65536, 65536}, {4096, 4096, 4096 * 4096}),
              (PixelRect{65520, 65520, 65536, 65536}));
}

TEST(PictureTile, NeedsAPixelForEachTile) {
    EXPECT_TRUE(can_divide({0, 0, 4, 3}, {4, 3, 1}));
    EXPECT_FALSE(can_divide({0, 0, 4, 3}, {5, 3, 1}));
    EXPECT_FALSE(can_divide({0, 0, 4, 3}, {4, 4, 1}));
    EXPECT_FALSE(can_divide({2, 2, 2, 2}, {1, 1, 1}));
}

TEST(PictureTile, HasANameThatIsReadBack) {
    EXPECT_EQ(name_of({4, 3, 7}), "7 of 4x3");
    EXPECT_EQ(tile_named("7 of 4x3"), (PictureTile{4, 3, 7}));
    EXPECT_EQ(tile_named("16777216 of 4096x4096"), (PictureTile{4096, 4096, 4096 * 4096}));
    for (const char* name : {"", "7", "13 of 4x3", "0 of 4x3", "7 of 4x", "7 of 0x3", "7 of 4x3 ",
                             " 7 of 4x3", "7 of 5000x3", "99999999999 of 4x3", "-1 of 4x3", "7of 4x3"})
        EXPECT_FALSE(tile_named(name)) << name;
}

TEST(PictureTile, IsInTheNamesOfFiles) {
    EXPECT_EQ(with_tile_number("x.exr", {2, 2, 3}), "x.tile3.exr");
    EXPECT_EQ(with_tile_number("d.1/x.y.exr", {4, 3, 3}), "d.1/x.y.tile03.exr");
    EXPECT_EQ(with_tile_number("d.1/x", {4, 3, 12}), "d.1/x.tile12");
    EXPECT_EQ(with_tile_number("<tile>/x.<tile>.exr", {4, 3, 3}), "03/x.03.exr");
    EXPECT_EQ(with_tile_number("x", {1, 1, 1}), "x.tile1");
}

}  // namespace
}  // namespace trapeze
