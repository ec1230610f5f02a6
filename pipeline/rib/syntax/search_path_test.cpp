#include "pipeline/rib/syntax/search_path.h"

#include <algorithm>
#include <filesystem>

#include "pipeline/rib/reading_harness.h"

namespace trapeze::testing {
namespace {

using Paths = std::vector<std::string>;

/// A project with its scenes and shaders in folders of their own.
class SearchPath : public ::testing::Test {
  protected:
    SearchPath() {
        project_.write("shaders/x.sl", "");
        project_.write("scenes/shots/a.rib", "");
    }
    Folder project_;
    const std::string shots_ = project_.path() + "/scenes/shots";
};

TEST_F(SearchPath, FoldersAreSearchedBesideTheFileAndFromTheWorkingFolder) {
    EXPECT_EQ(rib::expand_search_path("nowhere:&:@::/nor/here", {"before"}, shots_),
              (Paths{shots_ + "/nowhere", "nowhere", "before", "/nor/here"}));
    EXPECT_EQ(rib::expand_search_path("nowhere", {}, ""), (Paths{"nowhere"}));
}

TEST_F(SearchPath, FoldersOfTheProjectAreSeenFromBelow) {
    EXPECT_EQ(rib::expand_search_path("shaders", {}, shots_),
              (Paths{shots_ + "/shaders", "shaders", shots_ + "/../../shaders"}));
    EXPECT_EQ(rib::expand_search_path("./shaders", {}, project_.path() + "/scenes").back(),
              project_.path() + "/scenes/.././shaders");
}

TEST_F(SearchPath, FoldersOfOtherMachinesAreKnownByTheirLastNames) {
    EXPECT_EQ(rib::expand_search_path("/home/somebody/work/shaders", {}, shots_),
              (Paths{"/home/somebody/work/shaders", shots_ + "/../../shaders"}));
}

TEST_F(SearchPath, WhatIsThereIsTakenAsItIs) {
    project_.write("scenes/shots/shaders/y.sl", "");
    EXPECT_EQ(rib::expand_search_path("shaders", {}, shots_), (Paths{shots_ + "/shaders", "shaders"}));
    EXPECT_EQ(rib::expand_search_path(shots_, {}, "elsewhere"), (Paths{shots_}));
}

/// Shaders and maps that a scene names from its project's folder are looked for there.
TEST_F(SearchPath, WorldsHaveTheFoldersAboveTheirFile) {
    const ReadOutcome r =
        read_files(project_, {project_.write("scenes/shots/b.rib", "WorldBegin " + kSphere + " WorldEnd")});
    ASSERT_EQ(r.worlds.size(), 1u);
    const Paths& folders = r.scene().options.search_paths.at("shader");
    EXPECT_TRUE(std::any_of(folders.begin(), folders.end(), [](const std::string& folder) {
        return std::filesystem::exists(folder + "/shaders/x.sl");
    }));
}

}  // namespace
}  // namespace trapeze::testing
