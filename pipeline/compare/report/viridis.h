#pragma once

#include <array>
#include <cstdint>

namespace trapeze {

/// The perceptually uniform colour map viridis [Walt15], sRGB, for t in [0, 1]; by a
/// polynomial of degree 6 through it, within 3 of 255.
std::array<uint8_t, 3> viridis(float t);

}  // namespace trapeze
