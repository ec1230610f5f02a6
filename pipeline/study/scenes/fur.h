/// Hairs of a ball of radius 1 about the origin.
#pragma once

#include "pipeline/study/scenes/scene_parts.h"

namespace trapeze::scenes {

/// Writes `count` hairs from number `first` on as cubic Curves, a thousand in a request: of a color, some
/// lighter than others, and as thick as `width` at their roots.
void write_fur(RibWriter& rib, int first, int count, double width, const V3d& color);

}  // namespace trapeze::scenes
