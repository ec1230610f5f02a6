/// Pseudo-random numbers for tests.
#pragma once

#include <random>

#include "core/math.h"

namespace trapeze::testing {

/// The same in every run.
struct Noise {
    std::mt19937 engine{9};
    float operator()(float from, float to) { return std::uniform_real_distribution<float>(from, to)(engine); }
    V3f point(float reach) { return point(reach, -reach, reach); }
    V3f point(float xy, float z_from, float z_to) {
        return {(*this)(-xy, xy), (*this)(-xy, xy), (*this)(z_from, z_to)};
    }
};

}  // namespace trapeze::testing
