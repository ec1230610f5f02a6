#include "shade/rays/ray_directions.h"

#include <algorithm>
#include <cmath>

#include "core/portable_math.h"
#include "core/random.h"

namespace trapeze {
namespace {

/// The bits of a number behind the binary point, in reverse: van der Corput's sequence.
uint32_t reversed(uint32_t bits) {
    bits = (bits >> 16) | (bits << 16);
    bits = ((bits & 0x00ff00ffu) << 8) | ((bits & 0xff00ff00u) >> 8);
    bits = ((bits & 0x0f0f0f0fu) << 4) | ((bits & 0xf0f0f0f0u) >> 4);
    bits = ((bits & 0x33333333u) << 2) | ((bits & 0xccccccccu) >> 2);
    return ((bits & 0x55555555u) << 1) | ((bits & 0xaaaaaaaau) >> 1);
}

}  // namespace

RaySequence::RaySequence(uint32_t seed, int count)
    : scramble_(hash(seed, 1)), shift_(unit_float(hash(seed, 2))), count_(count) {}

V2f RaySequence::operator[](int i) const {
    const float x = (static_cast<float>(i) + shift_) / static_cast<float>(count_);
    // Exclusive or shuffles halves, quarters...: each still holds its share of the points.
    return {std::min(x, 0x1.fffffep-1f), unit_float(reversed(static_cast<uint32_t>(i)) ^ scramble_)};
}

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

}  // namespace trapeze
