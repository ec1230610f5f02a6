#include "shade/light_layers.h"

#include <algorithm>

#include "core/scene/light_groups.h"

namespace trapeze {

std::optional<std::string_view> light_group_asked(const Aov& aov) {
    const std::string_view name = aov.name;
    if (aov.channels != 3 || !name.starts_with(kLightGroupPrefix)) return {};
    return name.substr(kLightGroupPrefix.size());
}

bool asks_light_groups(const AovLayout& layout) {
    return std::ranges::any_of(layout.aovs,
                               [](const Aov& aov) { return light_group_asked(aov).has_value(); });
}

std::vector<const Lamp*> lamps_of_group(const std::vector<const Lamp*>& lamps, std::string_view group) {
    std::vector<const Lamp*> of_group;
    std::ranges::copy_if(lamps, std::back_inserter(of_group),
                         [&](const Lamp* lamp) { return light_group_of(lamp->shader->instance()) == group; });
    return of_group;
}

}  // namespace trapeze
