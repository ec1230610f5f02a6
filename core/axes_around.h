/// Axes around one: for directions around it, and for what lies across it.
#pragma once

#include <cmath>
#include <numbers>

#include "core/math.h"
#include "core/portable_math.h"

namespace trapeze {

/// An axis with two directions across it, all of unit length and at right angles. It is continuous but at
/// one axis [Duff17].
template <class T>
struct AxesAround {
    using Vector = Imath::Vec3<T>;

    Vector axis, across, along;

    explicit AxesAround(const Vector& unit) : axis(unit) {
        const T sign = std::copysign(T(1), axis.z), a = -1 / (sign + axis.z), b = axis.x * axis.y * a;
        across = {1 + sign * axis.x * axis.x * a, sign * b, -sign * axis.x};
        along = {b, sign + axis.y * axis.y * a, -axis.y};
    }

    /// A direction, by the sine and cosine of its angle to the axis; `turn`: a part of the whole.
    Vector around(T sine, T cosine, T turn) const {
        const T angle = 2 * std::numbers::pi_v<T> * turn;
        return across * (sine * portable::cos(angle)) + along * (sine * portable::sin(angle)) + axis * cosine;
    }
    /// What of a way lies across the axis.
    Imath::Vec2<T> across_of(const Vector& way) const { return {way.dot(across), way.dot(along)}; }
};

}  // namespace trapeze
