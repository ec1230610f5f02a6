/// Six views of a cube as one picture by longitude and latitude.
#pragma once

#include <array>
#include <vector>

#include "core/math.h"

namespace trapeze {

/// Pixels row by row from the top left, `channels` floats each.
struct Raster {
    int width = 0, height = 0, channels = 0;
    std::vector<float> pixels;

    const float* at(int x, int y) const {
        return pixels.data() + (static_cast<size_t>(y) * width + x) * channels;
    }
    float* at(int x, int y) { return const_cast<float*>(static_cast<const Raster*>(this)->at(x, y)); }
};

/// As make_maps.h orders and orients the faces, which all have the same number of channels; fov in degrees.
/// Four times as wide as the widest face.
Raster lat_long_from_cube(const std::array<Raster, 6>& faces, float fov);

}  // namespace trapeze
