#include "shade/rays/ray_directions.h"

#include <algorithm>
#include <cmath>

#include "core/portable_math.h"

namespace trapeze {

/// The frame is continuous but at one point [Duff17].
Cone::Cone(const V3f& axis, float angle) : axis_(axis), least_cosine_(portable::cos(angle)) {
    const float sign = std::copysign(1.0f, axis.z), a = -1 / (sign + axis.z), b = axis.x * axis.y * a;
    across_ = {1 + sign * axis.x * axis.x * a, sign * b, -sign * axis.x};
    along_ = {b, sign + axis.y * axis.y * a, -axis.y};
}

V3f Cone::around(float sine, float cosine, float turn) const {
    constexpr float kTurn = 6.28318530718f;
    return across_ * (sine * portable::cos(kTurn * turn)) + along_ * (sine * portable::sin(kTurn * turn)) +
           axis_ * cosine;
}

V3f Cone::uniform(const V2f& square) const {
    const float cosine = 1 - square.x * (1 - least_cosine_);
    return around(std::sqrt(std::max(0.0f, 1 - cosine * cosine)), cosine, square.y);
}

V3f Cone::by_cosine(const V2f& square) const {
    const float rim = std::max(least_cosine_, 0.0f), sine2 = square.x * (1 - rim * rim);
    return around(std::sqrt(sine2), std::sqrt(std::max(0.0f, 1 - sine2)), square.y);
}

float spread_of(float angle, int samples) {
    constexpr float kTurn = 6.28318530718f;
    return std::sqrt(kTurn * (1 - portable::cos(angle)) / static_cast<float>(samples));
}

}  // namespace trapeze
