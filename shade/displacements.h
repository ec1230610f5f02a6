/// Displacement shaders that are there until the shading language brings its own. All move P along N by a
/// function of P in shader space, so that grids which share P and N stay joined; lengths are those of shader
/// space along x.
///
///     dented     amplitude * |noise|, summed over `octaves` octaves from `frequency` (per length) up,
///     inwards sinewaves  amplitude * (sin + sin + sin) / 3 of x, y, z times `frequency` (waves per length)
///     null       nothing
#pragma once

#include <memory>

#include "shade/parameter_binder.h"

namespace trapeze {

/// Null when there is no such shader.
std::unique_ptr<DisplacementShader> make_standard_displacement(const ParameterBinder& parameters);

}  // namespace trapeze
