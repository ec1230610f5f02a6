/// Half floats, in which colours lie in memory and in files.
#pragma once

#include <Imath/half.h>

#include <algorithm>

namespace trapeze {

inline constexpr float kLargestHalf = 65504;  ///< that is finite

/// The nearest half; what is larger than any becomes the largest finite one, so that no infinities arise.
inline Imath::half to_half(float value) {
    return Imath::half(std::clamp(value, -kLargestHalf, kLargestHalf));
}

}  // namespace trapeze
