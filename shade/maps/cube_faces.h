/// Six views of a cube as one picture by longitude and latitude.
#pragma once

#include <array>
#include <vector>

#include "core/math.h"

namespace trapeze {

/// A picture in memory: pixels row by row from the top left, `channels` floats each.
struct Raster {
    int width = 0, height = 0, channels = 0;
    std::vector<float> pixels;

    const float* at(int x, int y) const {
        return pixels.data() + (static_cast<size_t>(y) * width + x) * channels;
    }
    float* at(int x, int y) { return const_cast<float*>(static_cast<const Raster*>(this)->at(x, y)); }
};

/// The picture of all directions that six faces see, which make_maps.h orders and orients. All have the same
/// number of channels; fov, in degrees, is theirs. Four times as wide as the widest face and half as high, so
/// that pixels at the equator are as wide as a face's on average.
Raster lat_long_from_cube(const std::array<Raster, 6>& faces, float fov);

}  // namespace trapeze
