/// When a moving interval of coordinates reaches to one side of a plane: what the k-d tree for motion blur
/// keeps with its references [Yang17 sec. 3.1.1].
#pragma once

#include <algorithm>
#include <span>

#include "core/math.h"

namespace trapeze {

/// A closed span of the shutter, within [0, 1]; empty where from > to.
struct ShutterSpan {
    float from = 0, to = 1;

    static constexpr ShutterSpan none() { return {1, 0}; }
    bool is_empty() const { return from > to; }
    bool holds(float time) const { return from <= time && time <= to; }
    float length() const { return is_empty() ? 0 : to - from; }
    bool operator==(const ShutterSpan& o) const { return from == o.from && to == o.to; }
};

namespace shutter_span_detail {

/// A crossing is a quotient of two differences, scaled and moved by whole numbers: a few half-ulps of 1.
inline constexpr float kTimeRounding = 0x1p-20f;

/// The shortest span of `within` that holds all times at which a value that goes from `begin` to `end` is at
/// most `at`. Most things that move have two keys: it is inline for them.
inline ShutterSpan when_not_above(float begin, float end, float at, ShutterSpan within) {
    const bool begins_above = begin > at, ends_above = end > at;
    if (within.is_empty() || (begins_above && ends_above)) return ShutterSpan::none();
    if (begins_above == ends_above) return within;
    const float crossing = (at - begin) / (end - begin);
    if (begins_above)
        within.from = std::max(within.from, crossing - kTimeRounding);
    else
        within.to = std::min(within.to, crossing + kTimeRounding);
    return within.is_empty() ? ShutterSpan::none() : within;
}

// Of more keys than two.
ShutterSpan when_at_or_below(std::span<const float> keys, float at, ShutterSpan within);
ShutterSpan when_at_or_above(std::span<const float> keys, float at, ShutterSpan within);
ShutterSpan when_at_or_below(std::span<const Box3f> keys, int axis, float at, ShutterSpan within);
ShutterSpan when_at_or_above(std::span<const Box3f> keys, int axis, float at, ShutterSpan within);

}  // namespace shutter_span_detail

/// The shortest span of `within` that holds all times at which a value, linear between evenly spaced keys, is
/// at most `at`. Grown by what its own arithmetic rounds; never beyond `within`.
inline ShutterSpan when_at_or_below(std::span<const float> keys, float at, ShutterSpan within) {
    if (keys.size() > 2) return shutter_span_detail::when_at_or_below(keys, at, within);
    return shutter_span_detail::when_not_above(keys.front(), keys.back(), at, within);
}
/// The same, where it is at least `at`.
inline ShutterSpan when_at_or_above(std::span<const float> keys, float at, ShutterSpan within) {
    if (keys.size() > 2) return shutter_span_detail::when_at_or_above(keys, at, within);
    return shutter_span_detail::when_not_above(-keys.front(), -keys.back(), -at, within);
}

/// The same of the lower side of a moving box, and the plane where coordinate `axis` is `at`.
inline ShutterSpan when_at_or_below(std::span<const Box3f> keys, int axis, float at, ShutterSpan within) {
    if (keys.size() > 2) return shutter_span_detail::when_at_or_below(keys, axis, at, within);
    return shutter_span_detail::when_not_above(keys.front().min[axis], keys.back().min[axis], at, within);
}
/// The same of its upper side, at or above the plane.
inline ShutterSpan when_at_or_above(std::span<const Box3f> keys, int axis, float at, ShutterSpan within) {
    if (keys.size() > 2) return shutter_span_detail::when_at_or_above(keys, axis, at, within);
    return shutter_span_detail::when_not_above(-keys.front().max[axis], -keys.back().max[axis], -at, within);
}

}  // namespace trapeze
