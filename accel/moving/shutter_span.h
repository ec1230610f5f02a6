/// When a moving interval of coordinates reaches to one side of a plane: what the k-d tree for motion blur
/// keeps with its references [Yang17 sec. 3.1.1].
#pragma once

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

/// The shortest span of `within` that holds all times at which a value, linear between evenly spaced keys, is
/// at most `at`. Grown by what its own arithmetic rounds; never beyond `within`.
ShutterSpan when_at_or_below(std::span<const float> keys, float at, ShutterSpan within);
/// The same, where it is at least `at`.
ShutterSpan when_at_or_above(std::span<const float> keys, float at, ShutterSpan within);

/// The same of the lower side of a moving box, and the plane where coordinate `axis` is `at`.
ShutterSpan when_at_or_below(std::span<const Box3f> keys, int axis, float at, ShutterSpan within);
/// The same of its upper side, at or above the plane.
ShutterSpan when_at_or_above(std::span<const Box3f> keys, int axis, float at, ShutterSpan within);

}  // namespace trapeze
