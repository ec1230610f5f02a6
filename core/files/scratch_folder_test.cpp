#include "core/files/scratch_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "core/files/output_file.h"

namespace trapeze {
namespace {

namespace fs = std::filesystem;

TEST(ScratchFolder, GoesAwayWithItsFiles) {
    std::string path;
    {
        ScratchFolder folder;
        EXPECT_EQ(folder.path(), "") << "it is made when it is needed";
        const std::string first = folder.new_file(".exr"), second = folder.new_file(".tif");
        EXPECT_NE(first, second);
        EXPECT_TRUE(first.ends_with(".exr"));
        path = folder.path();
        std::ofstream(first) << "text";
        std::ofstream(second) << "text";
        folder.remove(first);
        EXPECT_FALSE(fs::exists(first));
        EXPECT_TRUE(fs::exists(second));
    }
    EXPECT_FALSE(fs::exists(path));
}

TEST(ScratchFolder, GoesAwayWhenTheProcessIsToEnd) {
    ScratchFolder folder;
    std::ofstream(folder.new_file(".exr")) << "text";
    OutputFile half(folder.new_file(".exr"));
    ASSERT_TRUE(half.open());
    OutputFile::remove_partials();
    EXPECT_FALSE(fs::exists(folder.path()));
}

}  // namespace
}  // namespace trapeze
