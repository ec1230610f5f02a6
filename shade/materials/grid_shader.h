/// Runs a bound shader over grids: their values go into its predefined variables, and its results come back.
#pragma once

#include <span>

#include "core/scene/render_context.h"
#include "core/scene/shading_grid.h"
#include "shade/materials/bound_shader.h"
#include "shade/vm/footprint.h"

namespace trapeze {

/// The lanes of grids side by side. `shared`: they are pieces of borders, whose random numbers follow from
/// their places, and are the same in all grids that share them.
vm::Batch batch_of(std::span<const ShadingGrid* const> grids, bool shared = false);

/// Sets the predefined variables that the program names (RISpec 3.2, tables 12.1 to 12.5) from the grids,
/// whose footprints are given. Ci
/// and Oi are the grids' own if `shaded`, else Cs and Os. Not `all`: those that the program sets before it
/// looks at them are left undefined.
void set_variables(vm::Registers& registers, std::span<const ShadingGrid* const> grids,
                   const RenderContext& context, vm::Footprints& footprints, bool shaded, bool all = false);

/// A triple's planes in the registers; empty when the program does not name the variable.
Plane3 variable_planes(const vm::Registers& registers, std::string_view name);

/// Whether the program may set the variable.
bool writes_variable(const rsl::Program& program, std::string_view name);

/// Copies Ci and Oi, where the program has them, into the grids; elsewhere they stay.
void take_colors(const vm::Registers& registers, std::span<ShadingGrid* const> grids);

}  // namespace trapeze
