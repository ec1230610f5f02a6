/// Pictures of what objects have of their own, of coordinate systems that hold in a part of a world, and of
/// what moves or stands with the camera: each beside what the same text makes without an object, or a closed
/// form.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <string>

#include "core/files/temporary_folder_harness.h"
#include "tests/scene_harness.h"

namespace trapeze::testing {
namespace {

constexpr int kWidth = 16, kHeight = 8;

/// Shows a point in a space that it is told by name.
const std::string kShowsSpace =
    "surface shows(string sp = \"\") {\n"
    "    point p = transform(sp, P);\n"
    "    Ci = color(xcomp(p), ycomp(p), zcomp(p)); Oi = 1;\n"
    "}\n";

/// 4 by 2 units, of 4 pixels each; samples are in the middles of pixels. `camera`: requests before the world.
Image picture(const std::string& camera, const std::string& world) {
    const TemporaryFolder folder;
    std::ofstream(folder.file("shows.sl")) << kShowsSpace;
    const std::string path = folder.file("a.rib");
    std::ofstream(path) << "Option \"searchpath\" \"shader\" \"" << folder.file("")
                        << ":@\" Format 16 8 1 PixelSamples 1 1 PixelFilter \"box\" 1 1\n"
                        << "Hider \"hidden\" \"jitter\" 0 ScreenWindow -2 2 -1 1\n"
                        << camera << "\nWorldBegin ShadingInterpolation \"smooth\"\n"
                        << world << "\nWorldEnd\n";
    const auto frames = render_scene(path, RenderSettings());
    return frames.empty() ? Image() : frames.front().image;
}

const std::string kView = "Projection \"orthographic\" Translate 0 0 5 ";
const std::string kSquare = "Polygon \"P\" [-1 -1 0 1 -1 0 1 1 0 -1 1 0] ";

/// Of a row in the middle.
std::array<float, 4> pixel(const Image& image, int x) {
    const float* p =
        image.rgba.data() + (static_cast<size_t>(kHeight / 2) * kWidth + static_cast<size_t>(x)) * 4;
    return {p[0], p[1], p[2], p[3]};
}

/// The x of the shown points is that of the pixel's middle less `middle`; y and z are 0 in the row's middle.
void expect_space_at(const Image& image, int x, float middle) {
    const std::array<float, 4> seen = pixel(image, x);
    EXPECT_NEAR(seen[0], (static_cast<float>(x) + 0.5f) / 4 - 2 - middle, 1e-5f) << x;
    EXPECT_NEAR(seen[1], -0.125f, 1e-5f) << x;
    EXPECT_NEAR(seen[2], 0, 1e-5f) << x;
}

TEST(Objects, WhatTheySayIsSeenAsWithoutThem) {
    const std::string own = "Surface \"constant\" Color [1 1 1] Opacity [1 1 1] " + kSquare,
                      other = "Color [1 0 0] Opacity [.5 .5 .5] ";
    const Image instance =
        picture(kView, "ObjectBegin 1 " + own + "ObjectEnd " + other + "ObjectInstance 1 ");
    EXPECT_EQ(pixel(instance, 8), (std::array<float, 4>{1, 1, 1, 1}));
    EXPECT_EQ(instance.rgba, picture(kView, other + own).rgba);
}

TEST(ScopedSpaces, EachSquareSeesItsOwn) {
    const std::string square =
        "ScopedCoordinateSystem \"here\" Surface \"shows\" \"string sp\" \"here\" " + kSquare;
    const Image seen =
        picture(kView, "AttributeBegin Translate -1 0 0 " + square +
                           "AttributeEnd AttributeBegin Translate 1 0 0 " + square + "AttributeEnd");
    for (const int x : {1, 2, 5, 6}) expect_space_at(seen, x, -1);
    for (const int x : {9, 10, 13, 14}) expect_space_at(seen, x, 1);
}

/// One surface for all: what it sees is not what held where it was given.
TEST(ScopedSpaces, ASurfaceSeesThoseOfEachPrimitive) {
    const Image seen =
        picture(kView,
                "Surface \"shows\" \"string sp\" \"here\" "
                "AttributeBegin Translate -1 0 0 ScopedCoordinateSystem \"here\" " +
                    kSquare + "AttributeEnd AttributeBegin Translate 1 0 0 ScopedCoordinateSystem \"here\" " +
                    kSquare + "AttributeEnd");
    for (const int x : {1, 6}) expect_space_at(seen, x, -1);
    for (const int x : {9, 14}) expect_space_at(seen, x, 1);
}

TEST(ScopedSpaces, ThoseOfObjectsStandWhereTheInstanceDoes) {
    for (const std::string request : {"CoordinateSystem", "ScopedCoordinateSystem"}) {
        const Image seen =
            picture(kView, "ObjectBegin 1 " + request +
                               " \"here\" Surface \"shows\" \"string sp\" \"here\" " + kSquare +
                               "ObjectEnd AttributeBegin Translate -1 0 0 ObjectInstance 1 AttributeEnd "
                               "AttributeBegin Translate 1 0 0 ObjectInstance 1 AttributeEnd");
        for (const int x : {1, 6}) expect_space_at(seen, x, -1);
        for (const int x : {9, 14}) expect_space_at(seen, x, 1);
    }
}

/// What stands before Projection is done to the picture: here to a rectangle from x = 0 to 1.
TEST(Screen, TransformationsBeforeProjectionMoveThePicture) {
    const std::string world = "Surface \"constant\" Polygon \"P\" [0 -9 0  1 -9 0  1 9 0  0 9 0] ";
    const auto seen = [&](const std::string& before, const std::string& projection) {
        const Image image = picture(before + "Projection " + projection + " Translate 0 0 1 ", world);
        std::string row;
        for (int x = 0; x < kWidth; ++x) row += pixel(image, x)[3] > 0 ? '#' : '.';
        return row;
    };
    for (const std::string projection : {"\"orthographic\"", "\"perspective\" \"fov\" 90"}) {
        EXPECT_EQ(seen("", projection), "........####....");
        EXPECT_EQ(seen("Scale -1 1 1 ", projection), "....####........");
        EXPECT_EQ(seen("Scale 2 1 1 ", projection), "........########");
        EXPECT_EQ(seen("Translate -.5 .25 3 ", projection), "......####......");
        EXPECT_EQ(seen("Translate -.5 0 0 Scale -1 1 2 ", projection), "..####..........");
    }
}

/// The plane is the world's, before which the camera moves: all that is cut is what the polygon that ends at
/// it has not.
TEST(ClippingPlanes, MoveWithTheWorldBeforeAMovingCamera) {
    const std::string camera =
        "Shutter 0 1 PixelSamples 8 8 Projection \"orthographic\" Translate 0 0 5 MotionBegin [0 1] "
        "Translate 0 0 0 Translate 1 0 0 MotionEnd ";
    const auto polygon = [](const std::string& end) {
        return "Surface \"constant\" Polygon \"P\" [-9 -9 0 " + end + " -9 0 " + end + " 9 0 -9 9 0] ";
    };
    const Image cut = picture(camera + "ClippingPlane 0 0 0 1 0 0 ", polygon("9"));
    const Image ends = picture(camera, polygon("0"));
    for (int x = 0; x < kWidth; ++x) {
        EXPECT_NEAR(pixel(cut, x)[3], pixel(ends, x)[3], 0.02f) << x;
        // The edge goes from 0 to 1 at an even speed.
        const float middle = (static_cast<float>(x) + 0.5f) / 4 - 2;
        EXPECT_NEAR(pixel(cut, x)[3], std::clamp(1 - middle, 0.0f, 1.0f), 0.06f) << x;
    }
}

}  // namespace
}  // namespace trapeze::testing
