#include "pipeline/frame/kept_pictures.h"
#include "core/files/file_text_harness.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace trapeze {
namespace {

namespace fs = std::filesystem;

class KeptPicturesTest : public ::testing::Test {
  protected:
    KeptPicturesTest() {
        std::string name = (fs::temp_directory_path() / "trapeze-kept-XXXXXX").string();
        folder_ = mkdtemp(name.data());
    }
    ~KeptPicturesTest() override { fs::remove_all(folder_); }

    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    void write(const std::string& name, int frame) {
        kept_.make_way(path(name), {});
        std::ofstream(path(name)) << frame;
        kept_.wrote(path(name), frame);
    }
    std::string text(const std::string& name) const { return testing::file_text(path(name)); }
    size_t files() const {
        return static_cast<size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
    }

    fs::path folder_;
    Diagnostics diagnostics_;
    KeptPictures kept_{diagnostics_};
};

TEST_F(KeptPicturesTest, EveryFrameIsLeft) {
    for (const int frame : {3, 4, 7}) write("a.exr", frame);
    EXPECT_EQ(text("a.3.exr"), "3");
    EXPECT_EQ(text("a.4.exr"), "4");
    EXPECT_EQ(text("a.exr"), "7");
    EXPECT_EQ(files(), 3u);
    EXPECT_EQ(diagnostics_.count(Severity::Note), 2u);
}

TEST_F(KeptPicturesTest, WorldsWithoutFramesAreCounted) {
    for (int world = 0; world < 3; ++world) write("a.exr", 0);
    EXPECT_TRUE(fs::exists(path("a.1.exr")));
    EXPECT_TRUE(fs::exists(path("a.2.exr")));
    EXPECT_EQ(files(), 3u);
}

TEST_F(KeptPicturesTest, NamesOfOtherPicturesAreNotTaken) {
    write("a.3.exr", 1);
    write("a.exr", 3);
    write("a.exr", 4);
    EXPECT_EQ(text("a.3.exr"), "1");
    EXPECT_EQ(text("a.4.exr"), "3");
    EXPECT_EQ(text("a.exr"), "4");
}

TEST_F(KeptPicturesTest, OtherFilesOfTheUserAreLeftAlone) {
    std::ofstream(path("a.3.exr")) << "letter";
    std::ofstream(path("a.4.exr")) << "3, of an earlier run";
    std::ofstream(path("a.exr")) << "3, a picture";
    kept_.wrote(path("a.exr"), 3);
    kept_.make_way(path("a.exr"), {});
    EXPECT_EQ(text("a.3.exr"), "letter");
    EXPECT_EQ(text("a.4.exr"), "3, a picture");
}

TEST_F(KeptPicturesTest, WhatNobodyMissesIsReplaced) {
    write("a.exr", 1);
    kept_.forget(path("./a.exr"));
    write("a.exr", 2);
    EXPECT_EQ(files(), 1u);
    EXPECT_EQ(diagnostics_.count(Severity::Note), 0u);
}

TEST_F(KeptPicturesTest, WhatAnEarlierRunWroteIsReplaced) {
    std::ofstream(path("a.exr")) << "old";
    write("a.exr", 1);
    EXPECT_EQ(files(), 1u);
}

}  // namespace
}  // namespace trapeze
