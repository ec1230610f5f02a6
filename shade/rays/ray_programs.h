/// What the frame must know of shaders before it traces rays for them.
#pragma once

#include "shade/materials/bound_shader.h"

namespace trapeze {

/// Whether the shader may trace rays, with the parameters that it has.
bool asks_for_rays(const BoundShader& shader);

/// Whether a surface shader makes another opacity than Os, which is the primitive's own.
bool changes_opacity(const rsl::Program& program);

}  // namespace trapeze
