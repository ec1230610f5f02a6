/// The meshes of area lights [decision 0030]: triangles of the primitives that each shines from.
#pragma once

#include "core/scene/light_shape.h"
#include "core/scene/render_context.h"
#include "shade/shading.h"

namespace trapeze {

/// Dices the primitives of the lights that shading asks for, as they are at shutter open or, where they move
/// and rays have times of their own, in parts of the shutter, and hands it the triangles. How fine does not
/// depend on the camera: about 32 triangles along the longest side. Primitives that take more than
/// `most_bytes` are left out, with an error.
void make_light_meshes(const RenderContext& context, Shading& shading, size_t most_bytes);

}  // namespace trapeze
