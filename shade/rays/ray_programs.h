/// What the frame must know of shaders before it traces rays for them.
#pragma once

#include "shade/code/program.h"

namespace trapeze {

/// Whether the program may trace rays.
bool asks_for_rays(const rsl::Program& program);

/// Whether a surface shader makes another opacity than Os, which is the primitive's own.
bool changes_opacity(const rsl::Program& program);

}  // namespace trapeze
