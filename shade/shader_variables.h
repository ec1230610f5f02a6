/// Variables of the shaders that have run on grids, and of the grids themselves, by name and width: what
/// Displays and gather() ask for.
#pragma once

#include <span>
#include <vector>

#include "core/scene/aov.h"
#include "core/scene/shading_grid.h"
#include "shade/vm/registers.h"

namespace trapeze {

/// Registers of the layers of a shader, in their order.
using LayerRegisters = std::span<vm::Registers* const>;

/// Whether grids have a variable by themselves.
bool grids_have(const Aov& aov);
/// A channel of a variable that the grid itself has; null for another variable.
const std::vector<float>* find_own_plane(const ShadingGrid& grid, const Aov& aov, int channel);

/// Whether a program has an output parameter, or any variable, of the name and of as many numbers.
bool has_output(const rsl::Program& program, const Aov& aov);
bool has_variable(const rsl::Program& program, const Aov& aov);

/// The register from which a variable is taken: of output parameters of the surface's layers, from the last
/// to the first, then of the displacement's, then of any variable of the surface. Null when no shader has it,
/// and for Ci and Oi, which the grid has.
const vm::Operand* find_shader_variable(const Aov& aov, LayerRegisters surface, LayerRegisters displacement);

}  // namespace trapeze
