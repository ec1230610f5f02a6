#include "composite/displays/write_displays.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cmath>

#include "composite/film/raster_harness.h"
#include "core/colors/transfer.h"
#include "core/files/temporary_folder_harness.h"

namespace trapeze {
namespace {

using testing::FileSizeLimit;
using testing::RasterScene;
using testing::TemporaryFolder;

const OutputInfo kInfo{"Trapeze test", {{"sampler", "raytrace"}, {"samples", "8x8"}}};

/// Colours that name their pixel; alpha 1/2 in odd columns, there premultiplied.
Image numbered_image(const RasterScene& scene) {
    Image image;
    image.width = scene.context.camera.width, image.height = scene.context.camera.height;
    image.window = scene.context.camera.crop;
    const size_t count = static_cast<size_t>(image.window.width()) * image.window.height();
    image.rgba.resize(4 * count), image.z.resize(count), image.id.resize(count);
    for (int y = image.window.y0; y < image.window.y1; ++y)
        for (int x = image.window.x0; x < image.window.x1; ++x) {
            const size_t at = image.index(x, y);
            const float alpha = x % 2 ? 0.5f : 1.0f;
            const float rgba[] = {static_cast<float>(x) / 64 * alpha, static_cast<float>(y) / 64 * alpha,
                                  0.25f * alpha, alpha};
            std::copy(rgba, rgba + 4, &image.rgba[4 * at]);
            image.z[at] = x == 9 ? kInfinity : static_cast<float>(100 * x + y) + 0.125f;
            image.id[at] = static_cast<uint32_t>(1000 * x + y) * 70000u;
        }
    return image;
}

struct WrittenDisplays {
    bool good;
    std::vector<std::string> paths;
};

WrittenDisplays write(const Image& image, const RasterScene& scene) {
    WrittenDisplays result;
    std::vector<WrittenFile> files;
    result.good = write_displays(image, scene.context, kInfo, &files);
    for (const WrittenFile& file : files) result.paths.push_back(file.path);
    return result;
}

void set_crop(RasterScene& scene) {
    scene.scene.options.crop_window = {0.25f, 0.75f, 0.5f, 1};  // pixels 10..29, 15..29 of 40 x 30
    scene.update();
}

TEST(WriteDisplays, OpenExrWindowsTypesAndMetadata) {
    const TemporaryFolder folder;
    RasterScene scene(40, 30, 1);
    set_crop(scene);
    scene.scene.options.pixel_aspect = 1.5f;
    scene.scene.options.projection = "perspective";
    scene.update();
    scene.scene.camera_from_world = M44f(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 3, 4, 5, 1);
    scene.scene.options.displays = {{folder.file("a.exr"), "openexr", "rgbaz", {}, {}}};
    const Image image = numbered_image(scene);
    const WrittenDisplays result = write(image, scene);
    EXPECT_TRUE(result.good);
    EXPECT_EQ(result.paths, std::vector<std::string>{folder.file("a.exr")});
    EXPECT_EQ(folder.names(), std::vector<std::string>{"a.exr"});

    Imf::InputFile in(folder.file("a.exr").c_str());
    const Imf::Header& header = in.header();
    EXPECT_EQ(header.displayWindow(), Box2i(V2i(0, 0), V2i(39, 29)));
    EXPECT_EQ(header.dataWindow(), Box2i(V2i(10, 15), V2i(29, 29)));
    EXPECT_EQ(header.pixelAspectRatio(), 1.5f);
    EXPECT_EQ(header.compression(), Imf::ZIP_COMPRESSION);
    EXPECT_EQ(header.typedAttribute<Imf::StringAttribute>("software").value(), "Trapeze test");
    EXPECT_EQ(header.typedAttribute<Imf::StringAttribute>("sampler").value(), "raytrace");
    EXPECT_EQ(Imf::worldToCamera(header), scene.scene.camera_from_world);
    for (const char* name : {"R", "G", "B", "A"}) EXPECT_EQ(header.channels()[name].type, Imf::HALF) << name;
    EXPECT_EQ(header.channels()["Z"].type, Imf::FLOAT);

    std::vector<float> red(20 * 15), z(20 * 15);
    Imf::FrameBuffer buffer;
    buffer.insert("R", Imf::Slice::Make(Imf::FLOAT, red.data(), header.dataWindow()));
    buffer.insert("Z", Imf::Slice::Make(Imf::FLOAT, z.data(), header.dataWindow()));
    in.setFrameBuffer(buffer);
    in.readPixels(15, 29);
    EXPECT_EQ(z, image.z);
    for (size_t i = 0; i < red.size(); ++i) EXPECT_EQ(red[i], image.rgba[4 * i]);  // 64ths are exact halves
}

TEST(WriteDisplays, WorldToNdcRunsFromUpperLeftToLowerRight) {
    const TemporaryFolder folder;
    RasterScene scene(40, 30, 1);
    scene.scene.options.projection = "perspective";
    scene.scene.options.near_clip = 0.1f;
    scene.scene.options.far_clip = 100;
    scene.update();
    scene.scene.camera_from_world = M44f(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 3, 4, 5, 1);
    scene.scene.options.displays = {{folder.file("a.exr"), "exr", "rgb", {}, {}}};
    ASSERT_TRUE(write(numbered_image(scene), scene).good);
    const M44f ndc_from_world = Imf::worldToNDC(Imf::InputFile(folder.file("a.exr").c_str()).header());
    for (const auto& [x, y] : {std::pair{0.0f, 0.0f}, {40.0f, 30.0f}, {12.5f, 7.25f}}) {
        const AxisRay ray = scene.context.camera.ray(x, y, 0, 0, 0);
        const V3f camera(ray.ux * 6, ray.uy * 6, 6);
        V3f ndc;
        ndc_from_world.multVecMatrix(camera - V3f(3, 4, 5), ndc);
        EXPECT_NEAR(ndc.x, x / 40, 1e-5);
        EXPECT_NEAR(ndc.y, y / 30, 1e-5);
    }
}

TEST(WriteDisplays, OpenExrFloatsIdsAndCompression) {
    const TemporaryFolder folder;
    RasterScene scene(40, 70, 1);  // more rows than are written at once
    Display beauty{folder.file("a.exr"), "file", "rgb", {}, {}};
    beauty.parameters.set({"type", {StorageClass::Uniform, ValueType::String, 1}, {}, {"float"}});
    beauty.parameters.set({"compression", {StorageClass::Uniform, ValueType::String, 1}, {}, {"zips"}});
    scene.scene.options.displays = {beauty, {folder.file("id.exr"), "file", "id", {}, {}}};
    Image image = numbered_image(scene);
    image.rgba[4] = 1.0f / 3;
    ASSERT_TRUE(write(image, scene).good);
    {
        Imf::InputFile in(folder.file("a.exr").c_str());
        EXPECT_EQ(in.header().compression(), Imf::ZIPS_COMPRESSION);
        EXPECT_EQ(in.header().channels()["R"].type, Imf::FLOAT);
        EXPECT_EQ(in.header().channels().findChannel("A"), nullptr);
        std::vector<float> red(40 * 70);
        Imf::FrameBuffer buffer;
        buffer.insert("R", Imf::Slice::Make(Imf::FLOAT, red.data(), in.header().dataWindow()));
        in.setFrameBuffer(buffer);
        in.readPixels(0, 69);
        for (size_t i = 0; i < red.size(); ++i) ASSERT_EQ(red[i], image.rgba[4 * i]);
    }
    Imf::InputFile in(folder.file("id.exr").c_str());
    EXPECT_EQ(in.header().channels()["id"].type, Imf::UINT);
    std::vector<uint32_t> ids(40 * 70);
    Imf::FrameBuffer buffer;
    buffer.insert("id", Imf::Slice::Make(Imf::UINT, ids.data(), in.header().dataWindow()));
    in.setFrameBuffer(buffer);
    in.readPixels(0, 69);
    EXPECT_EQ(ids, image.id);
}

TEST(WriteDisplays, HalvesNeverOverflow) {
    const TemporaryFolder folder;
    RasterScene scene(4, 4, 1);
    scene.scene.options.displays = {{folder.file("a.exr"), "exr", "rgba", {}, {}}};
    Image image = numbered_image(scene);
    image.rgba[0] = 1e6f, image.rgba[1] = -1e6f;
    ASSERT_TRUE(write(image, scene).good);
    const auto in = OIIO::ImageInput::open(folder.file("a.exr"));
    std::vector<float> pixels(4 * 4 * 4);
    ASSERT_TRUE(in && in->read_image(0, 0, 0, -1, OIIO::TypeDesc::FLOAT, pixels.data()));
    EXPECT_EQ(pixels[0], 65504);
    EXPECT_EQ(pixels[1], -65504);
}

/// Pixel values of a file as they are stored, alpha as it is stored too.
template <class Value>
std::vector<Value> stored(const std::string& path, OIIO::TypeDesc type, OIIO::ImageSpec* spec) {
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    const auto in = OIIO::ImageInput::open(path, &config);
    EXPECT_TRUE(in) << OIIO::geterror();
    if (!in) return {};
    *spec = in->spec();
    EXPECT_EQ(spec->format, type);
    std::vector<Value> pixels(spec->image_pixels() * spec->nchannels);
    EXPECT_TRUE(in->read_image(0, 0, 0, -1, type, pixels.data()));
    return pixels;
}

int srgb_byte(double linear) {
    const double encoded = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
    return static_cast<int>(std::lround(255 * encoded));
}

/// A display's own: 0 to 0 and 1 to `one`.
void quantize(Display& display, float one, float max, float dither) {
    display.parameters.set({"quantize", {StorageClass::Uniform, ValueType::Float, 4}, {0, one, 0, max}, {}});
    display.parameters.set({"dither", {StorageClass::Uniform, ValueType::Float, 1}, {dither}, {}});
}

TEST(WriteDisplays, PngHasUnassociatedAlpha) {
    const TemporaryFolder folder;
    RasterScene scene(40, 30, 1);
    set_transfer(scene.scene.options, "srgb");
    Display display{folder.file("a.png"), "file", "rgba", {}, {}};
    quantize(display, 255, 255, 0);
    scene.scene.options.displays = {display};
    ASSERT_TRUE(write(numbered_image(scene), scene).good);
    OIIO::ImageSpec spec;
    const auto pixels = stored<uint8_t>(folder.file("a.png"), OIIO::TypeDesc::UINT8, &spec);
    ASSERT_EQ(pixels.size(), 40u * 30 * 4);
    EXPECT_EQ(spec.get_string_attribute("Software"), "Trapeze test");
    for (int x : {0, 1, 8, 9, 39}) {
        const uint8_t* pixel = &pixels[4 * (7 * 40 + x)];
        EXPECT_EQ(pixel[0], srgb_byte(x / 64.0)) << x;
        EXPECT_EQ(pixel[1], srgb_byte(7 / 64.0)) << x;
        EXPECT_EQ(pixel[2], srgb_byte(0.25)) << x;
        EXPECT_EQ(pixel[3], x % 2 ? 128 : 255) << x;
    }
}

TEST(WriteDisplays, TiffIsAssociatedAndCropped) {
    const TemporaryFolder folder;
    RasterScene scene(40, 30, 1);
    set_crop(scene);
    set_transfer(scene.scene.options, "srgb");
    scene.scene.camera_from_world = M44f(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 3, 4, 5, 1);
    Display display{folder.file("a.tif"), "tiff", "rgba", {}, {}};
    quantize(display, 255, 255, 0);
    scene.scene.options.displays = {display};
    ASSERT_TRUE(write(numbered_image(scene), scene).good);
    OIIO::ImageSpec spec;
    const auto pixels = stored<uint8_t>(folder.file("a.tif"), OIIO::TypeDesc::UINT8, &spec);
    ASSERT_EQ(pixels.size(), 20u * 15 * 4);
    EXPECT_EQ(spec.x, 10);
    EXPECT_EQ(spec.y, 15);
    EXPECT_EQ(spec.full_width, 40);
    EXPECT_EQ(spec.full_height, 30);
    EXPECT_EQ(spec.get_string_attribute("Software"), "Trapeze test");
    EXPECT_EQ(spec.get_string_attribute("ImageDescription"),
              "sampler: raytrace; samples: 8x8; transfer: srgb");
    M44f camera_from_world;
    EXPECT_TRUE(spec.getattribute("worldtocamera", OIIO::TypeMatrix, &camera_from_world));
    EXPECT_EQ(camera_from_world, scene.scene.camera_from_world);
    EXPECT_EQ(spec.get_int_attribute("oiio:UnassociatedAlpha"), 0);
    EXPECT_EQ(pixels[4 * 1], srgb_byte(0.5 * 11 / 64));
    EXPECT_EQ(pixels[4 * 1 + 3], 128);
    EXPECT_EQ(pixels[4 * 2], srgb_byte(12 / 64.0));
}

TEST(WriteDisplays, TiffFloats16BitsAndDepth) {
    const TemporaryFolder folder;
    RasterScene scene(40, 30, 1);
    Display floats{folder.file("f.tif"), "tiff", "rgb", {}, {}},
        words{folder.file("w.tif"), "tiff", "a", {}, {}};
    quantize(floats, 0, 0, 0);
    quantize(words, 65535, 65535, 0);
    scene.scene.options.displays = {floats, words, {folder.file("z.tif"), "tiff", "z", {}, {}}};
    const Image image = numbered_image(scene);
    ASSERT_TRUE(write(image, scene).good);
    OIIO::ImageSpec spec;
    const auto colors = stored<float>(folder.file("f.tif"), OIIO::TypeDesc::FLOAT, &spec);
    EXPECT_EQ(spec.nchannels, 3);
    EXPECT_EQ(colors[3 * 11], image.rgba[4 * 11]);
    const auto alphas = stored<uint16_t>(folder.file("w.tif"), OIIO::TypeDesc::UINT16, &spec);
    EXPECT_EQ(spec.nchannels, 1);
    EXPECT_EQ(alphas[0], 65535);
    EXPECT_EQ(alphas[1], 32768);
    EXPECT_EQ(stored<float>(folder.file("z.tif"), OIIO::TypeDesc::FLOAT, &spec), image.z);
}

TEST(WriteDisplays, DepthMapsSayWhereTheyWereSeenFrom) {
    const TemporaryFolder folder;
    RasterScene scene(40, 30, 1);
    scene.scene.camera_from_world.setTranslation(V3f(1, 2, 3));
    scene.scene.options.displays = {{folder.file("a.shd"), "shadow", "z", {}, {}}};
    const Image image = numbered_image(scene);
    ASSERT_TRUE(write(image, scene).good);
    OIIO::ImageSpec spec;
    EXPECT_EQ(stored<float>(folder.file("a.shd"), OIIO::TypeDesc::FLOAT, &spec), image.z);
    EXPECT_EQ(spec.get_string_attribute("textureformat"), "Shadow");
    M44f camera_from_world, screen_from_world;
    EXPECT_TRUE(spec.getattribute("worldtocamera", OIIO::TypeMatrix, &camera_from_world));
    EXPECT_EQ(camera_from_world, scene.scene.camera_from_world);
    EXPECT_TRUE(spec.getattribute("worldtoscreen", OIIO::TypeMatrix, &screen_from_world));
    // What the camera sees in the middle of a pixel is there in the picture.
    const Camera& camera = scene.context.camera;
    const float depth = 4;
    const AxisRay ray = camera.ray(7.5f, 3.5f, 0, 0, 0);
    const V3f seen(ray.ox + ray.ux * depth, ray.oy + ray.uy * depth, depth);
    V3f screen;
    screen_from_world.multVecMatrix(seen - V3f(1, 2, 3), screen);
    EXPECT_NEAR((0.5f + 0.5f * screen.x) * 40, 7.5f, 1e-4f);
    EXPECT_NEAR((0.5f - 0.5f * screen.y) * 30, 3.5f, 1e-4f);
}

TEST(WriteDisplays, ManyFormatsAreReadable) {
    const TemporaryFolder folder;
    RasterScene scene(40, 30, 1);
    for (const char* name : {"a.jpg", "a.tga", "a.bmp", "a.tif", "a.png", "a.exr"})
        scene.scene.options.displays.push_back({folder.file(name), "file", "rgba", {}, {}});
    EXPECT_TRUE(write(numbered_image(scene), scene).good);
    for (const Display& display : scene.scene.options.displays) {
        const auto in = OIIO::ImageInput::open(display.name);
        ASSERT_TRUE(in) << display.name << OIIO::geterror();
        std::vector<float> pixels(in->spec().image_pixels() * in->spec().nchannels);
        EXPECT_TRUE(in->read_image(0, 0, 0, -1, OIIO::TypeDesc::FLOAT, pixels.data())) << display.name;
        EXPECT_EQ(in->spec().width, 40);
    }
}

TEST(WriteDisplays, AFailureIsOneErrorAndTheOthersAreWritten) {
    const TemporaryFolder folder;
    std::vector<std::string> shown;
    RasterScene scene(40, 30, 1);
    Diagnostics diagnostics([&](const Diagnostic& diagnostic) {
        if (diagnostic.severity != Severity::Note) shown.push_back(to_string(diagnostic));
    });
    scene.context.diagnostics = &diagnostics;
    const SourceLocation place{diagnostics.add_source("s.rib"), 7, 3};
    std::filesystem::create_directories(folder.file("a.exr"));
    std::filesystem::create_directories(folder.file("a.png"));
    scene.scene.options.displays = {{folder.file("a.exr"), "file", "rgba", {}, place},
                                    {folder.file("a.png"), "file", "rgba", {}, place},
                                    {folder.file("b.exr"), "null", "rgba", {}, place},
                                    {folder.file("c.exr"), "file", "rgba", {}, place}};
    const WrittenDisplays result = write(numbered_image(scene), scene);
    EXPECT_FALSE(result.good);
    EXPECT_EQ(result.paths, std::vector<std::string>{folder.file("c.exr")});
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.exr", "a.png", "c.exr"}));
    ASSERT_EQ(shown.size(), 2u);
    EXPECT_EQ(shown[0], "s.rib:7:3: error: cannot write \"" + folder.file("a.exr") + "\": it is a folder");
}

TEST(WriteDisplays, FoldersBelowTheWorkingFolderAreMadeAndOthersLeftOut) {
    const TemporaryFolder folder;
    const std::filesystem::path before = std::filesystem::current_path();
    std::filesystem::current_path(folder.path());
    RasterScene scene(40, 30, 1);
    for (const char* name : {"./renders/1/a.exr", "../trapeze-none/b.exr", "C:/none/c.exr", "C:\\d.exr",
                             "//server/none/e.exr", "/trapeze-none/e.exr"})
        scene.scene.options.displays.push_back({name, "file", "rgba", {}, {}});
    std::vector<std::string> shown;
    Diagnostics diagnostics([&](const Diagnostic& diagnostic) { shown.push_back(to_string(diagnostic)); });
    scene.context.diagnostics = &diagnostics;
    const WrittenDisplays result = write(numbered_image(scene), scene);
    std::filesystem::current_path(before);
    EXPECT_EQ(result.paths,
              (std::vector<std::string>{"./renders/1/a.exr", "b.exr", "c.exr", "d.exr", "e.exr"}));
    EXPECT_TRUE(std::filesystem::exists(folder.file("renders/1/a.exr")));
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"b.exr", "c.exr", "d.exr", "e.exr", "renders"}));
    ASSERT_EQ(shown.size(), 2u);
    EXPECT_EQ(shown[0],
              "warning: there is no folder for \"../trapeze-none/b.exr\"; it is written as \"b.exr\"");
    // The name is taken by another picture of this frame.
    EXPECT_FALSE(result.good);
    EXPECT_EQ(shown[1], "error: cannot write \"/trapeze-none/e.exr\": there is no folder \"/trapeze-none\"");
}

