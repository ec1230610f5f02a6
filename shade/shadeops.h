/// The shading language's built-in functions that gather light, over whole grids (RISpec section 15.6).
///
/// Lights count when their direction is within a right angle of N, as illuminance(P, N, PI/2) sees them; turn
/// N to the viewer first, with facing_normal. RISpec leaves specular()'s formula to the renderer and gives
/// max(0, N.H)^(1/roughness) for it, with H halfway between L and V; that is what is used.
#pragma once

#include "shade/shader.h"

namespace trapeze::shadeops {

Plane3 ambient(Illumination& lights);
Plane3 diffuse(Illumination& lights, ConstPlane3 N);
Plane3 specular(Illumination& lights, ConstPlane3 N, ConstPlane3 V, ConstPlane roughness);

/// faceforward(normalize(N), I).
Plane3 facing_normal(ShaderInput& input);
/// V = -normalize(I).
Plane3 toward_viewer(ShaderInput& input);

}  // namespace trapeze::shadeops
