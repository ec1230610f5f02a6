#include "core/files/foreign_paths.h"

#include <gtest/gtest.h>

namespace trapeze {
namespace {

using Names = std::vector<std::string>;

TEST(ForeignPaths, LeadingFoldersAreLeftOutOneByOne) {
    EXPECT_EQ(other_names("/home/ann/maps/wood.tif"),
              (Names{"home/ann/maps/wood.tif", "ann/maps/wood.tif", "maps/wood.tif", "wood.tif"}));
    EXPECT_EQ(other_names("//D/jobs//a.rib"), (Names{"D/jobs//a.rib", "jobs//a.rib", "a.rib"}));
    EXPECT_EQ(other_names("maps/wood.tif"), (Names{"wood.tif"}));
}

TEST(ForeignPaths, BackslashesSeparateFoldersToo) {
    EXPECT_EQ(other_names("C:\\maps\\wood.tif"), (Names{"C:/maps/wood.tif", "maps/wood.tif", "wood.tif"}));
}

TEST(ForeignPaths, BareNamesHaveNoOthers) {
    EXPECT_EQ(other_names("wood.tif"), Names{});
    EXPECT_EQ(other_names(""), Names{});
    EXPECT_EQ(other_names("maps/"), Names{});
}

}  // namespace
}  // namespace trapeze