TEST(WriteDisplays, AFullDiskLeavesNothing) {
    const TemporaryFolder folder;
    RasterScene scene(400, 300, 1);
    for (const char* name : {"a.exr", "a.tif", "a.png"})
        scene.scene.options.displays.push_back({folder.file(name), "file", "rgba", {}, {}});
    Image image = numbered_image(scene);
    for (size_t i = 0; i < image.rgba.size(); ++i)  // nothing to compress
        image.rgba[i] = unit_float(hash(static_cast<uint32_t>(i)));
    for (const size_t limit : {100u, 20000u, 100000u}) {
        const FileSizeLimit full(limit);
        EXPECT_FALSE(write(image, scene).good) << limit;
        EXPECT_TRUE(folder.names().empty()) << limit;
    }
    EXPECT_EQ(scene.diagnostics.count(Severity::Error), 9u);
    EXPECT_TRUE(write(image, scene).good);
    EXPECT_EQ(folder.names().size(), 3u);
}

TEST(WriteDisplays, WhatAFormatDoesNotHoldIsAnError) {
    const TemporaryFolder folder;
    RasterScene scene(65536, 1, 1);
    std::string errors;
    Diagnostics diagnostics([&](const Diagnostic& d) { errors += d.text + "\n"; });
    scene.context.diagnostics = &diagnostics;
    scene.scene.options.displays = {{folder.file("a.jpg"), "jpeg", "rgb", {}, {}},
                                    {folder.file("a.tga"), "targa", "rgb", {}, {}}};
    EXPECT_FALSE(write(numbered_image(scene), scene).good);
    EXPECT_NE(errors.find("at most 65500 pixels"), std::string::npos) << errors;
    EXPECT_NE(errors.find("a.tga"), std::string::npos) << errors;
    EXPECT_TRUE(folder.names().empty());
}

TEST(WriteDisplays, CancellingLeavesNothing) {
    const TemporaryFolder folder;
    RasterScene scene(40, 30, 1);
    const std::atomic<bool> cancelled{true};
    scene.context.cancelled = &cancelled;
    scene.scene.options.displays = {{folder.file("a.exr"), "file", "rgba", {}, {}}};
    EXPECT_FALSE(write(numbered_image(scene), scene).good);
    EXPECT_TRUE(folder.names().empty());
    EXPECT_EQ(scene.diagnostics.count(Severity::Error), 0u);
}

TEST(WriteDisplays, AnEmptyCropIsAnError) {
    const TemporaryFolder folder;
    RasterScene scene(40, 30, 1);
    scene.scene.options.crop_window = {0.5f, 0.5f, 0, 1};
    scene.update();
    scene.scene.options.displays = {{folder.file("a.exr"), "file", "rgba", {}, {}}};
    EXPECT_FALSE(write(numbered_image(scene), scene).good);
    EXPECT_EQ(scene.diagnostics.count(Severity::Error), 1u);
    EXPECT_TRUE(folder.names().empty());
}

}  // namespace
}  // namespace trapeze
