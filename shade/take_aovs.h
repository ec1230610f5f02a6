/// Output variables (core/aov.h) from a grid's shaders into the grid.
#pragma once

#include <span>

#include "core/aov.h"
#include "core/shading_grid.h"
#include "shade/vm/frame.h"

namespace trapeze {

class Materials;
class Diagnostics;

/// Fills ShadingGrid::aovs of grids that lie side by side in the lanes of `surface`, the frame of their
/// surface shader after its run. To be called when all shaders have run. A variable is
/// - Ci or Oi: the grid's own, as the picture has them;
/// - else a parameter of the surface shader, or one of its predefined variables, of as many numbers;
/// - else what the grid itself has: P, N, Ng, dPdu, dPdv, Cs, Os, u, v, s and t;
/// - else 0.
/// Points, vectors and normals are in camera space.
void take_aovs(const AovLayout& layout, const vm::Frame& surface, std::span<ShadingGrid* const> grids);

/// Warns, once for each, of variables that no grid has and no surface shader of the scene provides.
void report_missing_aovs(const AovLayout& layout, const Materials& materials, const Options& options,
                         Diagnostics& diagnostics);

}  // namespace trapeze
