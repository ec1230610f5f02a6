/// Files of maps, made in memory.
#pragma once

// First: OpenImageIO declares vectors of its own where it has not seen Imath's.
#include "core/math.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <vector>

#include "shade/maps/map_library.h"

namespace trapeze {

/// What ImageBufAlgo::make_texture() makes of a texture, as OpenEXR.
MapBytes open_exr_texture(const OIIO::ImageBuf& picture, OIIO::ImageSpec config);

/// A picture of floats as a TIFF.
MapBytes tiff_bytes(const OIIO::ImageSpec& spec, const std::vector<float>& pixels);

}  // namespace trapeze
