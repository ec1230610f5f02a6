/// RISpec's standard light sources (its appendix A.2): ambientlight, distantlight, pointlight, spotlight.
#pragma once

#include <memory>

#include "shade/parameter_binder.h"

namespace trapeze {

/// Null when there is no standard light of the instance's name.
std::unique_ptr<LightShader> make_standard_light(const ParameterBinder& parameters);

}  // namespace trapeze
