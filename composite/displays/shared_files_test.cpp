#include "composite/displays/shared_files.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTiledInputFile.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "composite/displays/write_displays.h"
#include "composite/film/raster_harness.h"
#include "core/files/temporary_folder_harness.h"

namespace trapeze {
namespace {

using testing::aov_display;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::RasterScene;
using testing::TemporaryFolder;

Parameter text_parameter(const char* name, const char* value) {
    return {name, {StorageClass::Uniform, ValueType::String, 1}, {}, {value}};
}

/// A scene that collects its warnings and errors.
struct LayerScene : RasterScene {
    LayerScene() : RasterScene(40, 30, 1) { context.diagnostics = &heard; }

    std::vector<std::string> messages;
    Diagnostics heard{[this](const Diagnostic& diagnostic) {
        if (diagnostic.severity != Severity::Note) messages.push_back(to_string(diagnostic));
    }};

    void show(std::vector<Display> displays) { scene.options.displays = std::move(displays); }
    /// With values that name their place, in all that the displays ask for.
    Image image() const {
        Image made;
        made.width = 40, made.height = 30, made.window = context.camera.crop;
        made.aov_channels = aov_layout(scene.options).channel_count;
        for (uint32_t i = 0; i < uint32_t(made.window.width() * made.window.height()); ++i) {
            for (uint32_t c = 0; c < 4; ++c) made.rgba.push_back(static_cast<float>(4 * (i % 256) + c));
            for (int c = 0; c < made.aov_channels; ++c) made.aovs.push_back(static_cast<float>(10 * i) + c);
            made.z.push_back(static_cast<float>(i) / 3), made.id.push_back(~i * 77);
        }
        return made;
    }
    bool write() { return write_displays(image(), context, {"Trapeze test", {}}); }
};

std::vector<std::string> names_of_channels(const std::string& file) {
    const Imf::InputFile in(file.c_str());
    std::vector<std::string> names;
    const Imf::ChannelList& channels = in.header().channels();
    for (auto channel = channels.begin(); channel != channels.end(); ++channel)
        names.push_back(std::string(channel.name()) + " HFU"[channel.channel().type == Imf::HALF    ? 1
                                                             : channel.channel().type == Imf::FLOAT ? 2
                                                                                                    : 3]);
    return names;
}

template <class Value>
std::vector<Value> channel_of(const std::string& file, const char* name, Imf::PixelType type) {
    Imf::InputFile in(file.c_str());
    const Box2i window = in.header().dataWindow();
    std::vector<Value> values(static_cast<size_t>(window.max.x - window.min.x + 1) *
                              static_cast<size_t>(window.max.y - window.min.y + 1));
    Imf::FrameBuffer buffer;
    buffer.insert(name, Imf::Slice::Make(type, values.data(), window));
    in.setFrameBuffer(buffer);
    in.readPixels(window.min.y, window.max.y);
    return values;
}

TEST(SharedFiles, DisplaysOfOneOpenExrAreItsLayers) {
    const TemporaryFolder folder;
    LayerScene scene;
    const std::string file = folder.file("a.exr");
    Display full = aov_display("Oi", ValueType::Color, file);
    full.parameters.set(text_parameter("type", "float"));
    Display named = aov_display("Ci", ValueType::Color, file);
    named.layer = "even";
    scene.show({{file, "exr", "rgba", {}, {}},
                {file, "exr", "z", {}, {}},
                {folder.file("./a.exr"), "file", "id", {}, {}},
                aov_display("albedo", ValueType::Color, file),
                full,
                named,
                aov_display("N", ValueType::Normal, file),
                aov_display("wet", ValueType::Float, file)});
    ASSERT_TRUE(scene.write());
    EXPECT_THAT(scene.messages, IsEmpty());
    EXPECT_THAT(folder.names(), ElementsAre("a.exr"));
    EXPECT_THAT(names_of_channels(file),
                ElementsAre("AH", "BH", "GH", "N.XF", "N.YF", "N.ZF", "Oi.BF", "Oi.GF", "Oi.RF", "RH", "ZF",
                            "albedo.BH", "albedo.GH", "albedo.RH", "even.BH", "even.GH", "even.RH", "id.YU",
                            "wet.YF"));
    const Image image = scene.image();
    EXPECT_EQ(channel_of<float>(file, "Z", Imf::FLOAT), image.z);
    EXPECT_EQ(channel_of<uint32_t>(file, "id.Y", Imf::UINT), image.id);
    const auto green = channel_of<float>(file, "G", Imf::FLOAT),
               oi = channel_of<float>(file, "Oi.B", Imf::FLOAT),
               even = channel_of<float>(file, "even.R", Imf::FLOAT),
               ny = channel_of<float>(file, "N.Y", Imf::FLOAT),
               wet = channel_of<float>(file, "wet.Y", Imf::FLOAT);
    for (size_t i = 0; i < image.z.size(); ++i) {
        ASSERT_EQ(green[i], image.rgba[4 * i + 1]);
        const float* const values = &image.aovs[13 * i];
        ASSERT_EQ(oi[i], values[5]);
        ASSERT_EQ(even[i], Imath::half(values[6]));
        ASSERT_EQ(ny[i], values[10]);
        ASSERT_EQ(wet[i], values[12]);
    }
}

TEST(SharedFiles, WhatIsThereAlreadyAndWhatIsNoOpenExrGoesBeside) {
    const TemporaryFolder folder;
    LayerScene scene;
    scene.show({{folder.file("a.exr"), "exr", "rgb", {}, {}},
                {folder.file("a.exr"), "exr", "a", {}, {}},
                {folder.file("a.exr"), "exr", "rgbz", {}, {}},
                {folder.file("b.tif"), "tiff", "rgba", {}, {}},
                aov_display("N", ValueType::Normal, folder.file("b.tif"))});
    scene.scene.options.displays.back().type = "tiff";
    ASSERT_TRUE(scene.write());
    EXPECT_THAT(folder.names(), ElementsAre("a.exr", "a.rgbz.exr", "b.N.tif", "b.tif"));
    EXPECT_THAT(names_of_channels(folder.file("a.exr")), ElementsAre("AH", "BH", "GH", "RH"));
    ASSERT_EQ(scene.messages.size(), 2u);
    EXPECT_THAT(scene.messages[0], HasSubstr("a.rgbz.exr\" is written beside it"));
}

TEST(SharedFiles, TheFileIsAsTheFirstDisplayWantsItThatSays) {
    const TemporaryFolder folder;
    LayerScene scene;
    const std::string file = folder.file("a.exr");
    Display tiles{file, "exr", "z", {}, {}}, other{file, "exr", "a", {}, {}};
    tiles.parameters.set(text_parameter("storage", "tiled"));
    tiles.parameters.set({"tilesize", {StorageClass::Uniform, ValueType::Integer, 1}, {16}, {}});
    tiles.parameters.set(text_parameter("compression", "piz"));
    tiles.parameters.set(text_parameter("exrheader_who", "first"));
    other.parameters.set(text_parameter("compression", "rle"));
    other.parameters.set(text_parameter("exrheader_who", "second"));
    other.parameters.set(text_parameter("exrheader_more", "more"));
    scene.show({{file, "exr", "rgb", {}, {}}, tiles, other});
    // A crop whose first tile is not at a multiple of the side.
    scene.scene.options.crop_window = {0.125f, 0.9f, 0.1f, 1};
    scene.update(), scene.context.diagnostics = &scene.heard;
    ASSERT_TRUE(scene.write());
    EXPECT_THAT(scene.messages, ElementsAre(HasSubstr("has one compression, \"piz\"; \"rle\" is not used")));
    const Imf::TiledInputFile in(file.c_str());
    EXPECT_EQ(in.tileXSize(), 16u);
    EXPECT_EQ(in.header().compression(), Imf::PIZ_COMPRESSION);
    EXPECT_EQ(in.header().typedAttribute<Imf::StringAttribute>("who").value(), "first");
    EXPECT_EQ(in.header().typedAttribute<Imf::StringAttribute>("more").value(), "more");
    EXPECT_EQ(channel_of<float>(file, "Z", Imf::FLOAT), scene.image().z);
}

TEST(SharedFiles, IdsAreNotCompressedWithLoss) {
    for (const char* lossy : {"pxr24", "b44", "b44a", "dwaa", "dwab"}) {
        const TemporaryFolder folder;
        LayerScene scene;
        Display first{folder.file("a.exr"), "exr", "rgba", {}, {}};
        first.parameters.set(text_parameter("compression", lossy));
        scene.show({first});
        ASSERT_TRUE(scene.write());
        EXPECT_THAT(scene.messages, IsEmpty());
        scene.show({first, {folder.file("a.exr"), "exr", "id", {}, {}}});
        ASSERT_TRUE(scene.write());
        EXPECT_THAT(scene.messages,
                    ElementsAre(HasSubstr(std::string("compression \"") + lossy + "\" would lose")));
        EXPECT_EQ(Imf::InputFile(folder.file("a.exr").c_str()).header().compression(), Imf::ZIP_COMPRESSION);
        EXPECT_EQ(channel_of<uint32_t>(folder.file("a.exr"), "id.Y", Imf::UINT), scene.image().id);
    }
}

TEST(SharedFiles, ALayerThatIsNotThereIsOneErrorAndNoFile) {
    const TemporaryFolder folder;
    LayerScene scene;
    scene.show({{folder.file("a.exr"), "exr", "rgba", {}, {}},
                aov_display("N", ValueType::Normal, folder.file("a.exr"))});
    Image image = scene.image();
    image.aov_channels = 0, image.aovs.clear();
    EXPECT_FALSE(write_displays(image, scene.context, {"Trapeze test", {}}));
    EXPECT_THAT(scene.messages, ElementsAre(HasSubstr("no output variables were recorded")));
    EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(SharedFiles, StorageThatIsNotThereIsTold) {
    const TemporaryFolder folder;
    LayerScene scene;
    Display odd{folder.file("a.exr"), "exr", "rgba", {}, {}},
        png{folder.file("a.png"), "png", "rgba", {}, {}};
    odd.parameters.set(text_parameter("storage", "spiral"));
    png.parameters.set(text_parameter("storage", "tiled"));
    scene.show({odd, png});
    ASSERT_TRUE(scene.write());
    EXPECT_THAT(scene.messages, ElementsAre(HasSubstr("\"spiral\" is neither tiled nor scanline"),
                                            HasSubstr("only OpenEXR files are written in tiles")));
}

}  // namespace
}  // namespace trapeze
