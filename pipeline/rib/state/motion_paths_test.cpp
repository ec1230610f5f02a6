/// Rotating surfaces' keys, by circles written down here.
#include "core/motion_keys_harness.h"
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

/// Where a corner of a deforming polygon under a moving transformation is at some time, as it is rendered:
/// places at keys, and straight ways between them.
V3f corner_at(const Primitive& primitive, size_t corner, float time) {
    const auto place = [&](int key, int keys) {
        const auto between = [&](const auto& of_keys) {  // of as many keys or fewer
            const float at = static_cast<float>(key) / static_cast<float>(keys - 1) *
                             static_cast<float>(of_keys.size() - 1);
            const auto before = std::min(static_cast<size_t>(at), of_keys.size() - 1);
            return std::pair(before, at - static_cast<float>(before));
        };
        const auto& shapes = primitive.shape_keys;
        const auto point = [&](size_t k) {
            const auto& P = shapes[k]->variables.find("P")->floats;
            return V3f(P[3 * corner], P[3 * corner + 1], P[3 * corner + 2]);
        };
        const auto [s, s_part] = between(shapes);
        const V3f p = s_part > 0 ? point(s) + (point(s + 1) - point(s)) * s_part : point(s);
        const auto& spaces = primitive.camera_from_object;
        const auto [m, m_part] = between(spaces);
        return m_part > 0 ? (p * spaces[m]) * (1 - m_part) + (p * spaces[m + 1]) * m_part : p * spaces[m];
    };
    const int keys = primitive.key_count();
    const float at = time * static_cast<float>(keys - 1);
    const int before = std::min(static_cast<int>(at), keys - 2);
    const float part = at - static_cast<float>(before);
    return place(before, keys) * (1 - part) + place(before + 1, keys) * part;
}

constexpr const char* kSixtyFour =
    "Format 64 64 1 ScreenWindow 0 64 0 64 Projection \"orthographic\" Shutter 0 1 Translate 0 0 5 WorldBegin ";

/// The product of the shape's motion and the transformation's bends, though each is straight or the shape
/// stands still.
TEST(MotionPaths, DeformingShapesBendUnderMovingScalesAndRotations) {
    const std::string deforming =
        "MotionBegin [0 1] Polygon \"P\" [3.5 -.5 0 4.5 -.5 0 4.5 .5 0 3.5 .5 0] Polygon \"P\" [59.5 -.5 0 "
        "60.5 -.5 0 60.5 .5 0 59.5 .5 0] MotionEnd WorldEnd";
    const ReadOutcome scaled = read_text(
        kSixtyFour + std::string("MotionBegin [0 1] Scale .01 1 1 Scale 1 1 1 MotionEnd ") + deforming);
    const ReadOutcome turned = read_text(
        kSixtyFour + std::string("MotionBegin [0 1] Rotate 0 0 0 1 Rotate 9.9 0 0 1 MotionEnd ") + deforming);
    for (int i = 0; i <= 100; ++i) {
        const float t = static_cast<float>(i) / 100, x = 3.5f + 56 * t, y = -.5f;
        EXPECT_NEAR(corner_at(scaled.primitive(), 0, t).x, x * (.01f + .99f * t), .26f) << t;
        const double angle = 9.9 * M_PI / 180 * t;
        const V3f p = corner_at(turned.primitive(), 0, t);
        EXPECT_NEAR(p.x, x * std::cos(angle) - y * std::sin(angle), .26) << t;
        EXPECT_NEAR(p.y, x * std::sin(angle) + y * std::cos(angle), .26) << t;
    }
}

/// Times that are no sixteenths of the shutter cut paths short, which is seen in large pictures alone.
TEST(MotionPaths, TimesThatNoKeyMeetsAreNearlyReached) {
    const std::string moving =
        "MotionBegin [0 .3333333 1] Translate 0 0 0 Translate 60 0 0 Translate 0 0 0 MotionEnd Polygon \"P\" "
        "[0 0 0 1 0 0 1 8 0 0 8 0] WorldEnd";
    const ReadOutcome large = read_text(kSixtyFour + moving);
    EXPECT_EQ(large.primitive().key_count(), kMaxKeyCount)
        << "a kink is never met, and cut by a pixel at most";
    EXPECT_NEAR(corner_at(large.primitive(), 0, 1.0f / 3).x, 60, 1);
    const ReadOutcome small = read_text("Format 2 2 1 " + std::string(kSixtyFour).substr(15) + moving);
    EXPECT_EQ(small.primitive().key_count(), 17);
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
