/// Writes a picture with OpenImageIO: TIFF, PNG and other formats of whole numbers.
#pragma once

#include <string>

#include "composite/displays/picture_to_write.h"
#include "core/files/output_file.h"

namespace trapeze {

/// Opens, writes and commits `file`. Returns what went wrong, or nothing.
///
/// Whole numbers are made as RISpec says, by Quantize from the values that Exposure leaves. Where the plan
/// asks for the sRGB curve, colours are first encoded by it, alpha is not; where the context has colour
/// management they are brought to its view instead. Floats stay as they are.
///
/// TIFF gets associated alpha, and is encoded as it is premultiplied: what is seen over black. PNG and the
/// others get unassociated alpha, as their formats say.
std::string write_image(const PictureToWrite& picture, OutputFile& file);

}  // namespace trapeze
