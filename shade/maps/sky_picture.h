/// Colours of an environment map in cells of longitude and latitude.
#pragma once

#include <string_view>
#include <vector>

#include "core/math.h"
#include "shade/maps/textures.h"

namespace trapeze {

/// Longitude runs from 0 at the left, latitude from the zenith at the top down, row by row; all colours are
/// finite and not below zero. Empty where the map cannot be read.
struct SkyPicture {
    int width = 0, height = 0;
    std::vector<V3f> colors;
};

/// Reads a map at no more columns than these, and half as many rows; where the map has fewer than `least`,
/// each of its pixels is several cells.
SkyPicture read_sky_picture(Textures& textures, std::string_view name, SourceLocation location,
                            int most_columns, int least_columns = 1);

}  // namespace trapeze
