/// Which options, attributes and parameters anything looks at. The others are kept, as RISpec asks, and
/// shaders may read them; `trapeze check` lists them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace trapeze::rib {

/// All of them, for people: "category name", or "category (all)"; sorted.
struct EffectiveSettings {
    std::vector<std::string> options, attributes, hider, display;
};
EffectiveSettings effective_settings();

bool option_has_effect(std::string_view category, std::string_view name);
bool attribute_has_effect(std::string_view category, std::string_view name);
bool hider_parameter_has_effect(std::string_view name);
bool display_parameter_has_effect(std::string_view name);

}  // namespace trapeze::rib
