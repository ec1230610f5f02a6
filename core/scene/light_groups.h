/// Groups of lights, of which pictures may have layers of their own.
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/scene.h"

namespace trapeze {

/// The parameter of a light that names its group; PRMan's lights call it lightGroup.
inline constexpr const char* kLightGroupParameter = "lightgroup";
/// The group of lights that name none, and what is seen without any light.
inline constexpr const char* kDefaultLightGroup = "default";
inline constexpr const char* kUnlitGroup = "unlit";
/// The output variable of a group is called so, and the group's name.
inline constexpr std::string_view kLightGroupPrefix = "lightgroup:";

/// The group of a light. An empty name is none, and so is that of what no light makes.
inline std::string light_group_of(const ShaderInstance& light) {
    const std::string group = light.parameters.string_or(kLightGroupParameter, "");
    return group.empty() || group == kUnlitGroup ? kDefaultLightGroup : group;
}

/// All groups of the lights that are switched on for a scene's primitives, in alphabetical order.
inline std::vector<std::string> light_groups(const Scene& scene) {
    std::set<const LightInstance*> lights;
    std::set<std::string> groups;
    for (const Primitive& primitive : scene.primitives)
        for (const auto& light : primitive.attributes->lights)
            if (lights.insert(light.get()).second) groups.insert(light_group_of(light->shader));
    return {groups.begin(), groups.end()};
}

}  // namespace trapeze
