/// Writes a picture with OpenEXR.
#pragma once

#include <string>

#include "composite/displays/picture_to_write.h"
#include "core/files/output_file.h"

namespace trapeze {

/// Opens, writes and commits `file`. Returns what went wrong, or nothing. Channels are R G B A in halves (or
/// floats), Z in floats, id in whole numbers; the data window is the crop, the display window the whole
/// picture.
std::string write_open_exr(const PictureToWrite& picture, OutputFile& file);

}  // namespace trapeze
