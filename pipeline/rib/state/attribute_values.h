/// What Attribute and Illuminate do to a state: also to that of an instance, whose object they stand in.
#pragma once

#include <optional>
#include <string_view>

#include "pipeline/rib/state/graphics_state.h"

namespace trapeze::rib {

/// Keeps the value for shaders, and sets what it stands for. Values that nothing here knows are only kept;
/// "trimcurve" and "identifier" want more than a state, and are for the caller.
void set_attribute_value(std::string_view category, const Parameter& value, AttributeState& state);

/// The shading rate that a value stands for: the later RenderMan's "dice" "micropolygonlength", of a side in
/// pixels.
std::optional<float> shading_rate_of(std::string_view category, const Parameter& value);

/// Illuminate. The order of the list is that in which lights were switched on, and of their sums. Lights that
/// shine on the whole world come to it at the world's end: what is off is remembered.
void switch_light(const std::shared_ptr<const LightInstance>& light, bool on, Attributes& attributes);
/// Whether Illuminate has switched a light off.
bool is_switched_off(const LightInstance& light, const Attributes& attributes);

}  // namespace trapeze::rib
