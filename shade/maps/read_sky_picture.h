/// Reads colours of an environment map in cells of longitude and latitude.
#pragma once

#include <string_view>

#include "shade/lights/sky_picture.h"
#include "shade/maps/textures.h"

namespace trapeze {

/// Reads a map at no more columns than these, and half as many rows; where the map has fewer than `least`,
/// each of its pixels is several cells. Empty where it cannot be read.
SkyPicture read_sky_picture(Textures& textures, std::string_view name, SourceLocation location,
                            int most_columns, int least_columns = 1);

}  // namespace trapeze
