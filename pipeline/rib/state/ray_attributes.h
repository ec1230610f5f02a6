/// What Attribute requests say of rays: "visibility", "trace" and "shade" as PRMan has them, and the older
/// forms of "visibility".
#pragma once

#include <string_view>

#include "core/scene/parameters.h"
#include "core/scene/scene.h"

namespace trapeze::rib {

/// Takes one value of an Attribute request, if it is about rays.
void set_ray_attribute(std::string_view category, const Parameter& value, RayAttributes& rays);

}  // namespace trapeze::rib
