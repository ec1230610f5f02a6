/// Which options, attributes and parameters anything looks at. The others are kept, as RISpec asks, and
/// shaders may read them; `trapeze check` lists them.
#pragma once

#include <string_view>

namespace trapeze::rib {

bool option_has_effect(std::string_view category, std::string_view name);
bool attribute_has_effect(std::string_view category, std::string_view name);
bool hider_parameter_has_effect(std::string_view name);
bool display_parameter_has_effect(std::string_view name);

}  // namespace trapeze::rib
