/// What the header of an OpenEXR file says, but for its channels.
#pragma once

#include <OpenEXR/ImfHeader.h>

#include "composite/displays/picture_to_write.h"

namespace trapeze {

/// Windows, camera, lens, shutter, colour, Cryptomatte's names and the scene's own attributes. The data
/// window is the crop, the display window the whole picture. Compressed as the plan says, else by `usual`.
Imf::Header make_exr_header(const PictureToWrite& picture, Imf::Compression usual);

}  // namespace trapeze
