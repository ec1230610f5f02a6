/// Files of maps, made in memory by OpenImageIO. Its writer of OpenEXR waits for ever where a disk is full;
/// whoever has the bytes can write them and notice.
#pragma once

// First: OpenImageIO declares vectors of its own where it has not seen Imath's.
#include "core/math.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <string>
#include <vector>

namespace trapeze {

struct MapBytes {
    std::vector<unsigned char> bytes;
    std::string problem;  ///< empty, or why there are none
};

/// What ImageBufAlgo::make_texture() makes of a texture, as OpenEXR.
MapBytes open_exr_texture(const OIIO::ImageBuf& picture, OIIO::ImageSpec config);

/// A picture of floats as a TIFF.
MapBytes tiff_bytes(const OIIO::ImageSpec& spec, const std::vector<float>& pixels);

}  // namespace trapeze
