/// Output variables (core/scene/aov.h) from a grid's shaders into the grid.
#pragma once

#include <span>

#include "core/scene/aov.h"
#include "core/scene/camera.h"
#include "core/scene/shading_grid.h"
#include "shade/vm/registers.h"

namespace trapeze {

class Materials;
class Diagnostics;

/// Fills ShadingGrid::aovs of grids that lie side by side in the lanes of the registers of their shaders,
/// after these have run: those of the surface, at least one, and of the displacement, each in the order of
/// its layers. A variable is
/// - Ci or Oi: the grid's own, as the picture has them;
/// - "lightgroup:NAME": left at 0 for GridRun to fill (light_layers.h);
/// - else an output parameter, of as many numbers, of the surface shader or, where that has none, of its
///   earlier layers, the displacement shader, and the layers of that;
/// - else another parameter of the surface shader, or one of its predefined variables;
/// - else what the grid itself has: P, N, Ng, dPdu, dPdv, Cs, Os, u, v, s and t; albedo, which is Cs Os, and
///   motion (made_variables.h);
/// - else 0.
/// Points, vectors and normals are in camera space.
void take_aovs(const AovLayout& layout, std::span<vm::Registers* const> surface,
               std::span<vm::Registers* const> displacement, const Camera& camera,
               std::span<ShadingGrid* const> grids);

/// Warns, once for each, of variables that no grid has and no shader of the scene's surfaces provides.
void report_missing_aovs(const AovLayout& layout, const Materials& materials, const Options& options,
                         Diagnostics& diagnostics);

}  // namespace trapeze
