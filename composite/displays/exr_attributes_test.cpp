/// What headers say of a picture: parameters "exrheader_NAME" of Displays, and where the picture comes from.
#include "composite/displays/exr_attributes.h"

#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfVecAttribute.h>
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include "composite/displays/write_displays.h"
#include "composite/film/raster_harness.h"
#include "core/files/temporary_folder_harness.h"

namespace trapeze {
namespace {

using testing::RasterScene;
using testing::TemporaryFolder;

Parameter value(const char* name, ValueType type, std::vector<float> floats, int length = 1) {
    return {std::string("exrheader_") + name, {StorageClass::Uniform, type, length}, std::move(floats), {}};
}

/// The number of warnings.
uint64_t write(const std::string& file, std::vector<Parameter> parameters, const OutputInfo& info) {
    RasterScene scene(8, 8, 1);
    Display display{file, "file", "rgb", {}, {}};
    for (Parameter& parameter : parameters) display.parameters.set(std::move(parameter));
    scene.scene.options.displays = {display};
    Image image;
    image.width = image.height = 8;
    image.window = scene.context.camera.crop;
    image.rgba.assign(8 * 8 * 4, 0.25f), image.z.resize(8 * 8);
    EXPECT_TRUE(write_displays(image, scene.context, info)) << file;
    return scene.diagnostics.count(Severity::Warning);
}

template <class Attribute>
auto read(const Imf::Header& header, const char* name) {
    return header.typedAttribute<Attribute>(name).value();
}

TEST(ExrAttributes, EveryTypeIsKept) {
    const TemporaryFolder folder;
    const std::vector<float> m = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16};
    const std::string file = folder.file("a.exr");
    EXPECT_EQ(write(file,
                    {{"exrheader_artist", {StorageClass::Uniform, ValueType::String, 1}, {}, {"Somebody"}},
                     value("weight", ValueType::Float, {0.5f}),
                     value("take", ValueType::Integer, {7}),
                     value("range", ValueType::Float, {1, 2}, 2),
                     value("tile", ValueType::Integer, {3, 4}, 2),
                     value("place", ValueType::Point, {1, 2, 3}),
                     value("tint", ValueType::Color, {4, 5, 6}),
                     value("room", ValueType::Matrix, m),
                     {"exrheader_software", {StorageClass::Uniform, ValueType::String, 1}, {}, {"another"}}},
                    {"Trapeze test", {}}),
              0u);
    const Imf::InputFile in(file.c_str());
    const Imf::Header& h = in.header();
    EXPECT_EQ(read<Imf::StringAttribute>(h, "artist"), "Somebody");
    EXPECT_EQ(read<Imf::FloatAttribute>(h, "weight"), 0.5f);
    EXPECT_EQ(read<Imf::IntAttribute>(h, "take"), 7);
    EXPECT_EQ(read<Imf::V2fAttribute>(h, "range"), Imath::V2f(1, 2));
    EXPECT_EQ(read<Imf::V2iAttribute>(h, "tile"), Imath::V2i(3, 4));
    EXPECT_EQ(read<Imf::V3fAttribute>(h, "place"), Imath::V3f(1, 2, 3));
    EXPECT_EQ(read<Imf::V3fAttribute>(h, "tint"), Imath::V3f(4, 5, 6));
    EXPECT_EQ(read<Imf::M44fAttribute>(h, "room")[3][2], 15);
    EXPECT_EQ(read<Imf::StringAttribute>(h, "software"), "another");
}

TEST(ExrAttributes, WhatTheFileItselfSaysIsLeftOutWithAWarning) {
    const TemporaryFolder folder;
    const std::string file = folder.file("a.exr");
    EXPECT_EQ(write(file,
                    {value("dataWindow", ValueType::Integer, {1, 2, 3, 4}, 4),
                     value("pixelAspectRatio", ValueType::Float, {3}), value("", ValueType::Float, {3}),
                     value("nothing", ValueType::Float, {})},
                    {"Trapeze test", {}}),
              4u);
    EXPECT_EQ(Imf::InputFile(file.c_str()).header().pixelAspectRatio(), 1);
    EXPECT_EQ(write(folder.file("a.tif"), {value("weight", ValueType::Float, {3})}, {"Trapeze test", {}}),
              1u);
}

TEST(Headers, SayWhereAPictureComesFrom) {
    const TemporaryFolder folder;
    const OutputInfo info{"Trapeze test", {}, 12, "shot.rib", "2026:01:31 23:59:58"};
    write(folder.file("a.exr"), {}, info);
    const Imf::InputFile in(folder.file("a.exr").c_str());
    EXPECT_EQ(read<Imf::IntAttribute>(in.header(), "frame"), 12);
    EXPECT_EQ(read<Imf::StringAttribute>(in.header(), "scene"), "shot.rib");
    EXPECT_EQ(Imf::capDate(in.header()), "2026:01:31 23:59:58");
    EXPECT_EQ(Imf::utcOffset(in.header()), 0);
    for (const char* name : {"a.tif", "a.png", "a.jpg"}) {
        write(folder.file(name), {}, info);
        const auto picture = OIIO::ImageInput::open(folder.file(name));
        ASSERT_TRUE(picture) << name;
        EXPECT_EQ(picture->spec().get_string_attribute("ImageDescription"),
                  "frame: 12; scene: shot.rib; transfer: linear")
            << name;
        EXPECT_EQ(picture->spec().get_string_attribute("DateTime"), info.date) << name;
        EXPECT_EQ(picture->spec().get_string_attribute("Software"), "Trapeze test") << name;
    }
}

}  // namespace
}  // namespace trapeze
