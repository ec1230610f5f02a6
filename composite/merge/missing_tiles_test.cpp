#include "composite/merge/missing_tiles.h"

#include <gtest/gtest.h>

namespace trapeze {
namespace {

Box2i box(int x0, int x1, int y0, int y1) {
    return {V2i(x0, y0), V2i(x1, y1)};
}

TEST(MissingTiles, AreTheNumbersThatTheGridHasBesides) {
    EXPECT_EQ(missing_numbers({{3, 2, 6}, {3, 2, 1}, {3, 2, 3}, {3, 2, 3}}), (std::vector<int>{2, 4, 5}));
    EXPECT_TRUE(missing_numbers({{2, 1, 2}, {2, 1, 1}}).empty());
    EXPECT_TRUE(missing_numbers({}).empty());
}

TEST(MissingTiles, GapsAreWhatNoWindowHas) {
    EXPECT_TRUE(gaps_between({box(0, 4, 0, 4), box(5, 9, 0, 4), box(0, 9, 5, 6)}, 9).empty());
    EXPECT_TRUE(gaps_between({box(0, 9, 0, 9), box(3, 4, 3, 4)}, 9).empty()) << "windows may overlap";
    EXPECT_EQ(gaps_between({box(0, 4, 0, 4), box(5, 9, 5, 9)}, 9),
              (std::vector<Box2i>{box(5, 9, 0, 4), box(0, 4, 5, 9)}));
    EXPECT_EQ(gaps_between({box(-5, -4, -3, 0), box(0, 1, -3, -1)}, 9),
              (std::vector<Box2i>{box(-3, -1, -3, -1), box(-3, 1, 0, 0)}));
    EXPECT_EQ(gaps_between({box(0, 0, 0, 0), box(4, 4, 0, 0), box(2, 2, 0, 0)}, 1),
              (std::vector<Box2i>{box(1, 1, 0, 0)}));
}

TEST(MissingTiles, AreListedInShort) {
    EXPECT_EQ(listed({3}), "3");
    EXPECT_EQ(listed({3, 4}), "3 and 4");
    EXPECT_EQ(listed({1, 3, 4, 5, 6, 9}), "1, 3 to 6 and 9");
    EXPECT_EQ(listed({1, 2, 3}), "1 to 3");
    EXPECT_EQ(listed({1, 2, 7, 8, 9}), "1, 2 and 7 to 9");
}

}  // namespace
}  // namespace trapeze
