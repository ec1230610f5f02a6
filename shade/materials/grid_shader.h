/// Runs a bound shader over grids: their values go into its predefined variables, and its results come back.
#pragma once

#include <span>

#include "core/scene/render_context.h"
#include "core/scene/shading_grid.h"
#include "shade/materials/bound_shader.h"
#include "shade/vm/footprint.h"

namespace trapeze {

/// The lanes of a run over grids side by side. `shared`: the grids are pieces of borders, whose random
/// numbers follow from their positions, so that all grids that share a piece shade it alike; else from a
/// grid's seed.
vm::Batch batch_of(std::span<const ShadingGrid* const> grids, bool shared = false);

/// Sets the predefined variables that the program names (RISpec 3.2, tables 12.1 to 12.5) from the grids,
/// whose footprints are given. Ci and Oi are the grids' own if `shaded`, else black and Os. Not `all`:
/// variables that the program sets before it looks at them are left undefined.
void set_variables(vm::Registers& registers, std::span<const ShadingGrid* const> grids,
                   const RenderContext& context, vm::Footprints& footprints, bool shaded, bool all = false);

/// The three planes of a triple in the registers, over all lanes; empty when the program does not name the
/// variable.
Plane3 variable_planes(const vm::Registers& registers, std::string_view name);

/// Whether the program has an instruction that sets the variable.
bool writes_variable(const rsl::Program& program, std::string_view name);

/// Copies Ci and Oi, where the program has them, into the grids; elsewhere they stay.
void take_colors(const vm::Registers& registers, std::span<ShadingGrid* const> grids);

}  // namespace trapeze
