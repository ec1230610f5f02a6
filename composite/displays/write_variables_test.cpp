#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenImageIO/imagebuf.h>
#include <gtest/gtest.h>

#include "composite/displays/write_displays.h"
#include "composite/film/raster_harness.h"
#include "core/files/temporary_folder_harness.h"

namespace trapeze {
namespace {

using testing::RasterScene;
using testing::TemporaryFolder;

bool writes(const Image& image, const RasterScene& scene) {
    return write_displays(image, scene.context, {"Trapeze test", {}});
}

Image black_image(const RasterScene& scene) {
    Image image;
    image.width = scene.context.camera.width, image.height = scene.context.camera.height;
    image.window = scene.context.camera.crop;
    const size_t count = static_cast<size_t>(image.window.width()) * image.window.height();
    image.rgba.resize(4 * count), image.z.resize(count);
    return image;
}

/// With a float, x + y / 64, and a triple, (x, y, x + y) / 64, or two that are equal.
Image image_with_variables(const RasterScene& scene, int triples = 1) {
    Image image = black_image(scene);
    image.aov_channels = 1 + 3 * triples;
    for (int y = image.window.y0; y < image.window.y1; ++y)
        for (int x = image.window.x0; x < image.window.x1; ++x) {
            const auto column = static_cast<float>(x), row = static_cast<float>(y);
            const float values[] = {column + row / 64, column / 64, row / 64, (column + row) / 64};
            image.aovs.insert(image.aovs.end(), values, values + 4);
            if (triples == 2) image.aovs.insert(image.aovs.end(), values + 1, values + 4);
        }
    return image;
}

TEST(WriteVariables, OutputVariablesHaveFilesOfTheirOwn) {
    const TemporaryFolder folder;
    RasterScene scene(40, 30, 1);
    scene.scene.options.crop_window = {0.25f, 0.75f, 0.5f, 1};  // pixels 10..29, 15..29
    scene.update();
    scene.scene.options.displays = {
        {folder.file("a.exr"), "exr", "rgba", {}, {}},
        testing::aov_display("foo", ValueType::Float, folder.file("foo.exr")),
        testing::aov_display("N", ValueType::Normal, folder.file("N.exr")),
        testing::aov_display("N", ValueType::Color, folder.file("N_as_color.exr"))};
    const Image image = image_with_variables(scene, 2);
    EXPECT_TRUE(writes(image, scene));
    const struct {
        const char *file, *channel;
        Imf::PixelType type;
        int channels, from;
    } cases[] = {{"foo.exr", "Y", Imf::FLOAT, 1, 0},
                 {"N.exr", "N.X", Imf::FLOAT, 3, 1},
                 {"N.exr", "N.Z", Imf::FLOAT, 3, 3},
                 {"N_as_color.exr", "R", Imf::HALF, 3, 1},
                 {"N_as_color.exr", "B", Imf::HALF, 3, 3}};
    for (const auto& c : cases) {
        Imf::InputFile in(folder.file(c.file).c_str());
        const Imf::ChannelList& channels = in.header().channels();
        int count = 0;
        for (auto channel = channels.begin(); channel != channels.end(); ++channel) ++count;
        EXPECT_EQ(count, c.channels) << c.file;
        ASSERT_NE(channels.findChannel(c.channel), nullptr) << c.file << " " << c.channel;
        EXPECT_EQ(channels[c.channel].type, c.type) << c.file;
        std::vector<float> values(20 * 15);
        Imf::FrameBuffer buffer;
        buffer.insert(c.channel, Imf::Slice::Make(Imf::FLOAT, values.data(), in.header().dataWindow()));
        in.setFrameBuffer(buffer);
        in.readPixels(15, 29);
        for (size_t i = 0; i < values.size(); ++i)
            ASSERT_EQ(values[i], image.aovs[7 * i + static_cast<size_t>(c.from)]) << c.file;
    }
}

TEST(WriteVariables, OutputVariablesInTiffs) {
    const TemporaryFolder folder;
    RasterScene scene(40, 30, 1);
    Display foo = testing::aov_display("foo", ValueType::Float, folder.file("foo.tif")),
            bytes = testing::aov_display("Ci", ValueType::Color, folder.file("Ci.tif"));
    foo.type = bytes.type = "tiff";
    bytes.parameters.set({"quantize", {StorageClass::Uniform, ValueType::Float, 4}, {0, 64, 0, 255}, {}});
    bytes.parameters.set({"dither", {StorageClass::Uniform, ValueType::Float, 1}, {0}, {}});
    scene.scene.options.displays = {foo, bytes};
    scene.update();
    const Image image = image_with_variables(scene);
    ASSERT_TRUE(writes(image, scene));
    const OIIO::ImageBuf floats(folder.file("foo.tif")), words(folder.file("Ci.tif"));
    ASSERT_EQ(floats.nchannels(), 1);
    EXPECT_EQ(floats.spec().format, OIIO::TypeDesc::FLOAT);
    EXPECT_EQ(floats.getchannel(7, 3, 0, 0), 7 + 3.0f / 64);
    ASSERT_EQ(words.nchannels(), 3);
    EXPECT_EQ(words.spec().format, OIIO::TypeDesc::UINT8);
    EXPECT_FLOAT_EQ(words.getchannel(7, 3, 0, 0) * 255, 7);
    EXPECT_FLOAT_EQ(words.getchannel(39, 29, 0, 2) * 255, 39 + 29);
}

TEST(WriteVariables, APictureWithoutTheVariableIsAnError) {
    const TemporaryFolder folder;
    RasterScene scene(40, 30, 1);
    scene.scene.options.displays = {testing::aov_display("foo", ValueType::Float, folder.file("foo.exr")),
                                    testing::aov_display("N", ValueType::Normal, folder.file("N.tif"))};
    scene.scene.options.displays[1].type = "tiff";
    EXPECT_FALSE(writes(black_image(scene), scene));
    EXPECT_EQ(scene.diagnostics.count(Severity::Error), 2u);
    EXPECT_TRUE(folder.names().empty());
}

}  // namespace
}  // namespace trapeze
