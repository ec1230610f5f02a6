#include "core/hyper_trapezoid.h"

#include <algorithm>
#include <cmath>

namespace trapeze {
namespace {

/// Any unit vector orthogonal to a unit vector.
V3d orthogonal_to(const V3d& unit) {
    const V3d helper = std::abs(unit.x) < 0.6 ? V3d(1, 0, 0) : V3d(0, 1, 0);
    return unit.cross(helper).normalized();
}

/// A box around a box that is turned from some axes into others.
Box3f turned(const Box3f& box, const Axes& from, const Axes& to) {
    const V3f centre = to.from_space(from.to_space((box.min + box.max) * 0.5f));
    const V3f half = (box.max - box.min) * 0.5f;
    V3f extent;
    for (int k = 0; k < 3; ++k)
        extent[k] = std::abs(to.axis[k].dot(from.axis[0])) * half.x +
                    std::abs(to.axis[k].dot(from.axis[1])) * half.y +
                    std::abs(to.axis[k].dot(from.axis[2])) * half.z;
    // The largest coordinate before turning counts as well: rounding is relative to it.
    const V3f pad(largest_coordinate(box) * 2 * kBoundRounding);
    return grown_for_rounding({centre - extent - pad, centre + extent + pad});
}

}  // namespace

float largest_coordinate(const Box3f& box) {
    float largest = 0;
    for (int k = 0; k < 3; ++k) largest = std::max({largest, std::abs(box.min[k]), std::abs(box.max[k])});
    return largest;
}

Axes axes_of(const V3d& first, const V3d& second) {
    // Scaled by a power of two near the longer length, so that squares neither overflow nor vanish.
    double largest = 0;
    for (int k = 0; k < 3; ++k) largest = std::max({largest, std::abs(first[k]), std::abs(second[k])});
    if (!(largest > 0) || !std::isfinite(largest)) return {};
    const V3d a = first / largest, b = second / largest;
    const bool first_is_main = a.length2() >= b.length2();
    const V3d main = (first_is_main ? a : b).normalized();
    const V3d& other = first_is_main ? b : a;
    V3d side = other - main * main.dot(other);
    side = side.length2() > 1e-12 * other.length2() ? side.normalized() : orthogonal_to(main);
    const V3d normal = main.cross(side);
    return {{V3f(main), V3f(side), V3f(normal)}};
}

Box3f grown_for_rounding(const Box3f& box) {
    const V3f pad(largest_coordinate(box) * kBoundRounding);
    return {box.min - pad, box.max + pad};
}

Box3f HyperTrapezoid::at(float time01) const {
    if (keys.size() == 1) return keys[0];
    const MotionSegment s = segment_at(time01, key_count());
    const Box3f &from = keys[s.index], &to = keys[s.index + 1];
    if (s.local == 0) return from;
    return grown_for_rounding(
        {from.min + (to.min - from.min) * s.local, from.max + (to.max - from.max) * s.local});
}

bool HyperTrapezoid::contains(const V3f& point, float time01) const {
    return grown_for_rounding(at(time01)).intersects(axes.from_space(point));
}

HyperTrapezoid HyperTrapezoid::in(const Axes& other, int at_least_keys) const {
    HyperTrapezoid result{other, {}};
    const int count = std::max(at_least_keys, key_count());
    result.keys.reserve(count);
    const bool same = other == axes;
    for (int key = 0; key < count; ++key) {
        const Box3f box =
            count == key_count()
                ? keys[key]
                : at(count == 1 ? 0.0f : static_cast<float>(key) / static_cast<float>(count - 1));
        result.keys.push_back(same ? box : turned(box, axes, other));
    }
    return result;
}

void HyperTrapezoid::merge(const HyperTrapezoid& other) {
    const int count = std::max(key_count(), other.key_count());
    if (count > key_count()) *this = in(axes, count);
    const HyperTrapezoid here = other.in(axes, count);
    for (int key = 0; key < count; ++key) keys[key].extendBy(here.keys[key]);
}

double HyperTrapezoid::expected_half_area() const {
    double sum = 0;
    for (const Box3f& box : keys) {
        const V3d size = V3d(box.max) - V3d(box.min);
        sum += size.x * size.y + size.y * size.z + size.z * size.x;
    }
    return sum / static_cast<double>(keys.size());
}

}  // namespace trapeze
