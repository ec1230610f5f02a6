/// Answers to what gather() asks of the places that its rays hit.
#pragma once

#include <span>

#include "shade/rays/hit_outputs.h"
#include "shade/shader_variables.h"

namespace trapeze {

/// Sets ShadingGrid::answers of grids that lie side by side in the lanes of their shaders' registers, after
/// these have run; none of them where they have not. What there is nowhere is left out.
/// - Surface: as take_aovs() finds it.
/// - Displacement, Volume: any variable of the last layer that has it.
/// - Primitive: what the grid itself has (P, N, s, Cs...), and the primitive's variables.
/// - Attribute: by its name.
void answer_hits(const HitOutputs& outputs, LayerRegisters surface, LayerRegisters displacement,
                 LayerRegisters atmosphere, std::span<ShadingGrid* const> grids);

}  // namespace trapeze
