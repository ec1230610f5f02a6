#include "core/ray_sequence.h"

#include <algorithm>

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

}  // namespace trapeze
