/// Orientation and ReverseOrientation, in spaces that are mirrored before and afterwards.
#include "pipeline/rib/reading_harness.h"

namespace trapeze::testing {
namespace {

using ::testing::IsEmpty;

TEST(ReadOrientation, InsideAndMirroring) {
    const std::string text = kSphere + "ReverseOrientation " + kSphere + "Orientation \"inside\" " + kSphere +
                             "Orientation \"outside\" Scale -1 1 1 " + kSphere + "Orientation \"lh\" " +
                             kSphere + "Orientation \"rh\" " + kSphere + "Orientation \"up\"";
    const ReadOutcome r = read_world(text);
    const bool reversed[] = {false, true, true, true, false, true};
    for (size_t i = 0; i < 6; ++i) EXPECT_EQ(r.attributes(i).reverse_orientation, reversed[i]) << i;
    EXPECT_EQ(r.messages.size(), 1u);
}

/// The first primitive's normals are against dPdu x dPdv in camera space: it is mirrored or its orientation
/// does not match its space, but not both.
bool is_reversed(const std::string& requests) {
    const ReadOutcome r = read_text(requests + kSphere + " WorldEnd");
    EXPECT_THAT(r.messages, IsEmpty()) << requests;
    return r.count() > 0 && r.attributes().reverse_orientation;
}

TEST(ReadOrientation, HandednessIsComparedWhereOrientationIsRead) {
    const std::string mirror = "Scale -1 1 1 ", lh = "Orientation \"lh\" ", rh = "Orientation \"rh\" ";
    const std::string world = "WorldBegin ";
    EXPECT_FALSE(is_reversed(world + lh));
    EXPECT_TRUE(is_reversed(world + rh));
    EXPECT_TRUE(is_reversed(world + mirror + rh)) << "matches: only mirrored";
    EXPECT_FALSE(is_reversed(world + mirror + lh));
    EXPECT_TRUE(is_reversed(world + lh + mirror)) << "the orientation flips with the space";
    EXPECT_FALSE(is_reversed(world + rh + mirror));
    EXPECT_FALSE(is_reversed(rh + mirror + "Translate 0 0 2 " + world));
    EXPECT_TRUE(is_reversed(mirror + rh + world));
    EXPECT_FALSE(is_reversed(mirror + rh + world + mirror)) << "back again";
    EXPECT_TRUE(is_reversed(world + rh + mirror + mirror));
    EXPECT_TRUE(is_reversed(mirror + world + "Identity " + rh)) << "the world's space is mirrored";
}

TEST(ReadOrientation, ReverseOrientationGoesOnFromHandedness) {
    const std::string mirror = "Scale -1 1 1 ", rh = "Orientation \"rh\" ", reverse = "ReverseOrientation ";
    const std::string world = "WorldBegin ";
    EXPECT_FALSE(is_reversed(world + rh + reverse));
    EXPECT_TRUE(is_reversed(world + reverse + rh)) << "Orientation sets it anew";
    EXPECT_TRUE(is_reversed(world + rh + reverse + mirror));
    EXPECT_TRUE(is_reversed(world + rh + mirror + reverse));
    EXPECT_FALSE(is_reversed(world + mirror + rh + reverse));
}

TEST(ReadOrientation, BlocksRestoreOrientationAsAttributesAre) {
    const std::string mirror = "Scale -1 1 1 ", lh = "Orientation \"lh\" ", rh = "Orientation \"rh\" ";
    EXPECT_FALSE(is_reversed("WorldBegin AttributeBegin " + rh + "AttributeEnd "));
    EXPECT_FALSE(is_reversed("WorldBegin TransformBegin " + mirror + rh + "TransformEnd ")) << "it matched";
    EXPECT_TRUE(is_reversed("WorldBegin TransformBegin " + mirror + lh + "TransformEnd "));
    EXPECT_TRUE(is_reversed("WorldBegin MotionBegin [0 1] Scale -1 1 1 Scale -2 1 1 MotionEnd " + rh));
    EXPECT_FALSE(is_reversed("WorldBegin " + rh + "MotionBegin [0 1] Scale -1 1 1 Scale -2 1 1 MotionEnd "));
    const std::string archive = "WorldBegin ArchiveBegin \"a\" " + rh + "ArchiveEnd ";
    EXPECT_TRUE(is_reversed(archive + "ReadArchive \"a\" "));
    EXPECT_TRUE(is_reversed(archive + mirror + "ReadArchive \"a\" "));
    EXPECT_FALSE(is_reversed(archive + "ReadArchive \"a\" " + mirror));
}

TEST(ReadOrientation, InstancesKeepOrTurnTheOrientationOfTheirObject) {
    const std::string mirror = "Scale -1 1 1 ";
    const auto placed = [](const std::string& before, const std::string& in_object,
                           const std::string& at_instance) {
        return is_reversed(before + "WorldBegin ObjectBegin 1 " + in_object + kSphere + "ObjectEnd " +
                           at_instance + "ObjectInstance 1 ");
    };
    EXPECT_TRUE(placed("", "Orientation \"rh\" ", ""));
    EXPECT_FALSE(placed("", "Orientation \"rh\" ", mirror)) << "a reflecting instance changes both";
    EXPECT_TRUE(placed(mirror, "Orientation \"rh\" ", "")) << "the object is defined in a mirrored space";
    EXPECT_FALSE(placed(mirror, "Orientation \"rh\" ", mirror));
    EXPECT_TRUE(placed("", mirror + "Orientation \"rh\" ", ""));
    EXPECT_FALSE(placed("", "Orientation \"rh\" " + mirror, ""));
    EXPECT_TRUE(placed("", "", "Orientation \"rh\" "));
    EXPECT_FALSE(placed("", "Orientation \"lh\" ", "Orientation \"rh\" ")) << "the definition says it";
    EXPECT_FALSE(placed("", "Orientation \"outside\" ", "ReverseOrientation "));
    EXPECT_FALSE(placed("", "ReverseOrientation ", "Orientation \"inside\" "));
    EXPECT_TRUE(placed("", "ReverseOrientation ", ""));
    const std::string twice = "WorldBegin ObjectBegin 1 ReverseOrientation " + kSphere +
                              "ObjectEnd ObjectBegin 2 ReverseOrientation ObjectInstance 1 ObjectEnd ";
    EXPECT_FALSE(is_reversed(twice + "ObjectInstance 2 "));
    EXPECT_TRUE(is_reversed(twice + "ReverseOrientation ObjectInstance 2 "));
}

}  // namespace
}  // namespace trapeze::testing
