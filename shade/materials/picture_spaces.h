/// Spaces of the picture (RISpec table 4.1): screen, NDC and raster.
#pragma once

#include <optional>
#include <string_view>

#include "core/math.h"
#include "core/scene/camera.h"

namespace trapeze {

/// The matrix (row vectors) that takes points of "screen", "NDC" or "raster" to camera space; nothing for
/// another name. Depth is from 0 at the near plane to 1 at the far one. That of a perspective camera divides.
std::optional<M44d> camera_from_picture(const Camera& camera, std::string_view space);

}  // namespace trapeze
