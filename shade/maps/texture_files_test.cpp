#include "shade/maps/texture_files.h"

#include <gtest/gtest.h>

#include "shade/materials/shader_folder_harness.h"

namespace trapeze {
namespace {

using testing::ShaderFolder;

class TextureFiles : public ::testing::Test {
  protected:
    void touch(const std::string& name) {
        const std::filesystem::path path = std::filesystem::path(folder_.path()) / name;
        std::filesystem::create_directories(path.parent_path());
        std::ofstream(path) << "picture";
    }
    std::string at(const std::string& name) const { return folder_.path() + "/" + name; }

    ShaderFolder folder_;
    const std::vector<std::string> folders_{"/nowhere", folder_.path()};
};

TEST_F(TextureFiles, AreFoundInFoldersAndByNamesOfOtherMachines) {
    touch("wood.tif");
    touch("maps/brick.tif");
    EXPECT_EQ(map_file("wood.tif", folders_), at("wood.tif"));
    EXPECT_EQ(map_file(at("wood.tif"), {}), at("wood.tif"));
    EXPECT_EQ(map_file("C:\\show\\maps\\brick.tif", folders_), at("maps/brick.tif"));
    EXPECT_EQ(map_file("/show/ann/wood.tif", folders_), at("wood.tif"));
    EXPECT_EQ(map_file("stone.tif", folders_), std::nullopt);
    EXPECT_EQ(map_file("", folders_), std::nullopt);
}

TEST_F(TextureFiles, SourcesStandInForTextures) {
    touch("wood.tif");
    touch("sky.jpg");
    touch("grid.png");
    EXPECT_EQ(source_of_texture("wood.tx", folders_), at("wood.tif"));
    EXPECT_EQ(source_of_texture("sky.jpg.tex", folders_), at("sky.jpg"));
    EXPECT_EQ(source_of_texture("/show/maps/grid.tif", folders_), at("grid.png"));
    EXPECT_EQ(source_of_texture("stone.tx", folders_), std::nullopt);
    EXPECT_EQ(source_of_texture("wood", folders_), std::nullopt);
    EXPECT_EQ(source_of_texture(".tx", folders_), std::nullopt);
}

}  // namespace
}  // namespace trapeze
