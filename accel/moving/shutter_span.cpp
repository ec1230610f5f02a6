#include "accel/moving/shutter_span.h"

#include <algorithm>

#include "core/motion_keys.h"

namespace trapeze::shutter_span_detail {
namespace {

/// The span of `within` at which values, one a key, are at or below `at`.
template <class ValueAt>
ShutterSpan when_not_above(size_t keys, const ValueAt& value_at, float at, ShutterSpan within) {
    if (within.is_empty()) return ShutterSpan::none();
    // Most things stay on one side: no times are asked for.
    size_t above = 0;
    for (size_t key = 0; key < keys; ++key) above += value_at(key) > at;
    if (above == keys) return ShutterSpan::none();
    if (above == 0) return within;
    const int count = static_cast<int>(keys);
    const float segments = static_cast<float>(count - 1);  // a power of two: quotients by it are exact
    ShutterSpan span = ShutterSpan::none();
    for (int s = segment_at(within.from, count).index; s < count - 1; ++s) {
        const float begin = static_cast<float>(s) / segments, end = static_cast<float>(s + 1) / segments;
        if (begin > within.to) break;
        const float a = value_at(static_cast<size_t>(s)), b = value_at(static_cast<size_t>(s) + 1);
        if (a > at && b > at) continue;
        ShutterSpan part{std::max(begin, within.from), std::min(end, within.to)};
        if (a > at || b > at) {
            const float crossing = begin + (at - a) / (b - a) / segments;
            if (a > at)
                part.from = std::max(part.from, crossing - kTimeRounding);
            else
                part.to = std::min(part.to, crossing + kTimeRounding);
            if (part.is_empty()) continue;
        }
        // Times in between at which the value is larger are taken in: one span is kept, not several.
        span = span.is_empty() ? part : ShutterSpan{span.from, part.to};
    }
    return span;
}

}  // namespace

ShutterSpan when_at_or_below(std::span<const float> keys, float at, ShutterSpan within) {
    return when_not_above(
        keys.size(), [&](size_t key) { return keys[key]; }, at, within);
}

ShutterSpan when_at_or_above(std::span<const float> keys, float at, ShutterSpan within) {
    return when_not_above(
        keys.size(), [&](size_t key) { return -keys[key]; }, -at, within);
}

ShutterSpan when_at_or_below(std::span<const Box3f> keys, int axis, float at, ShutterSpan within) {
    return when_not_above(
        keys.size(), [&](size_t key) { return keys[key].min[axis]; }, at, within);
}

ShutterSpan when_at_or_above(std::span<const Box3f> keys, int axis, float at, ShutterSpan within) {
    return when_not_above(
        keys.size(), [&](size_t key) { return -keys[key].max[axis]; }, -at, within);
}

}  // namespace trapeze::shutter_span_detail
