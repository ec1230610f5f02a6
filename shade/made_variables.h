/// Output variables that no shader has to provide: what compositing and denoising programs ask for.
///
/// - albedo, a colour: the surface's colour without light, Cs Os. A shader that makes its colour of textures
/// has an
///   output parameter of this name, which comes first.
/// - motion, a vector: how far the vertex is seen to move while the shutter is open, from where it is as it
/// opens
///   to where it is as it closes: pixels to the right, pixels up, and camera-space depth. Behind the lens 0.
#pragma once

#include "core/scene/aov.h"
#include "core/scene/camera.h"
#include "core/scene/shading_grid.h"

namespace trapeze {

bool is_made_variable(const Aov& aov);

/// Fills the variable's planes in ShadingGrid::aovs.
void make_variable(const Aov& aov, const Camera& camera, ShadingGrid& grid);

}  // namespace trapeze
