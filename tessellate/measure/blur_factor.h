/// GeometricApproximation "motionfactor" and "focusfactor": what is blurred may be diced more coarsely.
#pragma once

#include "core/scene/camera.h"
#include "tessellate/measure/screen_metric.h"
#include "tessellate/topology/placed_surface.h"

namespace trapeze {

/// What the primitive's shading rate is multiplied by: 1 + the larger of motion factor times the pixels that
/// it moves while the shutter is open, and focus factor times the width of its blur in pixels, over 16; by
/// the part of it that is blurred least, so that no sharp part is coarse. 1 when both factors are 0. The
/// scale is PRMan's: a factor of 1 takes 16 pixels of blur as a grid's side.
float blur_factor(const PlacedSurface& surface, const Camera& camera, const ScreenMetric& metric);

}  // namespace trapeze
