#include "shade/rays/ray_directions.h"

#include <algorithm>
#include <cmath>

#include "core/portable_math.h"

namespace trapeze {

Cone::Cone(const V3f& axis, float angle) : axes_(axis), least_cosine_(portable::cos(angle)) {}

V3f Cone::uniform(const V2f& square) const {
    const float cosine = 1 - square.x * (1 - least_cosine_);
    return axes_.around(std::sqrt(std::max(0.0f, 1 - cosine * cosine)), cosine, square.y);
}

V3f Cone::by_cosine(const V2f& square) const {
    const float rim = std::max(least_cosine_, 0.0f), sine2 = square.x * (1 - rim * rim);
    return axes_.around(std::sqrt(sine2), std::sqrt(std::max(0.0f, 1 - sine2)), square.y);
}

float spread_of(float angle, int samples) {
    constexpr float kTurn = 6.28318530718f;
    return std::sqrt(kTurn * (1 - portable::cos(angle)) / static_cast<float>(samples));
}

}  // namespace trapeze
