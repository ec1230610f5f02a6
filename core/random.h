/// Random numbers from an index [decision 0019]: the same for any order of work. A counter hashed by PCG's
/// output function [Jarzynski20, "Hash Functions for GPU Rendering", pcg3d-style mixing of a 32-bit word].
#pragma once

#include <cstdint>

namespace trapeze {

/// A permutation of 32-bit words that mixes all bits.
constexpr uint32_t hash(uint32_t x) {
    x = x * 747796405u + 2891336453u;
    x = ((x >> ((x >> 28) + 4)) ^ x) * 277803737u;
    return (x >> 22) ^ x;
}

/// Hashes of several words depend on their order.
constexpr uint32_t hash(uint32_t a, uint32_t b) {
    return hash(a ^ hash(b));
}
constexpr uint32_t hash(uint32_t a, uint32_t b, uint32_t c) {
    return hash(a, hash(b, c));
}
constexpr uint32_t hash(uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
    return hash(a, hash(b, c, d));
}

/// The upper 24 bits as a float in [0, 1).
constexpr float unit_float(uint32_t bits) {
    return static_cast<float>(bits >> 8) * (1.0f / 16777216.0f);
}

}  // namespace trapeze
