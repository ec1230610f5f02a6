/// Which options, attributes and parameters anything looks at. The others are kept, as RISpec asks, and
/// shaders may read them; `trapeze check` lists them.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace trapeze::rib {

/// All of them, for people: "category name", or "category (all)"; sorted.
struct EffectiveSettings {
    std::vector<std::string> options, attributes, hider, display;
};
EffectiveSettings effective_settings();

/// Attributes that say how to get what this renderer's pictures have in any case, or that save work it does
/// not do.
struct SettledSetting {
    std::string_view category, name, why;
};
std::span<const SettledSetting> settled_attributes();
/// Null for others.
const SettledSetting* settled_attribute(std::string_view category, std::string_view name);

bool option_has_effect(std::string_view category, std::string_view name);
bool attribute_has_effect(std::string_view category, std::string_view name);
bool hider_parameter_has_effect(std::string_view name);
bool display_parameter_has_effect(std::string_view name);

}  // namespace trapeze::rib
