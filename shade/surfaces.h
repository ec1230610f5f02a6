/// RISpec's standard surface shaders (its appendix A.1), and null: constant, matte, plastic, metal,
/// shinymetal, paintedplastic, defaultsurface. All set Oi = Os and multiply Ci by it.
///
/// Where RISpec leaves room: defaultsurface looks at no lights and is lit from the eye by the square of the
/// cosine, as that of PRMan and Aqsis; shinymetal without an environment map is metal; null draws nothing
/// (Ci = Oi = 0).
#pragma once

#include <memory>

#include "shade/parameter_binder.h"
#include "shade/textures.h"

namespace trapeze {

/// Null when there is no standard surface of the instance's name. The textures must outlive the shader.
std::unique_ptr<SurfaceShader> make_standard_surface(const ParameterBinder& parameters, Textures& textures);

std::unique_ptr<SurfaceShader> make_default_surface(const ParameterBinder& parameters);

}  // namespace trapeze
