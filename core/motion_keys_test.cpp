#include "core/motion_keys.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/motion_keys_harness.h"

namespace trapeze {
namespace {

using testing::is_key_count;

TEST(MotionKeys, CountsAreOneOrAPowerOfTwoPlusOne) {
    for (const int good : {1, 2, 3, 5, 9, 17, 33, 65}) EXPECT_TRUE(is_key_count(good)) << good;
    for (const int bad : {-1, 0, 4, 6, 7, 8, 10, 64, 66, 129}) EXPECT_FALSE(is_key_count(bad)) << bad;
}

TEST(MotionKeys, SegmentsMeetAtKeys) {
    for (const int keys : {2, 3, 5, 65})
        for (int key = 0; key < keys; ++key) {
            const MotionSegment s = segment_at(static_cast<float>(key) / static_cast<float>(keys - 1), keys);
            EXPECT_EQ(static_cast<float>(s.index) + s.local, static_cast<float>(key));
            EXPECT_LE(s.index, keys - 2);
        }
}

TEST(MotionKeys, TimeIsWithinItsSegment) {
    for (const int keys : {2, 3, 5, 9, 65})
        for (float t = 0; t <= 1; t += 0.001f) {
            const MotionSegment s = segment_at(t, keys);
            ASSERT_GE(s.local, 0);
            ASSERT_LE(s.local, 1);
            ASSERT_FLOAT_EQ((static_cast<float>(s.index) + s.local) / static_cast<float>(keys - 1), t);
        }
}

TEST(MotionKeys, OutsideTheShutterTheEndSegmentsHold) {
    EXPECT_EQ(segment_at(1.5f, 5).index, 3);
    EXPECT_EQ(segment_at(-0.5f, 5).index, 0);
    EXPECT_EQ(segment_at(0.7f, 1).index, 0);
    EXPECT_EQ(segment_at(0.7f, 1).local, 0);
}

TEST(ShutterTimes, OfSamplesThatFollowEachOtherAreInDifferentParts) {
    for (const float shift : {0.0f, 0.1f, 0.77f, 0x1.fffffep-1f})
        for (const size_t parts : {3, 9, 27}) {
            std::set<size_t> found;
            for (size_t sample = 0; sample < parts; ++sample) {
                const float time = shutter_time(static_cast<int>(sample), shift);
                EXPECT_GE(time, 0);
                EXPECT_LT(time, 1);
                // Relative to the first one, whatever the shift.
                const float from_first = time - shutter_time(0, shift) + 0.5f / static_cast<float>(parts);
                found.insert(part_of_shutter(from_first < 0 ? from_first + 1 : from_first, parts));
            }
            EXPECT_EQ(found.size(), parts) << shift;
        }
}

TEST(ShutterTimes, PartsHaveTheirMiddlesInThem) {
    EXPECT_EQ(middle_of_part(0, 1), 0);
    EXPECT_EQ(part_of_shutter(0.9f, 1), 0u);
    for (const size_t parts : {2, 5, 32})
        for (size_t part = 0; part < parts; ++part)
            EXPECT_EQ(part_of_shutter(middle_of_part(part, parts), parts), part);
    EXPECT_EQ(part_of_shutter(1, 4), 3u);
    EXPECT_EQ(part_of_shutter(-1, 4), 0u);
}

}  // namespace
}  // namespace trapeze
