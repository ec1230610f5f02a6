/// Rotating surfaces' keys, by circles written down here.
#include "core/motion_keys.h"
#include "pipeline/rib/reading_harness.h"

namespace trapeze::testing {
namespace {

/// A bar of that half-length, turned about z by some degrees in the shutter, at depth 10: 64 pixels wide are
/// `scale` units there.
Primitive turning_bar(float half_length, float degrees, int width, float fov = 90) {
    const std::string x = std::to_string(half_length);
    const ReadOutcome r =
        read_text("Format " + std::to_string(width) + " " + std::to_string(width) +
                  " 1 Projection \"perspective\" \"fov\" [" + std::to_string(fov) +
                  "] Shutter 0 1 Translate 0 0 10 WorldBegin MotionBegin [0 1] Rotate 0 0 0 1 "
                  "Rotate " +
                  std::to_string(degrees) + " 0 0 1 MotionEnd Polygon \"P\" [-" + x + " -.01 0 " + x +
                  " -.01 0 " + x + " .01 0 -" + x + " .01 0] WorldEnd");
    EXPECT_THAT(r.messages, ::testing::IsEmpty());
    return r.primitive();
}

/// The sagitta of a chord over a segment's angle, in pixels: at 90 degrees the picture is 20 units wide at
/// depth 10.
double sagitta(float half_length, float degrees, int keys, int width) {
    const double angle = degrees * M_PI / 180 / (keys - 1);
    return half_length * (1 - std::cos(angle / 2)) * width / 20;
}

TEST(MotionPaths, ChordsAreWithinAQuarterOfAPixel) {
    const struct {
        float half_length, degrees;
        int width;
    } rows[] = {{8, 180, 1000}, {8, 30, 1000}, {4, 90, 500}, {8, 2, 4000}, {2, 170, 250}};
    for (const auto& row : rows) {
        const Primitive bar = turning_bar(row.half_length, row.degrees, row.width);
        const int keys = static_cast<int>(bar.camera_from_object.size());
        ASSERT_TRUE(is_key_count(keys));
        EXPECT_LE(sagitta(row.half_length, row.degrees, keys, row.width), 0.25)
            << row.half_length << ' ' << row.degrees << ' ' << row.width << ": " << keys;
        // No more than are needed, but for ten degrees a segment.
        const int half = (keys - 1) / 2 + 1;
        if (row.degrees / static_cast<float>(half - 1) < 10) {
            EXPECT_GT(sagitta(row.half_length * 1.01f, row.degrees, half, row.width), 0.24);
        }
        // What is rendered: the corner's path between two keys, next to the circle.
        const V3f p(row.half_length, 0, 0);
        for (int k = 0; k + 1 < keys; ++k) {
            const V3f middle = (p * bar.camera_from_object[k] + p * bar.camera_from_object[k + 1]) * 0.5f;
            const double off = row.half_length - std::hypot(middle.x, middle.y);
            EXPECT_LE(off * row.width / 20, 0.26);
        }
    }
}

TEST(MotionPaths, SmallAndFarOnesHaveFewKeys) {
    EXPECT_EQ(turning_bar(0.05f, 10, 500).camera_from_object.size(), 2u);
    EXPECT_EQ(turning_bar(8, 10, 20).camera_from_object.size(), 2u);
    EXPECT_EQ(turning_bar(0.05f, 90, 500).camera_from_object.size(), 17u) << "ten degrees a segment";
}

TEST(MotionPaths, KeysEndAtTheMost) {
    EXPECT_EQ(turning_bar(8, 360, 60000).camera_from_object.size(), static_cast<size_t>(kMaxKeyCount));
}

TEST(MotionPaths, TranslationsStayStraight) {
    const ReadOutcome r = read_text(
        "Format 4000 4000 1 Projection \"perspective\" Shutter 0 1 Translate 0 0 10 WorldBegin MotionBegin "
        "[0 1] "
        "Translate 0 0 0 Translate 8 8 5 MotionEnd Rotate 30 1 1 1 Sphere 3 -3 3 360 WorldEnd");
    EXPECT_EQ(r.primitive().camera_from_object.size(), 2u);
}

/// Every kind of surface has its extent: each is about as large as the bar, turns by 30 degrees, and wants
/// more keys than the five of ten degrees.
TEST(MotionPaths, AllSurfacesHaveTheirExtent) {
    for (const char* const surface :
         {"Sphere 6 -6 6 360", "Cone 6 6 360", "Cylinder 6 -1 1 360", "Paraboloid 6 0 1 360", "Disk 0 6 360",
          "Torus 4 2 0 360 360", "Hyperboloid 6 0 0 5 1 1 360",
          "Curves \"linear\" [2] \"nonperiodic\" \"P\" [-6 0 0 6 0 0]", "Points \"P\" [6 0 0 -6 0 0]",
          "Patch \"bilinear\" \"P\" [-6 -6 0 6 -6 0 -6 6 0 6 6 0]",
          "Patch \"bilinear\" \"Pw\" [-12 -12 0 2 12 -12 0 2 -12 12 0 2 12 12 0 2]",
          "Blobby 1 [1001 0] [6 0 0 0 0 6 0 0 0 0 6 0 0 0 0 1]",
          "Blobby 2 [1000 0 1002 1 0 2 0 1 7 2] [0 -5 0 0 5 0 0 1 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1]"}) {
        const ReadOutcome r = read_text(
            "Format 1000 1000 1 Projection \"perspective\" Shutter 0 1 Translate 0 0 10 WorldBegin "
            "MotionBegin "
            "[0 1] Rotate 0 0 0 1 Rotate 30 0 0 1 MotionEnd " +
            std::string(surface) + " WorldEnd");
        ASSERT_EQ(r.count(), 1u) << surface;
        EXPECT_GE(r.primitive().camera_from_object.size(), 9u) << surface;
    }
}

}  // namespace
}  // namespace trapeze::testing
