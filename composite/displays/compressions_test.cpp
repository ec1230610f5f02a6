/// Display "compression", by what is in the files.
#include "composite/displays/compressions.h"

#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include "composite/displays/write_displays.h"
#include "composite/film/raster_harness.h"
#include "core/files/temporary_folder_harness.h"

namespace trapeze {
namespace {

using testing::RasterScene;
using testing::TemporaryFolder;

struct WrittenFiles {
    std::vector<std::string> messages;
    uint64_t warnings = 0;
};

/// An even picture of a Display that asks for a compression.
WrittenFiles write(const std::string& file, const std::string& name, const char* parameter = "compression") {
    RasterScene scene(64, 64, 1);
    WrittenFiles result;
    Diagnostics diagnostics([&](const Diagnostic& d) { result.messages.push_back(d.text); });
    scene.context.diagnostics = &diagnostics;
    Display display{file, "file", "rgb", {}, {}};
    display.parameters.set({parameter, {StorageClass::Uniform, ValueType::String, 1}, {}, {name}});
    scene.scene.options.displays = {display};
    Image image;
    image.width = image.height = 64;
    image.window = scene.context.camera.crop;
    image.rgba.assign(64 * 64 * 4, 0.25f), image.z.resize(64 * 64);
    EXPECT_TRUE(write_displays(image, scene.context, {"Trapeze test", {}})) << file << name;
    result.warnings = diagnostics.count(Severity::Warning);
    return result;
}

TEST(Compressions, OfOpenExrAreAllHonoured) {
    const TemporaryFolder folder;
    const std::pair<const char*, Imf::Compression> cases[] = {
        {"none", Imf::NO_COMPRESSION},  {"rle", Imf::RLE_COMPRESSION},   {"zips", Imf::ZIPS_COMPRESSION},
        {"zip", Imf::ZIP_COMPRESSION},  {"piz", Imf::PIZ_COMPRESSION},   {"PXR24", Imf::PXR24_COMPRESSION},
        {"b44", Imf::B44_COMPRESSION},  {"b44a", Imf::B44A_COMPRESSION}, {"dwaa", Imf::DWAA_COMPRESSION},
        {"dwab", Imf::DWAB_COMPRESSION}};
    for (const char* parameter : {"compression", "exrcompression"})
        for (const auto& [name, compression] : cases) {
            EXPECT_EQ(write(folder.file("a.exr"), name, parameter).warnings, 0u) << name;
            EXPECT_EQ(Imf::InputFile(folder.file("a.exr").c_str()).header().compression(), compression)
                << name;
        }
}

TEST(Compressions, OfOtherFormatsAreHonoured) {
    const TemporaryFolder folder;
    const std::pair<const char*, const char*> cases[] = {
        {"none", "none"}, {"lzw", "lzw"}, {"zip", "zip"}, {"deflate", "zip"}, {"packbits", "packbits"}};
    for (const auto& [name, stored] : cases) {
        EXPECT_EQ(write(folder.file("a.tif"), name).warnings, 0u) << name;
        const auto in = OIIO::ImageInput::open(folder.file("a.tif"));
        ASSERT_TRUE(in) << name;
        EXPECT_EQ(in->spec().get_string_attribute("compression"), stored) << name;
    }
    const auto bytes = [&](const std::string& file, const char* name) {
        EXPECT_EQ(write(folder.file(file), name).warnings, 0u) << file << name;
        return std::filesystem::file_size(folder.file(file));
    };
    EXPECT_GT(bytes("a.png", "none"), 3u * 64 * 64);
    EXPECT_LT(bytes("a.png", "zip"), 3u * 64 * 64);
    EXPECT_GT(bytes("a.tga", "none"), 3u * 64 * 64);
    EXPECT_LT(bytes("a.tga", "rle"), 3u * 64 * 64);
}

TEST(Compressions, OthersAreRefusedByName) {
    const TemporaryFolder folder;
    const WrittenFiles exr = write(folder.file("a.exr"), "lzw");
    ASSERT_EQ(exr.warnings, 1u);
    EXPECT_EQ(exr.messages[0],
              "\"lzw\" is no compression of \"" + folder.file("a.exr") +
                  "\", whose format has none, rle, zips, zip, piz, pxr24, b44, b44a, dwaa, dwab; the "
                  "usual one is used");
    EXPECT_EQ(Imf::InputFile(folder.file("a.exr").c_str()).header().compression(), Imf::ZIP_COMPRESSION);
    EXPECT_EQ(write(folder.file("a.tif"), "piz").warnings, 1u);
    EXPECT_EQ(write(folder.file("a.png"), "lzw").warnings, 1u);
    EXPECT_EQ(write(folder.file("a.bmp"), "rle").warnings, 1u);
}

}  // namespace
}  // namespace trapeze
