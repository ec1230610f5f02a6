/// Sums over many boxes, in vectors of four floats: what builders over boxes spend most of their time on.
#pragma once

#include <algorithm>
#include <cstring>
#include <limits>

#include "core/math.h"

namespace trapeze {

/// A box as it lies in memory.
struct BoxLanes {
    using Lanes = float __attribute__((vector_size(16)));

    Lanes low;   ///< minima, and the first maximum
    Lanes high;  ///< the last minimum, and maxima

    BoxLanes(const Lanes& of_low, const Lanes& of_high) : low(of_low), high(of_high) {}
    explicit BoxLanes(const Box3f& box) {
        static_assert(sizeof(Box3f) == 6 * sizeof(float), "minima before maxima, nothing between");
        std::memcpy(&low, &box.min.x, sizeof low);
        std::memcpy(&high, &box.min.z, sizeof high);
    }
};

/// Adds boxes one by one as Box3f::extendBy() does, to the same bits (a NaN is passed over), but without its
/// branches. Empty until a box that is not is added.
class BoxSum {
  public:
    void add(const Box3f& box) { add(BoxLanes(box)); }
    void add(const BoxLanes& box) { join(box.low, box.high); }
    void add(const V3f& point) {
        join(Lanes{point.x, point.y, point.z, point.x}, Lanes{point.x, point.x, point.y, point.z});
    }
    void add(const BoxSum& o) { join(o.low_, o.high_); }

    /// The largest |coordinate| of box(), which must not be empty.
    float largest_coordinate() const {
        // Of the lanes that nobody reads the values lie between those of the box.
        const Lanes low = low_ < 0 ? -low_ : low_, high = high_ < 0 ? -high_ : high_;
        const Lanes largest = low > high ? low : high;
        return std::max(std::max(largest[0], largest[1]), std::max(largest[2], largest[3]));
    }

    /// Leaves of it what is not below, or not above, a plane across an axis.
    void cut_below(int axis, float at) { low_[axis] = at < low_[axis] ? low_[axis] : at; }
    void cut_above(int axis, float at) { high_[axis + 1] = high_[axis + 1] < at ? high_[axis + 1] : at; }

    BoxLanes lanes() const { return {low_, high_}; }
    Box3f box() const { return {{low_[0], low_[1], low_[2]}, {high_[1], high_[2], high_[3]}}; }

  private:
    using Lanes = BoxLanes::Lanes;

    void join(const Lanes& low, const Lanes& high) {
        low_ = low < low_ ? low : low_;
        high_ = high > high_ ? high : high_;
    }

    static constexpr float kMost = std::numeric_limits<float>::max();
    Lanes low_{kMost, kMost, kMost, kMost}, high_{-kMost, -kMost, -kMost, -kMost};
};

/// The longest side of many boxes, 0 without any; sides that are no numbers are passed over.
class LongestSide {
  public:
    void add(const BoxLanes& box) {
        const BoxLanes::Lanes sides = box.high - __builtin_shufflevector(box.low, box.low, 3, 0, 1, 2);
        longest_ = sides > longest_ ? sides : longest_;
    }
    float get() const { return std::max({longest_[1], longest_[2], longest_[3]}); }

  private:
    BoxLanes::Lanes longest_{};  ///< but for the first, which is no side
};

}  // namespace trapeze
