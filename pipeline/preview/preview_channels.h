/// Which channels of a picture viewers see.
#pragma once

#include <string>
#include <vector>

#include "composite/image.h"
#include "core/scene/render_context.h"
#include "pipeline/preview/preview_picture.h"

namespace trapeze {

/// R G B A and Z of every picture, then the output variables of its Displays, each once, named as layers of
/// one OpenEXR file would be. Mattes, ids and deep samples are not seen.
std::vector<std::string> preview_channels(const Image& image, const RenderContext& context);

/// Where an image has these; it must stay where it is.
PixelSource preview_source(const Image& image, const RenderContext& context);

}  // namespace trapeze
