/// The matrices of a depth map, in a file's metadata.
#pragma once

// First: OpenImageIO declares matrices of its own where it has not seen Imath's.
#include "core/math.h"

#include <OpenImageIO/imageio.h>

#include <optional>

#include "shade/maps/map_library.h"

namespace trapeze {

std::optional<MapMatrices> map_matrices(const OIIO::ImageSpec& spec);

}  // namespace trapeze
