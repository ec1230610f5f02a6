/// Martin Newell's teapot (University of Utah, 1975) with its bottom: 32 bicubic Bezier patches, z up, from z
/// = 0.
#pragma once

#include <array>
#include <vector>

#include "core/math.h"

namespace trapeze::rib {

/// Control points, u fastest; dPdu x dPdv points outwards.
std::vector<std::array<V3f, 16>> teapot_patches();

}  // namespace trapeze::rib
