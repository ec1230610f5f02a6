/// Writes a deep picture with OpenEXR.
#pragma once

#include <string>

#include "composite/displays/picture_to_write.h"
#include "core/files/output_file.h"

namespace trapeze {

/// Opens, writes and commits `file`: rows of samples, each pixel's from front to back, with R G B A
/// premultiplied and Z the depth of each in camera space; no ZBack, since all are of surfaces. Returns what
/// went wrong, or nothing.
std::string write_deep_exr(const PictureToWrite& picture, OutputFile& file);

}  // namespace trapeze
