#include "pipeline/rib/state/attribute_values.h"

#include <algorithm>
#include <cmath>

#include "pipeline/rib/state/ray_attributes.h"

namespace trapeze::rib {
namespace {

/// Older files say in words what newer ones say by numbers.
bool is_on(std::string_view text) {
    return text != "0" && text != "off" && text != "no" && text != "false" && text != "invisible" &&
           text != "transparent";
}

/// Attribute "dice": see Attributes::Dice.
void set_dice(Attributes::Dice& dice, std::string_view name, float value) {
    if (name == "binary") dice.binary = value != 0;
    if (name == "rasterorient") dice.raster_oriented = value != 0;
    if (name == "minlength") dice.min_length = std::max(value, 0.0f);
}

/// States share values until one of them changes any: what is there already changes none.
void keep(std::string_view category, const Parameter& value, UserValues& user) {
    const Parameter* const old = user.find(category, value.name);
    if (!old || old->floats != value.floats || old->strings != value.strings ||
        old->declaration != value.declaration)
        user.set(category, value);
}

/// The value among those of Attribute "light" that says whether a light is off.
std::string switch_name(const LightInstance& light) {
    return "off " + light.handle;
}

}  // namespace

void set_attribute_value(std::string_view category, const Parameter& value, AttributeState& state) {
    Attributes& a = state.attributes;
    keep(category, value, a.user);
    const float number = value.floats.empty() ? 0 : value.floats[0];
    const std::string_view name = value.name,
                           text = value.strings.empty() ? std::string_view() : value.strings[0];
    if (category == "displacementbound" && name == "sphere")
        state.displacement_bound.sphere = std::abs(number);
    if (category == "bound" && name == "displacement")  // before RISpec 3.1
        state.displacement_bound = {std::abs(number), "object"};
    if (category == "displacementbound" && name == "coordinatesystem")
        state.displacement_bound.coordinate_system = text;
    if (category == "visibility" && name == "camera")
        a.visible_to_camera = value.is_string() ? is_on(text) : number != 0;
    // BMRT's: a bit for the camera, one for reflections, one for shadows.
    if (category == "render" && name == "visibility" && !value.floats.empty())
        a.visible_to_camera = (static_cast<int>(std::clamp(number, 0.0f, 7.0f)) & 1) != 0;
    set_ray_attribute(category, value, a.rays);
    if (category == "cull" && name == "hidden") a.cull_hidden = number != 0;
    if (category == "dice") set_dice(a.dice, name, number);
    if (const std::optional<float> rate = shading_rate_of(category, value)) a.shading_rate = *rate;
}

std::optional<float> shading_rate_of(std::string_view category, const Parameter& value) {
    if (category != "dice" || std::string_view(value.name) != "micropolygonlength") return {};
    if (value.floats.empty() || !(value.floats[0] > 0)) return {};
    return value.floats[0] * value.floats[0];
}

void switch_light(const std::shared_ptr<const LightInstance>& light, bool on, Attributes& attributes) {
    auto& lights = attributes.lights;
    const auto place = std::find(lights.begin(), lights.end(), light);
    if (on && place == lights.end()) lights.push_back(light);
    if (!on && place != lights.end()) lights.erase(place);
    if (on == is_switched_off(*light, attributes))
        attributes.user.set(
            "light",
            {switch_name(*light), {StorageClass::Uniform, ValueType::Float, 1}, {on ? 0.0f : 1.0f}, {}});
}

bool is_switched_off(const LightInstance& light, const Attributes& attributes) {
    return attributes.user.float_or("light", switch_name(light), 0) != 0;
}

}  // namespace trapeze::rib
