#include "shade/material.h"

#include <fmt/format.h>

#include "shade/displacements.h"
#include "shade/lights.h"
#include "shade/surfaces.h"

namespace trapeze {

Materials::Materials(const RenderContext& context)
    : diagnostics_(context.diagnostics), textures_(context.scene->options, context.diagnostics) {
    default_instance_.name = "defaultsurface";
    std::unordered_map<const Attributes*, uint32_t> known;
    of_primitive_.reserve(context.scene->primitives.size());
    for (const Primitive& primitive : context.scene->primitives) {
        const auto [at, is_new] = known.try_emplace(primitive.attributes.get(), 0);
        if (is_new) at->second = static_cast<uint32_t>(add(*primitive.attributes));
        of_primitive_.push_back(at->second);
    }
}

size_t Materials::add(const Attributes& attributes) {
    Material& material = materials_.emplace_back();
    material.attributes = &attributes;
    material.surface = surface(attributes.surface.get());
    if (attributes.displacement) material.displacement = displacement(*attributes.displacement);
    for (const auto& instance : attributes.lights)
        if (const LightShader* shader = light(*instance)) material.lights.push_back(shader);
    return materials_.size() - 1;
}

const SurfaceShader* Materials::surface(const ShaderInstance* instance) {
    if (!instance) instance = &default_instance_;
    auto [at, is_new] = surfaces_.try_emplace(instance);
    if (!is_new) return at->second.get();
    const ParameterBinder parameters(*instance, diagnostics_);
    at->second = make_standard_surface(parameters, textures_);
    if (!at->second) {
        warn_unknown("Surface", *instance, "defaultsurface is used");
        at->second = make_default_surface(ParameterBinder(default_instance_, diagnostics_));
    }
    return at->second.get();
}

const DisplacementShader* Materials::displacement(const ShaderInstance& instance) {
    auto [at, is_new] = displacements_.try_emplace(&instance);
    if (!is_new) return at->second.get();
    at->second = make_standard_displacement(ParameterBinder(instance, diagnostics_));
    if (!at->second) warn_unknown("Displacement", instance, "nothing is displaced");
    return at->second.get();
}

const LightShader* Materials::light(const LightInstance& instance) {
    auto [at, is_new] = lights_.try_emplace(&instance);
    if (!is_new) return at->second.get();
    at->second = make_standard_light(ParameterBinder(instance.shader, diagnostics_));
    if (!at->second) warn_unknown("LightSource", instance.shader, "the light is left out");
    return at->second.get();
}

void Materials::warn_unknown(std::string_view kind, const ShaderInstance& instance,
                             std::string_view instead) {
    if (!diagnostics_) return;
    diagnostics_->warning(instance.location,
                          fmt::format("{}: there is no shader \"{}\"; {}", kind, instance.name, instead),
                          fmt::format("missing-shader {} {}", kind, instance.name));
}

}  // namespace trapeze
