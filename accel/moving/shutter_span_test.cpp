#include "accel/moving/shutter_span.h"

#include <gtest/gtest.h>

#include <vector>

#include "accel/moving_harness.h"

namespace trapeze {
namespace {

/// A box that is `low` to `high` wide along x at keys.
std::vector<Box3f> along_x(const std::vector<std::pair<float, float>>& keys) {
    std::vector<Box3f> boxes;
    for (const auto& [low, high] : keys) boxes.push_back({V3f(low, 0, 0), V3f(high, 1, 1)});
    return boxes;
}

TEST(ShutterSpan, OfWhatStandsStillIsAllOrNothing) {
    const auto box = along_x({{1, 2}});
    EXPECT_EQ(when_at_or_below(box, 0, 1, {.25f, .5f}), (ShutterSpan{.25f, .5f}));
    EXPECT_TRUE(when_at_or_below(box, 0, .9f, {}).is_empty());
    EXPECT_EQ(when_at_or_above(box, 0, 2, {}), ShutterSpan{});
    EXPECT_TRUE(when_at_or_above(box, 0, 2.1f, {}).is_empty());
    EXPECT_TRUE(when_at_or_above(box, 0, 1, ShutterSpan::none()).is_empty());
}

TEST(ShutterSpan, EndsWhereASideCrossesThePlane) {
    const auto box = along_x({{0, 1}, {4, 5}});
    EXPECT_NEAR(when_at_or_below(box, 0, 1, {}).to, .25f, 1e-5f);
    EXPECT_EQ(when_at_or_below(box, 0, 1, {}).from, 0);
    EXPECT_NEAR(when_at_or_above(box, 0, 3, {}).from, .5f, 1e-5f);
    EXPECT_EQ(when_at_or_above(box, 0, 3, {}).to, 1);
    EXPECT_TRUE(when_at_or_below(box, 0, 1, {.5f, 1}).is_empty());
    EXPECT_TRUE(when_at_or_above(box, 0, 3, {0, .25f}).is_empty());
}

/// There and back again: one span for what are two.
TEST(ShutterSpan, HoldsAllVisits) {
    const auto box = along_x({{0, 1}, {4, 5}, {0, 1}, {4, 5}, {4, 5}});
    const ShutterSpan below = when_at_or_below(box, 0, 2, {});
    EXPECT_EQ(below.from, 0);
    EXPECT_NEAR(below.to, .625f, 1e-5f);
    const ShutterSpan later = when_at_or_below(box, 0, 2, {.25f, 1});
    EXPECT_NEAR(later.from, .375f, 1e-5f);
}

/// At every time each side is told where it is, and so at the ends of spans within rounding.
TEST(ShutterSpan, HoldsEveryTimeOnItsSide) {
    testing::Noise noise;
    for (int round = 0; round < 3000; ++round) {
        const int count = std::array{2, 3, 5, 17}[static_cast<size_t>(round) % 4];
        std::vector<std::pair<float, float>> keys;
        for (int key = 0; key < count; ++key) {
            const float low = noise(-1, 1);
            keys.emplace_back(low, low + noise(0, .5f));
        }
        const auto box = along_x(keys);
        const float at = noise(-1, 1), a = noise(0, 1), b = noise(0, 1);
        const ShutterSpan within{std::min(a, b), std::max(a, b)};
        const ShutterSpan below = when_at_or_below(box, 0, at, within),
                          above = when_at_or_above(box, 0, at, within);
        for (const ShutterSpan& span : {below, above})
            if (!span.is_empty()) {
                EXPECT_GE(span.from, within.from);
                EXPECT_LE(span.to, within.to);
            }
        const auto low_at = [&](float time) {
            const MotionSegment s = segment_at(time, count);
            const auto i = static_cast<size_t>(s.index);
            return keys[i].first + (keys[i + 1].first - keys[i].first) * s.local;
        };
        // A span is no longer than it must be: at its ends the side is there, or all but.
        if (!below.is_empty()) {
            EXPECT_LE(low_at(below.from), at + 1e-4f);
            EXPECT_LE(low_at(below.to), at + 1e-4f);
        }
        for (int n = 0; n <= 200; ++n) {
            const float time = within.from + (within.to - within.from) * static_cast<float>(n) / 200;
            if (!within.holds(time)) continue;
            const MotionSegment s = segment_at(time, count);
            const auto i = static_cast<size_t>(s.index);
            const float high = keys[i].second + (keys[i + 1].second - keys[i].second) * s.local;
            if (low_at(time) <= at) {
                EXPECT_TRUE(below.holds(time)) << time;
            }
            if (high >= at) {
                EXPECT_TRUE(above.holds(time)) << time;
            }
        }
    }
}

}  // namespace
}  // namespace trapeze
