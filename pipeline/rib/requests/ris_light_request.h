/// Lights of the path tracer (RIS) as requests name them: Light, and AreaLightSource with such a name.
#pragma once

#include <string>

#include "pipeline/rib/reader/request_context.h"
#include "pipeline/rib/ris/ris_parameters.h"

namespace trapeze::rib {

/// Adds the light to the world, or to the object that is being defined; Attribute "lighting" "mute" turns it
/// off. `is_area_light`: AreaLightSource asks for it.
void add_ris_light(LightContext& context, const std::string& handle, const ShaderInstance& shader,
                   const RisParameters& parameters, bool is_area_light);

/// How many samples area lights take: Attribute "light" "nsamples" or "samples".
int light_samples(const LightContext& context);

}  // namespace trapeze::rib
