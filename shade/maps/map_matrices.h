/// The matrices that say where a depth map was seen from, in a file's metadata.
#pragma once

#include <OpenImageIO/imageio.h>

#include <optional>

#include "core/math.h"

namespace trapeze {

struct MapMatrices {
    M44f camera_from_world, screen_from_world;  ///< screen: -1..1 across the picture and up it
};

/// RenderMan's worldtocamera and worldtoscreen, or OpenEXR's worldToCamera and worldToNDC.
std::optional<MapMatrices> map_matrices(const OIIO::ImageSpec& spec);

}  // namespace trapeze
