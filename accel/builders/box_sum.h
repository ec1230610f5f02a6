/// The box of many boxes, in vectors of four floats: what builders over boxes spend most of their time on.
#pragma once

#include <cstring>
#include <limits>

#include "core/math.h"

namespace trapeze {

/// Adds boxes one by one as Box3f::extendBy() does, to the same bits (a NaN is passed over), but without its
/// branches. Empty until a box that is not is added.
class BoxSum {
  public:
    void add(const Box3f& box) {
        static_assert(sizeof(Box3f) == 6 * sizeof(float), "minima before maxima, nothing between");
        Lanes low, high;
        std::memcpy(&low, &box.min.x, sizeof low);    // minima, and a maximum that nobody reads
        std::memcpy(&high, &box.min.z, sizeof high);  // a minimum that nobody reads, and maxima
        join(low, high);
    }
    void add(const V3f& point) {
        join(Lanes{point.x, point.y, point.z, point.x}, Lanes{point.x, point.x, point.y, point.z});
    }
    void add(const BoxSum& o) { join(o.low_, o.high_); }

    /// Leaves of it what is not below, or not above, a plane across an axis.
    void cut_below(int axis, float at) { low_[axis] = at < low_[axis] ? low_[axis] : at; }
    void cut_above(int axis, float at) { high_[axis + 1] = high_[axis + 1] < at ? high_[axis + 1] : at; }

    Box3f box() const { return {{low_[0], low_[1], low_[2]}, {high_[1], high_[2], high_[3]}}; }

  private:
    using Lanes = float __attribute__((vector_size(16)));

    void join(const Lanes& low, const Lanes& high) {
        low_ = low < low_ ? low : low_;
        high_ = high > high_ ? high : high_;
    }

    static constexpr float kMost = std::numeric_limits<float>::max();
    Lanes low_{kMost, kMost, kMost, kMost}, high_{-kMost, -kMost, -kMost, -kMost};
};

}  // namespace trapeze
