#include "core/files/output_file.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "core/files/file_text_harness.h"
#include "core/files/temporary_folder_harness.h"

namespace trapeze {
namespace {

using testing::FileSizeLimit;
using testing::TemporaryFolder;
using Names = std::vector<std::string>;

void put(const std::string& path, const std::string& text) {
    std::ofstream(path) << text;
}

TEST(OutputFile, AppearsAtCommitAndNotBefore) {
    const TemporaryFolder folder;
    put(folder.file("x.exr"), "old");
    OutputFile file(folder.file("x.exr"));
    ASSERT_TRUE(file.open());
    EXPECT_TRUE(file.write("xxworld", 7));
    EXPECT_TRUE(file.seek(0));
    EXPECT_TRUE(file.write("my", 2));
    EXPECT_EQ(file.position(), 2u);
    EXPECT_EQ(testing::file_text(folder.file("x.exr")), "old");
    EXPECT_EQ(folder.names().size(), 2u);
    EXPECT_TRUE(file.commit()) << file.error();
    EXPECT_EQ(testing::file_text(folder.file("x.exr")), "myworld");
    EXPECT_EQ(folder.names(), Names{"x.exr"});
}

TEST(OutputFile, LeavesNothingWhenAbandoned) {
    const TemporaryFolder folder;
    {
        OutputFile file(folder.file("x.exr"));
        ASSERT_TRUE(file.open());
        EXPECT_TRUE(file.write("half", 4));
        EXPECT_EQ(folder.names().size(), 1u);
    }
    EXPECT_TRUE(folder.names().empty());
}

TEST(OutputFile, LeavesNothingWhenTheProcessIsToEnd) {
    const TemporaryFolder folder;
    OutputFile file(folder.file("x.exr"));
    ASSERT_TRUE(file.open());
    EXPECT_TRUE(file.write("half", 4));
    OutputFile::remove_partials();
    EXPECT_TRUE(folder.names().empty());
    EXPECT_FALSE(file.commit());
    EXPECT_TRUE(folder.names().empty());
}

TEST(OutputFile, SaysWhatIsInTheWay) {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder.file("sub"));
    put(folder.file("plain"), "");
    for (const auto& [path, reason] : {std::pair{folder.file("none/x.exr"), "there is no folder"},
                                       {folder.file("plain/x.exr"), "there is no folder"},
                                       {folder.file("sub"), "it is a folder"},
                                       {folder.path() + "/", "names no file"},
                                       {std::string("/dev/null"), "not a regular"}}) {
        OutputFile file(path);
        EXPECT_FALSE(file.open()) << path;
        EXPECT_NE(file.error().find(reason), std::string::npos) << path << ": " << file.error();
        EXPECT_FALSE(file.write("x", 1));
        EXPECT_FALSE(file.commit());
    }
    EXPECT_EQ(folder.names(), (Names{"plain", "sub"}));
}

TEST(OutputFile, WritesThroughALink) {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder.file("real"));
    std::filesystem::create_symlink("real/x.exr", folder.file("x.exr"));
    for (const std::string text : {"new", "newer"}) {  // first dangling, then not
        OutputFile file(folder.file("x.exr"));
        ASSERT_TRUE(file.open()) << file.error();
        EXPECT_TRUE(file.write(text.data(), text.size()) && file.commit()) << file.error();
        EXPECT_TRUE(std::filesystem::is_symlink(folder.file("x.exr")));
        EXPECT_EQ(testing::file_text(folder.file("real/x.exr")), text);
    }
}

TEST(OutputFile, LongNames) {
    const TemporaryFolder folder;
    const std::string name = std::string(251, 'n') + ".exr";
    OutputFile file(folder.file(name));
    EXPECT_TRUE(file.open() && file.write("x", 1) && file.commit()) << file.error();
    EXPECT_EQ(folder.names(), Names{name});
}

TEST(OutputFile, LeftoversAreThoseThatNobodyWrites) {
    const TemporaryFolder folder;
    for (const char* name : {"x.exr.123.part-4", "x.exr.part-4", "x.exr.12a.part-4", "y.exr.123.part-4"})
        put(folder.file(name), "left");
    {
        OutputFile file(folder.file("x.exr"));
        ASSERT_TRUE(file.open() && file.write("new", 3));
        OutputFile::remove_leftovers(folder.file("x.exr"));
        EXPECT_TRUE(file.commit()) << file.error();
    }
    EXPECT_EQ(folder.names(), (Names{"x.exr", "x.exr.12a.part-4", "x.exr.part-4", "y.exr.123.part-4"}));
}

TEST(OutputFile, AFullDiskIsAnError) {
    const TemporaryFolder folder;
    put(folder.file("x.exr"), "old");
    const std::string text(100000, 'x');
    for (const size_t limit :
         {1000u, 99999u}) {  // within the first write, and only when the last of it is flushed
        const FileSizeLimit full(limit);
        OutputFile file(folder.file("x.exr"));
        ASSERT_TRUE(file.open());
        for (size_t at = 0; at < text.size(); at += 1000) file.write(text.data() + at, 1000);
        EXPECT_FALSE(file.commit());
        EXPECT_FALSE(file.error().empty());
    }
    EXPECT_EQ(folder.names(), Names{"x.exr"});
    EXPECT_EQ(testing::file_text(folder.file("x.exr")), "old");
}

}  // namespace
}  // namespace trapeze
