/// Writes a picture with OpenEXR.
#pragma once

#include <string>

#include "composite/displays/picture_to_write.h"
#include "core/files/output_file.h"

namespace trapeze {

/// Opens, writes and commits `file`, of one part, with the channels of all displays of the file
/// (exr_channels.h). Returns what went wrong, or nothing. The data window is the crop, the display window the
/// whole picture.
std::string write_open_exr(const PictureToWrite& picture, OutputFile& file);

}  // namespace trapeze
