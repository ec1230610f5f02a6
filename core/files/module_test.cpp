#include "core/files/module.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "core/files/temporary_folder_harness.h"

namespace trapeze {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

/// The built module by a name of its own.
OpenedModule open_harness_as(const std::string& name) {
    const TemporaryFolder empty, folder;
    fs::create_symlink(TRAPEZE_MODULE_HARNESS, folder.file(module_file(name)));
    return open_module(name, {empty.path(), folder.path()});
}

TEST(Module, IsOpenedFromTheFirstFolderThatHasIt) {
    const OpenedModule opened = open_harness_as("harness");
    ASSERT_TRUE(opened.offered) << opened.problem;
    EXPECT_EQ(*static_cast<const int*>(opened.offered), 42);
    EXPECT_EQ(opened.problem, "");
}

TEST(Module, ThatIsNotThereSaysWhereItWasLookedFor) {
    const OpenedModule opened = open_module("lost", {"/nowhere", "/neither", "/here"});
    EXPECT_FALSE(opened.offered);
    EXPECT_EQ(opened.problem, "trapeze-lost.so is not in \"/nowhere\", \"/neither\" and \"/here\"");
    EXPECT_EQ(open_module("lost", {"/nowhere"}).problem, "trapeze-lost.so is not in \"/nowhere\"");
}

TEST(Module, OfAnotherVersionIsRefused) {
    const OpenedModule opened = open_harness_as("old");
    EXPECT_FALSE(opened.offered);
    EXPECT_THAT(opened.problem, HasSubstr("is of Trapeze 0.0.1, this is " TRAPEZE_VERSION));
}

TEST(Module, ThatIsAnotherLibraryIsRefused) {
    const OpenedModule opened = open_harness_as("strange");
    EXPECT_FALSE(opened.offered);
    EXPECT_THAT(opened.problem, HasSubstr("trapeze-strange.so\" is no module of Trapeze"));
}

TEST(Module, ThatIsNoLibraryIsRefused) {
    const TemporaryFolder folder;
    std::ofstream(folder.file(module_file("text"))) << "text";
    const OpenedModule opened = open_module("text", {folder.path()});
    EXPECT_FALSE(opened.offered);
    EXPECT_THAT(opened.problem, HasSubstr("cannot load " + folder.file("trapeze-text.so")));
}

TEST(Module, LiesBesideTheProgramOrInAnInstallsFolder) {
    const fs::path program = fs::canonical("/proc/self/exe").parent_path();
    const std::vector<std::string> folders = module_folders();
    ASSERT_GE(folders.size(), 2u);
    EXPECT_EQ(folders[0], program.string());
    EXPECT_EQ(folders[1], (program.parent_path() / "lib/trapeze").string());
}

}  // namespace
}  // namespace trapeze
