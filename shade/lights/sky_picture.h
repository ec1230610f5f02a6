/// Colours all around: what environment maps and domes hold.
#pragma once

#include <vector>

#include "core/math.h"

namespace trapeze {

/// By longitude (from 0 at the left) and latitude (from the zenith at the top down), row by row; all finite
/// and not below zero.
struct SkyPicture {
    int width = 0, height = 0;
    std::vector<V3f> colors;
};

/// Of linear colours with Rec. 709's primaries.
inline double luminance(const V3f& c) {
    return 0.2126 * static_cast<double>(c.x) + 0.7152 * static_cast<double>(c.y) +
           0.0722 * static_cast<double>(c.z);
}

}  // namespace trapeze
