/// Files of whole numbers by a view of colour management; floats, which stay as they are.
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "composite/colors/color_library.h"
#include "composite/colors/small_config_harness.h"
#include "composite/displays/write_displays.h"
#include "composite/film/raster_harness.h"
#include "core/colors/transfer.h"
#include "core/files/file_text_harness.h"
#include "core/files/temporary_folder_harness.h"

namespace trapeze {
namespace {

using testing::RasterScene;
using testing::TemporaryFolder;

struct WishedView {
    std::string extension = "png", mode = "rgb";
    float one = 255;
    ColorRequest request = {};
    std::string transfer = "", colorspace = "";
    V3f color = {0.5f, 0.25f, 1};
    float alpha = 1;
};

struct WrittenView {
    std::vector<float> pixel;  ///< of whole numbers, from 0 to 1
    std::string description, working_space, bytes;
};

/// An even colour, premultiplied, without dither. The small config, if no other request is given.
WrittenView write_view(const WishedView& wished) {
    const TemporaryFolder folder;
    RasterScene scene(2, 2, 1);
    if (!wished.transfer.empty()) set_transfer(scene.scene.options, wished.transfer);
    ColorRequest request = wished.request;
    if (!request.asks()) request.config = testing::write_config(folder);
    std::string problem;
    const ColorLibrary* const library = color_library(&problem);
    if (library) scene.context.colors = library->open(request, &problem);
    EXPECT_TRUE(scene.context.colors) << problem;
    Display display{folder.file("a." + wished.extension), "file", wished.mode, {}, {}};
    display.parameters.set(
        {"quantize", {StorageClass::Uniform, ValueType::Float, 4}, {0, wished.one, 0, wished.one}, {}});
    display.parameters.set({"dither", {StorageClass::Uniform, ValueType::Float, 1}, {0}, {}});
    if (!wished.colorspace.empty())
        display.parameters.set(
            {"colorspace", {StorageClass::Uniform, ValueType::String, 1}, {}, {wished.colorspace}});
    scene.scene.options.displays = {display};
    Image image;
    image.width = image.height = 2;
    image.window = scene.context.camera.crop;
    for (int i = 0; i < 4; ++i)
        image.rgba.insert(image.rgba.end(), {wished.color.x, wished.color.y, wished.color.z, wished.alpha});
    image.z.resize(4);
    EXPECT_TRUE(write_displays(image, scene.context, {"Trapeze test", {}}));
    WrittenView written;
    OIIO::ImageSpec as_stored;
    as_stored.attribute("oiio:UnassociatedAlpha", 1);
    const auto in = OIIO::ImageInput::open(display.name, &as_stored);
    EXPECT_TRUE(in) << OIIO::geterror();
    if (!in) return written;
    written.pixel.resize(4 * static_cast<size_t>(in->spec().nchannels));
    EXPECT_TRUE(in->read_image(0, 0, 0, -1, OIIO::TypeDesc::FLOAT, written.pixel.data()));
    written.pixel.resize(in->spec().nchannels);
    written.description = in->spec().get_string_attribute("ImageDescription");
    written.working_space = in->spec().get_string_attribute("workingSpace");
    written.bytes = testing::file_text(display.name);
    return written;
}

/// Compares a pixel with values that become whole numbers up to `one`.
void expect_levels(const WrittenView& written, const std::vector<double>& values, double one = 255) {
    ASSERT_EQ(written.pixel.size(), values.size());
    for (size_t i = 0; i < values.size(); ++i)
        EXPECT_EQ(std::lround(written.pixel[i] * one), std::lround(std::min(values[i], 1.0) * one)) << i;
}

TEST(ViewsOfDisplays, AreInEightAndSixteenBits) {
    // (.5/2 + .25/4, .25, 1/2) squared.
    for (const char* extension : {"png", "tif", "bmp", "tga"})
        expect_levels(write_view({.extension = extension}), {0.09765625, 0.0625, 0.25});
    for (const char* extension : {"png", "tif"})
        expect_levels(write_view({.extension = extension, .one = 65535}), {0.09765625, 0.0625, 0.25}, 65535);
}

TEST(ViewsOfDisplays, ReplaceTheTransferAndNotADisplaysOwnWord) {
    expect_levels(write_view({.transfer = "srgb"}), {0.09765625, 0.0625, 0.25});
    expect_levels(write_view({.colorspace = "linear"}), {0.5, 0.25, 1});
    expect_levels(write_view({.transfer = "srgb", .colorspace = "linear"}), {0.5, 0.25, 1});
    expect_levels(write_view({.colorspace = "srgb"}), {0.735357, 0.537099, 1});
}

TEST(ViewsOfDisplays, LeaveAlphaAndSeeColoursAsTheFileHasThem) {
    // Premultiplied in a TIFF; others hold colours divided by alpha.
    const V3f half = V3f(0.5f, 0.25f, 1) / 2;
    expect_levels(write_view({.mode = "rgba", .color = half, .alpha = 0.5f}),
                  {0.09765625, 0.0625, 0.25, 0.5});
    expect_levels(write_view({.extension = "tif", .mode = "rgba", .color = half, .alpha = 0.5f}),
                  {0.09765625 / 4, 0.0625 / 4, 0.25 / 4, 0.5});
    // A glow has colour where nothing is.
    expect_levels(write_view({.mode = "rgba", .color = half, .alpha = 0}),
                  {0.09765625 / 4, 0.0625 / 4, 0.25 / 4, 0});
    expect_levels(write_view({.mode = "a", .color = half, .alpha = 0.5f}), {0.5});
}

TEST(ViewsOfDisplays, AreNotInFloats) {
    for (const char* extension : {"exr", "tif"}) {
        const WrittenView written = write_view({.extension = extension, .one = 0});
        EXPECT_EQ(written.pixel, (std::vector<float>{0.5f, 0.25f, 1})) << extension;
    }
}

TEST(ViewsOfDisplays, AreNamedInTheFile) {
    EXPECT_EQ(write_view({}).description, "workingSpace: work; display: screen; view: mixed");
    EXPECT_EQ(write_view({.extension = "tif", .one = 0}).description, "workingSpace: work; transfer: linear");
    EXPECT_EQ(write_view({.colorspace = "srgb"}).description, "workingSpace: work; transfer: srgb");
    EXPECT_EQ(write_view({.mode = "a"}).description, "");
    EXPECT_EQ(write_view({.extension = "exr", .one = 0}).working_space, "work");
    EXPECT_EQ(write_view({.request = {.view = "sRGB"}}).description,
              "workingSpace: Linear Rec.709; display: sRGB; view: sRGB");
    const TemporaryFolder folder;
    EXPECT_EQ(
        write_view({.request = {.config = testing::write_config(folder), .look = "double"}}).description,
        "workingSpace: work; display: screen; view: mixed; look: double");
    EXPECT_NE(write_view({.request = {.view = "sRGB"}}).bytes.find("gAMA"), std::string::npos);
    for (const char* chunk : {"sRGB", "gAMA", "iCCP"})
        EXPECT_EQ(write_view({}).bytes.find(chunk), std::string::npos) << chunk;
}

TEST(ViewsOfDisplays, OfTheBuiltInConfigAreTheTransferSrgb) {
    for (int i = 0; i <= 64; ++i) {
        const float value = static_cast<float>(i) / 60;
        const V3f color(value, value * value, value / 16);
        const auto viewed = write_view({.request = {.view = "sRGB"}, .color = color});
        const auto encoded = write_view({.colorspace = "srgb", .color = color});
        ASSERT_EQ(viewed.pixel.size(), 3u);
        for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(viewed.pixel[c], encoded.pixel[c], 1.001 / 255) << value;
    }
}

}  // namespace
}  // namespace trapeze
