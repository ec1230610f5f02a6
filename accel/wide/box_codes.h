/// How a WideTree keeps the boxes of a grid's blocks: at each key of the grid's motion, in the grid's axes,
/// a byte for each plane of each box, in steps of 1 / 255 of the whole grid's box there; and that box itself
/// in steps of 1 / 255 of the grid's box over all keys.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace trapeze {

/// The boxes of a grid in one segment of its motion: plane k of box b is at row(k)[b] + t * row(6 + k)[b],
/// where k is low x, y, z, high x, y, z in the grid's axes, and t the time in the segment.
struct BoxPlanes {
    static constexpr size_t kMost = 16;  ///< boxes
    alignas(64) float values[12 * kMost];

    /// Plane k of all boxes; rows 6 to 11: how far planes 0 to 5 move during the segment.
    float* row(size_t k) { return values + k * kMost; }
    const float* row(size_t k) const { return values + k * kMost; }
};

/// A grid's box at one of its keys, in its axes or in camera space.
struct KeyBounds {
    float low[3], high[3];
};

/// Turns codes 0 .. 255 into planes along an axis, evenly from one end of a range to the other.
struct CodeScale {
    float low = 0, step = 0;

    CodeScale() = default;
    CodeScale(float from, float to) : low(from), step((to - from) * (1.0f / 255)) {}
    /// Code 0 is one end exactly; others, and the other end, to kCodeRounding.
    float plane(int code) const { return low + step * static_cast<float>(code); }
};

/// What may come between two ways to compute CodeScale::plane(), fused and not, as part of the largest
/// coordinate: two roundings of 2^-24, of numbers up to 3.5 and 1.8 times as large (a grid's box in its
/// axes).
inline constexpr float kCodeRounding = 0x1p-21f;

/// The code of the last plane not above `at`, and that of the first not below, among the 256 of a scale. `at`
/// lies within its range by kCodeRounding; else, and for NaN, the code of an end. per_step: 1 / scale.step.
/// The guess is checked by computing the plane, so that the result is conservative whatever the division
/// rounds.
inline uint8_t code_below(const CodeScale& scale, float per_step, float at) {
    const float steps = (at - scale.low) * per_step;
    const int code = steps > 0 ? static_cast<int>(std::min(steps, 255.0f)) : 0;
    return static_cast<uint8_t>(std::max(code - (scale.plane(code) > at), 0));
}
inline uint8_t code_above(const CodeScale& scale, float per_step, float at) {
    const float steps = (at - scale.low) * per_step;
    const int code = steps > 0 ? static_cast<int>(std::min(steps, 255.0f)) : 0;
    return static_cast<uint8_t>(std::min(code + (scale.plane(code) < at), 255));
}

/// Writes and reads a grid's box at a key as six codes, low x, y, z, high x, y, z, between the planes of the
/// grid's box over all keys.
class KeyBoundsScale {
  public:
    explicit KeyBoundsScale(const KeyBounds& whole) {
        for (int k = 0; k < 3; ++k) axis_[k] = CodeScale(whole.low[k], whole.high[k]);
    }
    /// The box that six codes stand for.
    KeyBounds bounds(const uint8_t* codes) const {
        KeyBounds at;
        for (int k = 0; k < 3; ++k)
            at.low[k] = axis_[k].plane(codes[k]), at.high[k] = axis_[k].plane(codes[3 + k]);
        return at;
    }
    /// Codes of bounds, rounded outwards. They must lie within the whole by kCodeRounding.
    void write(const KeyBounds& bounds, uint8_t* codes) const {
        for (int k = 0; k < 3; ++k) {
            const float per_step = 1 / axis_[k].step;
            codes[k] = code_below(axis_[k], per_step, bounds.low[k]);
            codes[3 + k] = code_above(axis_[k], per_step, bounds.high[k]);
        }
    }

  private:
    CodeScale axis_[3];
};

}  // namespace trapeze
