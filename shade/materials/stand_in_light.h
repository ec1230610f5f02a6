/// What shines where a light's shader is not found.
#pragma once

#include "core/scene/scene.h"

namespace trapeze {

/// A standard light in place of one whose shader there is not, so that the picture is not black. Its kind is
/// told by the name ("ambient", "distant", "spot"...) and by the parameters given (a cone's angle; from and
/// to); intensity, lightcolor, from, to, the cone and the shadow map are taken over. How it fades is told by
/// a parameter for that (decay, falloff...), or else by the intensity: large ones are made to be divided by
/// squared distances. Angles above pi are whole cones in degrees.
ShaderInstance stand_in_light(const ShaderInstance& missing);

}  // namespace trapeze
