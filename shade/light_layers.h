/// Output variables "lightgroup:NAME": what the lights of a group alone add to Ci, before the atmosphere.
/// What is seen without any light is the variable "lightgroup:unlit"; for shaders that add up their lights
/// all of them together are Ci.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "core/scene/aov.h"
#include "shade/materials/light_rig.h"

namespace trapeze {

/// The group whose light a variable asks for; nothing for other variables.
std::optional<std::string_view> light_group_asked(const Aov& aov);
bool asks_light_groups(const AovLayout& layout);

/// Those of some lights that are of a group.
std::vector<const Lamp*> lamps_of_group(const std::vector<const Lamp*>& lamps, std::string_view group);

}  // namespace trapeze
