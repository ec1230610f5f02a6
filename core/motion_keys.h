/// Motion keys: poses at evenly spaced times of the shutter, between which every vertex moves linearly.
/// Time is 0 at shutter open and 1 at shutter close. A key count is 1 (static) or 2^m + 1.
#pragma once

#include <algorithm>

namespace trapeze {

/// The most keys, 2^6 + 1: enough for poses of what turns several times while the shutter is open.
inline constexpr int kMaxKeyCount = 65;

/// Whether a number of keys is 1 or 2^m + 1, so that coarser keys are a part of finer ones.
constexpr bool is_key_count(int n) {
    return n == 1 || (n >= 2 && n <= kMaxKeyCount && ((n - 1) & (n - 2)) == 0);
}

/// Stretches of linear motion between keys; a static thing counts as one.
constexpr int segment_count(int key_count) {
    return std::max(1, key_count - 1);
}

/// The two keys between which a time lies: keys `index` and `index + 1`, at `local` in [0, 1] of the way.
struct MotionSegment {
    int index = 0;
    float local = 0;
};

/// The segment that a time lies in; any, of a time that is no number. key_count - 1 is a power of two, so
/// that the scaling below is exact.
inline MotionSegment segment_at(float time01, int key_count) {
    if (key_count <= 1) return {};
    const float scaled = time01 * static_cast<float>(key_count - 1);
    const int last = key_count - 2;
    const int index = scaled >= static_cast<float>(last) ? last : scaled > 0 ? static_cast<int>(scaled) : 0;
    return {index, scaled - static_cast<float>(index)};
}

}  // namespace trapeze
