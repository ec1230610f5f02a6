/// Writes a picture with OpenImageIO: TIFF, PNG and other formats of whole numbers.
#pragma once

#include <string>

#include "composite/picture_to_write.h"
#include "core/output_file.h"

namespace trapeze {

/// Opens, writes and commits `file`. Returns what went wrong, or nothing.
///
/// RenderMan writes linear values where Exposure gives no gamma, which looks dark on every screen today. So
/// whole numbers are encoded by the sRGB curve when Exposure's gamma is 1 (values are then linear) and left
/// alone when it is not (then the user has encoded them). Floats stay as they are.
///
/// TIFF gets associated alpha, encoded as it is premultiplied: what is seen over black. PNG and the others
/// get unassociated alpha, as their formats say.
std::string write_image(const PictureToWrite& picture, OutputFile& file);

}  // namespace trapeze
