/// Option "color" "transfer": the numbers of files of 8 and 16 bits.
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "composite/displays/write_displays.h"
#include "composite/film/raster_harness.h"
#include "core/colors/transfer.h"
#include "core/files/file_text_harness.h"
#include "core/files/temporary_folder_harness.h"

namespace trapeze {
namespace {

using testing::RasterScene;
using testing::TemporaryFolder;

double encoded(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

struct WishedTransfer {
    std::string extension = "png", transfer = "", colorspace = "";
    float one = 255, gamma = 1;
};

struct WrittenTransfer {
    int level = -1;
    std::string description, bytes;
};

/// An even grey of 1/4, without dither.
WrittenTransfer write_quarter(const WishedTransfer& wished) {
    const TemporaryFolder folder;
    RasterScene scene(4, 4, 1);
    scene.scene.options.exposure_gamma = wished.gamma;
    if (!wished.transfer.empty()) set_transfer(scene.scene.options, wished.transfer);
    Display display{folder.file("a." + wished.extension), "file", "rgb", {}, {}};
    display.parameters.set(
        {"quantize", {StorageClass::Uniform, ValueType::Float, 4}, {0, wished.one, 0, wished.one}, {}});
    display.parameters.set({"dither", {StorageClass::Uniform, ValueType::Float, 1}, {0}, {}});
    if (!wished.colorspace.empty())
        display.parameters.set(
            {"colorspace", {StorageClass::Uniform, ValueType::String, 1}, {}, {wished.colorspace}});
    scene.scene.options.displays = {display};
    Image image;
    image.width = image.height = 4;
    image.window = scene.context.camera.crop;
    image.rgba.assign(4 * 4 * 4, 0.25f), image.z.resize(4 * 4);
    EXPECT_TRUE(write_displays(image, scene.context, {"Trapeze test", {}}));
    WrittenTransfer written;
    const auto in = OIIO::ImageInput::open(display.name);
    EXPECT_TRUE(in) << OIIO::geterror();
    if (!in) return written;
    EXPECT_EQ(in->spec().format, wished.one > 255 ? OIIO::TypeDesc::UINT16 : OIIO::TypeDesc::UINT8);
    std::vector<uint16_t> pixels(3 * 4 * 4);
    EXPECT_TRUE(in->read_image(0, 0, 0, -1, OIIO::TypeDesc::UINT16, pixels.data()));
    written.level = wished.one > 255 ? pixels[0] : pixels[0] / 257;
    written.description = in->spec().get_string_attribute("ImageDescription");
    written.bytes = testing::file_text(display.name);
    return written;
}

TEST(TransferOfDisplays, NumbersAreQuantizesUntilSomethingElseIsAsked) {
    for (const char* extension : {"png", "tif"}) {
        EXPECT_EQ(write_quarter({extension}).level, 64);
        EXPECT_EQ(write_quarter({extension, "linear"}).level, 64);
        EXPECT_EQ(write_quarter({.extension = extension, .one = 65535}).level, 16384);
    }
    EXPECT_EQ(write_quarter({"bmp"}).level, 64);
    EXPECT_EQ(write_quarter({"tga"}).level, 64);
}

TEST(TransferOfDisplays, SrgbEncodesEightAndSixteenBits) {
    for (const char* extension : {"png", "tif"}) {
        EXPECT_EQ(write_quarter({extension, "srgb"}).level, std::lround(255 * encoded(0.25)));
        EXPECT_EQ(write_quarter({.extension = extension, .transfer = "srgb", .one = 65535}).level,
                  std::lround(65535 * encoded(0.25)));
    }
}

TEST(TransferOfDisplays, AutoEncodesEightBitsWhereExposureHasNoGamma) {
    EXPECT_EQ(write_quarter({"png", "auto"}).level, std::lround(255 * encoded(0.25)));
    EXPECT_EQ(write_quarter({.transfer = "auto", .one = 65535}).level, 16384);
    EXPECT_EQ(write_quarter({.transfer = "auto", .gamma = 2.2f}).level, 64);  // Exposure comes before
    EXPECT_EQ(write_quarter({.transfer = "srgb", .gamma = 2.2f}).level, std::lround(255 * encoded(0.25)));
}

TEST(TransferOfDisplays, ADisplaysOwnWordCounts) {
    EXPECT_EQ(write_quarter({"png", "srgb", "linear"}).level, 64);
    EXPECT_EQ(write_quarter({"png", "", "srgb"}).level, std::lround(255 * encoded(0.25)));
}

TEST(TransferOfDisplays, FilesSayWhatWasWritten) {
    EXPECT_EQ(write_quarter({"png", "srgb"}).description, "transfer: srgb");
    EXPECT_EQ(write_quarter({"tif", "linear"}).description, "transfer: linear");
    EXPECT_EQ(write_quarter({.extension = "tif", .gamma = 2.2f}).description, "transfer: gamma 2.2");
    EXPECT_NE(write_quarter({"png", "srgb"}).bytes.find("sRGB"), std::string::npos);
    for (const char* chunk : {"sRGB", "gAMA", "iCCP"})
        EXPECT_EQ(write_quarter({"png", "linear"}).bytes.find(chunk), std::string::npos) << chunk;
}

}  // namespace
}  // namespace trapeze
