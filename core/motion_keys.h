/// Motion keys: poses at evenly spaced times of the shutter, between which every vertex moves linearly.
/// Time is 0 at shutter open and 1 at shutter close. A key count is 1 (static) or 2^m + 1.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace trapeze {

/// The most keys, 2^6 + 1: enough for poses of what turns several times while the shutter is open.
inline constexpr int kMaxKeyCount = 65;

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

/// The time of a sample: 0 at shutter open, below 1. Times of samples that follow each other are well apart,
/// and have nothing to do with where these go: van der Corput's sequence to base 3, shifted by `shift` (0 to
/// below 1).
inline float shutter_time(int sample, float shift) {
    float place = 1.0f / 3, time = shift;
    for (auto number = static_cast<uint32_t>(sample); number > 0; number /= 3, place /= 3)
        time += static_cast<float>(number % 3) * place;
    return std::min(time < 1 ? time : time - 1, 0x1.fffffep-1f);
}

/// The middle of one of so many equal parts of the shutter, and the part that a time lies in; with one part
/// things are as they are at shutter open.
inline float middle_of_part(size_t part, size_t parts) {
    return parts > 1 ? (static_cast<float>(part) + 0.5f) / static_cast<float>(parts) : 0;
}
inline size_t part_of_shutter(float time, size_t parts) {
    const float scaled = time * static_cast<float>(parts);
    return scaled > 0 ? std::min(static_cast<size_t>(scaled), parts - 1) : 0;
}

}  // namespace trapeze
