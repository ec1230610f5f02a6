/// Sides 1 where something is cut away, by planes or as solids: each beside a closed form.
#include <gtest/gtest.h>

#include <string>

#include "tests/program_harness.h"
#include "tests/scene_harness.h"

namespace trapeze::testing {
namespace {

/// The picture of a world from z = -5, 2 by 2 units; `camera`: requests before the world.
Image picture_of_sides(const std::string& camera, const std::string& world, const std::string& shader = "") {
    const WorkFolder folder;
    folder.write("shadowed.sl", shader);
    folder.write("a.rib",
                 "Format 32 32 1 PixelSamples 4 4 PixelFilter \"box\" 1 1 ScreenWindow -1 1 -1 1\n"
                 "Projection \"orthographic\" Translate 0 0 5 " +
                     camera + "\nWorldBegin Surface \"constant\" ShadingRate .25\n" + world + "\nWorldEnd\n");
    const auto frames = render_scene((folder / "a.rib").string(), RenderSettings());
    return frames.empty() ? Image() : frames.front().image;
}

float mean_alpha(const Image& image) {
    double sum = 0;
    for (size_t i = 3; i < image.rgba.size(); i += 4) sum += image.rgba[i];
    return static_cast<float>(sum / (image.rgba.size() / 4.0));
}

/// Of the pixel in the middle.
float middle_of(const Image& image, int channel) {
    return image.rgba[static_cast<size_t>((16 * 32 + 16) * 4 + channel)];
}

constexpr float kDisk = 0.19635f;  ///< of radius a half in the picture's square

TEST(Sides, OfOneStayWhereAPlaneCuts) {
    const std::string far_plane = "ClippingPlane 0 0 -100 0 0 -1 ", bowl = "Sphere .5 0 .5 360 ";
    for (const std::string& plane : {std::string(), far_plane}) {
        // We look into the bowl from below: a bowl that is open towards us shows its inside alone.
        EXPECT_NEAR(mean_alpha(picture_of_sides(plane, "Sides 2 " + bowl)), kDisk, 0.004f);
        EXPECT_EQ(mean_alpha(picture_of_sides(plane, "Sides 1 " + bowl)), 0);
        EXPECT_NEAR(mean_alpha(picture_of_sides(plane, "Sides 1 Orientation \"inside\" " + bowl)), kDisk,
                    0.004f);
        const std::string glass = "Opacity .5 .5 .5 Sphere .5 -.5 .5 360 ";
        EXPECT_FLOAT_EQ(middle_of(picture_of_sides(plane, "Sides 2 " + glass), 3), .75f);
        EXPECT_FLOAT_EQ(middle_of(picture_of_sides(plane, "Sides 1 " + glass), 3), .5f);
    }
    // What a plane opens shows no inside either.
    EXPECT_NEAR(mean_alpha(picture_of_sides("ClippingPlane 0 0 0 0 0 -1 ", "Sides 2 Sphere .5 -.5 .5 360 ")),
                kDisk, 0.004f);
    EXPECT_EQ(mean_alpha(picture_of_sides("ClippingPlane 0 0 0 0 0 -1 ", "Sides 1 Sphere .5 -.5 .5 360 ")),
              0);
}

TEST(Sides, OfASolidAreThoseOfTheWhole) {
    const auto seen = [](const std::string& before, const std::string& solid) {
        return middle_of(picture_of_sides("", before + "Opacity .5 .5 .5 " + solid), 3);
    };
    const std::string ball = "SolidBegin \"primitive\" Sphere .5 -.5 .5 360 SolidEnd ",
                      core = "SolidBegin \"primitive\" Sphere .25 -.25 .25 360 SolidEnd ",
                      shell = "SolidBegin \"difference\" " + ball + core + "SolidEnd ";
    for (const std::string space : {"", "Scale -1 1 1 ", "ReverseOrientation ReverseOrientation "}) {
        EXPECT_FLOAT_EQ(seen("Sides 2 " + space, ball), 1 - .25f);
        EXPECT_FLOAT_EQ(seen("Sides 1 " + space, ball), 1 - .5f);
        EXPECT_FLOAT_EQ(seen("Sides 2 " + space, shell), 1 - .0625f);
        EXPECT_FLOAT_EQ(seen("Sides 1 " + space, shell), 1 - .25f);
    }
    // Of an opaque one that begins before the picture does the inside is left: its back alone.
    const auto cut = [](const std::string& before) {
        return mean_alpha(picture_of_sides(
            "Clipping 4.9 100 ", before + "SolidBegin \"primitive\" Sphere .5 -.5 .5 360 SolidEnd"));
    };
    const std::string inside = "Orientation \"inside\" ";
    for (const std::string space : {"", "Scale -1 1 1 "}) {
        EXPECT_NEAR(cut("Sides 2 " + space), kDisk, 0.004f);
        EXPECT_LT(cut("Sides 1 " + space), 0.02f);
        EXPECT_NEAR(cut("Sides 1 " + inside + space), kDisk, 0.004f);
        EXPECT_NEAR(cut("Sides 1 ReverseOrientation " + space), kDisk, 0.004f);
        EXPECT_LT(cut("Sides 1 " + inside + "ReverseOrientation " + space), 0.02f);
    }
}

/// Light that goes out of a ball, which we do not see, meets its back alone; light that comes in meets it
/// where it is asked for from the lamp, and where both its ends are outside both.
TEST(Sides, OfASolidHoldForRays) {
    const auto lit = [](const std::string& ends, const std::string& sides) {
        const std::string shader =
            "surface shadowed() { point in = P, out = P + vector \"world\" (3, 0, -3), beyond = P "
            "- vector \"world\" (3, 0, -3); Ci = transmission(" +
            ends + "); Oi = 1; }";
        return middle_of(
            picture_of_sides("",
                             "Surface \"shadowed\" Polygon \"P\" [-.2 -.2 0 .2 -.2 0 .2 .2 0 -.2 .2 0] "
                             "Surface \"constant\" Attribute \"visibility\" \"int transmission\" 1 "
                             "\"int camera\" 0 Opacity .5 .5 .5 " +
                                 sides + "SolidBegin \"primitive\" Sphere .4 -.4 .4 360 SolidEnd",
                             shader),
            0);
    };
    const std::string inside = "Orientation \"inside\" ";
    EXPECT_FLOAT_EQ(lit("in, out", "Sides 2 "), .5f);
    EXPECT_FLOAT_EQ(lit("in, out", "Sides 1 "), 1);
    EXPECT_FLOAT_EQ(lit("in, out", "Sides 1 " + inside), .5f);
    EXPECT_FLOAT_EQ(lit("out, in", "Sides 1 "), .5f);
    EXPECT_FLOAT_EQ(lit("out, in", "Sides 1 " + inside), 1);
    EXPECT_FLOAT_EQ(lit("out, beyond", "Sides 2 "), .25f);
    EXPECT_FLOAT_EQ(lit("out, beyond", "Sides 1 "), .5f);
}

}  // namespace
}  // namespace trapeze::testing
