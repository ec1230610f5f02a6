#include "shade/materials/attribute_values.h"

namespace trapeze {
namespace {

NamedValue one(float number) {
    return {{number}, {}};
}
NamedValue three(const V3f& v) {
    return {{v.x, v.y, v.z}, {}};
}

/// What requests of their own set, some of it under "Ri:" too.
std::optional<NamedValue> find_own(const Attributes& a, std::string_view name) {
    if (name == "ShadingRate" || name == "Ri:ShadingRate") return one(a.shading_rate);
    if (name == "Sides" || name == "Ri:Sides") return one(static_cast<float>(a.sides));
    if (name == "Matte" || name == "Ri:Matte") return one(static_cast<float>(a.matte));
    if (name == "Ri:Color") return three(a.color);
    if (name == "Ri:Opacity") return three(a.opacity);
    if (name == "identifier:name") return NamedValue{{}, a.name};
    return {};
}

NamedValue text_of(RayAttributes::HitMode mode) {
    return {{}, mode == RayAttributes::HitMode::Shader ? "shader" : "primitive"};
}

/// What holds of attributes of rays that no request has set.
std::optional<NamedValue> find_of_rays(const Attributes& a, std::string_view name) {
    const RayAttributes& rays = a.rays;
    const auto number = [](auto value) { return one(static_cast<float>(value)); };
    if (name == "visibility:camera") return number(a.visible_to_camera);
    if (name == "visibility:diffuse") return number(rays.diffuse);
    if (name == "visibility:specular") return number(rays.specular);
    if (name == "visibility:transmission") return number(rays.transmission);
    if (name == "trace:bias") return number(rays.bias);
    if (name == "trace:displacements") return number(rays.displaced);
    if (name == "trace:maxdiffusedepth") return number(rays.max_diffuse);
    if (name == "trace:maxspeculardepth") return number(rays.max_specular);
    if (name == "trace:samplemotion") return number(rays.sample_motion);
    if (name == "shade:transmissionhitmode") return text_of(rays.transmission_hits);
    if (name == "shade:specularhitmode") return text_of(rays.specular_hits);
    if (name == "shade:diffusehitmode" && rays.diffuse_hits) return text_of(*rays.diffuse_hits);
    return {};
}

}  // namespace

const Parameter* find_user_value(const std::map<std::string, ParameterList>& lists, std::string_view name) {
    const size_t colon = name.find(':');
    const std::string category(colon == std::string_view::npos ? "user" : name.substr(0, colon));
    const auto list = lists.find(category);
    if (list == lists.end()) return nullptr;
    return list->second.find(colon == std::string_view::npos ? name : name.substr(colon + 1));
}

std::optional<NamedValue> find_attribute_value(const Attributes& attributes, std::string_view name) {
    if (std::optional<NamedValue> own = find_own(attributes, name)) return own;
    const Parameter* user = find_user_value(attributes.user.lists(), name);
    if (!user) return find_of_rays(attributes, name);
    if (!user->strings.empty()) return NamedValue{{}, user->strings.front()};
    return NamedValue{user->floats, {}};
}

}  // namespace trapeze
