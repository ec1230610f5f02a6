#include "core/files/access.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cerrno>
#include <filesystem>
#include <fstream>

#include "core/files/picture_files.h"

namespace trapeze {
namespace {

namespace fs = std::filesystem;

/// A working folder beside one that is closed.
class AccessTest : public ::testing::Test {
  protected:
    AccessTest() {
        std::string pattern = (fs::temp_directory_path() / "trapeze-access-XXXXXX").string();
        root_ = fs::canonical(mkdtemp(pattern.data()));
        fs::create_directories(root_ / "work/sub");
        fs::create_directories(root_ / "outside");
        write("work/sub/a.txt", "inside");
        write("outside/secret.txt", "secret");
        fs::current_path(root_ / "work");
        confined_ = Access::confined();
    }
    ~AccessTest() override {
        fs::current_path(before_);
        fs::remove_all(root_);
    }

    void write(const std::string& name, const std::string& text) const {
        std::ofstream(root_ / name, std::ios::binary) << text;
    }
    std::string text(const std::string& path) const {
        std::string bytes;
        return confined_.read(path, 1000, &bytes) ? bytes : "(refused)";
    }

    const fs::path before_ = fs::current_path();
    fs::path root_;
    Access confined_;
};

TEST_F(AccessTest, ByDefaultEverythingIsRead) {
    std::string bytes;
    EXPECT_TRUE(kEverything.read("../outside/secret.txt", 1000, &bytes));
    EXPECT_EQ(bytes, "secret");
    EXPECT_FALSE(kEverything.read("../outside/secret.txt", 5, &bytes));
    EXPECT_FALSE(kEverything.read("../outside", 1000, &bytes));
    EXPECT_TRUE(kEverything.may_see_environment());
}

TEST_F(AccessTest, ConfinedReadsBelowTheWorkingFolder) {
    EXPECT_EQ(text("sub/a.txt"), "inside");
    EXPECT_EQ(text("sub/../sub/./a.txt"), "inside");
    EXPECT_EQ(text((root_ / "work/sub/a.txt").string()), "inside");
    for (const char* name : {"../outside/secret.txt", "sub/../../outside/secret.txt", "/etc/passwd",
                             "../work-other/x", "nowhere/../../outside/secret.txt", "..", "/"}) {
        EXPECT_FALSE(confined_.may_read(name)) << name;
        EXPECT_EQ(text(name), "(refused)") << name;
    }
    EXPECT_FALSE(confined_.may_see_environment());
}

TEST_F(AccessTest, LinksCountAsWhatTheyLeadTo) {
    fs::create_symlink(root_ / "outside/secret.txt", "file");
    fs::create_directory_symlink("../../outside", "sub/folder");
    fs::create_symlink("round", "round");
    fs::create_symlink(root_ / "outside/not-yet.txt", "dangling");
    fs::create_symlink("sub/a.txt", "good");
    EXPECT_EQ(text("file"), "(refused)");
    EXPECT_EQ(text("sub/folder/secret.txt"), "(refused)");
    EXPECT_EQ(text("round"), "(refused)");
    EXPECT_FALSE(confined_.may_read("dangling"));
    EXPECT_NE(confined_.may_write("dangling").problem, "");
    EXPECT_NE(confined_.may_write("sub/folder/new.exr").problem, "");
    EXPECT_EQ(text("good"), "inside");
}

TEST_F(AccessTest, ConfinedOpensRegularFilesAlone) {
    ASSERT_EQ(mkfifo("pipe", 0600), 0);
    EXPECT_EQ(confined_.open_to_read("pipe"), nullptr);  // and does not wait for who writes it
    EXPECT_EQ(confined_.open_to_read("/dev/zero"), nullptr);
    EXPECT_EQ(errno, EACCES);
    EXPECT_EQ(confined_.open_to_read("sub"), nullptr);
}

TEST_F(AccessTest, TheUsersFoldersAreOpen) {
    confined_.allow_reading_below("../outside");
    EXPECT_EQ(text("../outside/secret.txt"), "secret");
    EXPECT_NE(confined_.may_write("../outside/new.exr").problem, "");
    confined_.allow_reading_below("/");
    EXPECT_FALSE(confined_.may_read("/etc/passwd"));
}

TEST_F(AccessTest, TheRootOfAllIsNoWorkingFolder) {
    fs::current_path("/");
    const Access access = Access::confined();
    fs::current_path(root_ / "work");
    EXPECT_FALSE(access.may_read("sub/a.txt"));
    EXPECT_NE(access.may_write("new.exr").problem, "");
}

TEST_F(AccessTest, ConfinedWritesHereOrWhereTheUserSays) {
    EXPECT_EQ(confined_.may_write("sub/new.exr").problem, "");
    EXPECT_NE(confined_.may_write("../outside/new.exr").problem, "");
    confined_.allow_writing("../outside/new.exr");
    EXPECT_EQ(confined_.may_write("../outside/new.exr").problem, "");
    EXPECT_NE(confined_.may_write("../outside/other.exr").problem, "");
    // A link may have come with the scene.
    confined_.allow_writing("link.exr");
    fs::create_symlink(root_ / "outside/secret.txt", "link.exr");
    EXPECT_NE(confined_.may_write("link.exr").problem, "");
}

TEST_F(AccessTest, ConfinedOverwritesPicturesAlone) {
    write("work/old.exr", "\x76\x2f\x31\x01rest");
    write("work/empty.exr", "");
    write("work/old.ptc", "pptc and more");
    write("work/old.ply", "ply\nformat ascii 1.0\ncomment point cloud of Trapeze\n");
    write("work/mesh.ply", "ply\nformat ascii 1.0\n");
    EXPECT_EQ(confined_.may_write("old.ptc").problem, "");
    EXPECT_EQ(confined_.may_write("old.ply").problem, "");
    EXPECT_EQ(confined_.may_write("mesh.ply").problem, "the file that is there is not a picture");
    EXPECT_EQ(confined_.may_write("old.exr").problem, "");
    EXPECT_EQ(confined_.may_write("empty.exr").problem, "");
    EXPECT_EQ(confined_.may_write("sub/a.txt").problem, "the file that is there is not a picture");
    confined_.allow_writing("sub/a.txt");
    EXPECT_EQ(confined_.may_write("sub/a.txt").problem, "");
}

TEST_F(AccessTest, PicturesAloneAreOverwritten) {
    Access access;
    EXPECT_EQ(access.may_write("sub/a.txt").problem, "the file that is there is not a picture");
    EXPECT_EQ(access.may_write("sub/new.txt").problem, "");
    write("work/old.rib", "\x76\x2f\x31\x01rest");
    EXPECT_EQ(access.may_write("old.rib").problem, "");
    EXPECT_FALSE(access.may_write("sub/a.txt").is_elsewhere);
    EXPECT_NE(access.may_write("../outside/secret.txt").problem, "");
    EXPECT_EQ(access.may_write("../outside/new.exr").problem, "");
    EXPECT_TRUE(access.may_write("../outside/new.exr").is_elsewhere);
    fs::create_symlink(root_ / "outside/secret.txt", "link.exr");
    EXPECT_NE(access.may_write("link.exr").problem, "");
    access.allow_writing("../outside/secret.txt");
    EXPECT_EQ(access.may_write("../outside/secret.txt").problem, "");
    EXPECT_FALSE(access.may_write("../outside/secret.txt").is_elsewhere);
}

TEST_F(AccessTest, PicturesAreKnownByWhatTheyBeginWith) {
    using namespace std::string_literals;
    const std::string targa = "\0\0\2\0\0\0\0\0\0\0\0\0\x40\0\x30\0\x18\0"s + std::string(100, 'x');
    for (const auto& [bytes, format] : {std::pair{"\x76\x2f\x31\x01"s, "openexr"},
                                        {"II*\0...."s, "tiff"},
                                        {"MM\0*...."s, "tiff"},
                                        {"\x89PNG\r\n\x1a\n"s, "png"},
                                        {"\xff\xd8\xff\xe0"s, "jpeg"},
                                        {"BM\1\2\3\4\0\0\0\0"s, "bmp"},
                                        {"#?RADIANCE\n"s, "hdr"},
                                        {targa, "targa"},
                                        {"int main() { return 0; }\n"s, ""},
                                        {""s, ""},
                                        {"BMW is no picture"s, ""},
                                        {"##RenderMan RIB-Structure 1.0\n"s, ""}}) {
        write("work/file", bytes);
        EXPECT_EQ(picture_format("file"), format) << bytes;
    }
}

}  // namespace
}  // namespace trapeze
