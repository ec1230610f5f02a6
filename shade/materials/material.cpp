#include "shade/materials/material.h"

#include <fmt/format.h>

#include <algorithm>

#include "shade/code/slice_code.h"
#include "shade/materials/grid_parts.h"
#include "shade/materials/grid_shader.h"
#include "shade/materials/sent_names.h"
#include "shade/materials/stand_in_light.h"
#include "shade/materials/unknown_parameters.h"

namespace trapeze {
namespace {

/// Names of the primitive's variables that differ from vertex to vertex: parameters of those names are
/// varying.
std::set<std::string> varying_variables(const Primitive& primitive) {
    std::set<std::string> names;
    if (primitive.shape_keys.empty()) return names;
    for (const Parameter& variable : primitive.shape().variables.values) {
        const StorageClass storage = variable.declaration.storage;
        if (storage != StorageClass::Constant && storage != StorageClass::Uniform)
            names.insert(variable.name);
    }
    return names;
}

}  // namespace

Materials::Materials(const RenderContext& context, const Access& access)
    : context_(context),
      diagnostics_(context.diagnostics),
      library_(context.scene->options, context.diagnostics, access) {
    default_instance_.name = "defaultsurface";
    std::map<std::pair<const Attributes*, Names>, uint32_t> known;
    of_primitive_.reserve(context.scene->primitives.size());
    for (const Primitive& primitive : context.scene->primitives) {
        Names varying = varying_variables(primitive);
        const auto [at, is_new] = known.try_emplace({primitive.attributes.get(), varying}, 0);
        if (is_new) {
            add(*primitive.attributes, varying);
            at->second = static_cast<uint32_t>(materials_.size() - 1);
        }
        of_primitive_.push_back(at->second);
    }
    for (const BoundShader& layer : layers_) add_sent_names(layer.program(), sent_names_);
    for (Lamp* lamp : lamp_order_) prepare_for_values(*lamp);
}

/// What is sent may differ from vertex to vertex, whatever a light's shader declares.
void Materials::prepare_for_values(Lamp& lamp) {
    const std::vector<rsl::ProgramParameter>& parameters = lamp.shader->program().parameters;
    if (std::ranges::none_of(parameters, [&](const auto& p) { return sent_names_.contains(p.name); })) return;
    const ShaderInstance& instance = lamp.shader->instance();
    auto executable = library_.find(instance.name, rsl::ShaderKind::Light, sent_names_, instance.location);
    if (executable)
        lamp.told = std::make_unique<BoundShader>(std::move(executable), instance, *lamp.spaces, nullptr);
}

void Materials::add(const Attributes& attributes, const Names& varying) {
    Material& material = materials_.emplace_back();
    material.attributes = &attributes;
    material.surface = surface(attributes.surface.get(), varying);
    if (attributes.displacement) {
        material.displacement = layered(*attributes.displacement, rsl::ShaderKind::Displacement, varying);
        if (!material.displacement)
            report_missing("Displacement", *attributes.displacement, "nothing is displaced");
    } else if (attributes.surface && material.surface->last().program().displaces) {
        // As where a surface moves P: without a bound it stays.
        if (attributes.displacement_bound > 0)
            material.displacement = layered(*attributes.surface, rsl::ShaderKind::Displacement, varying);
        else if (diagnostics_)
            diagnostics_->warning(attributes.surface->location,
                                  "\"" + attributes.surface->name +
                                      "\" displaces where Attribute \"displacementbound\" says how far: here "
                                      "it does not",
                                  "displacing-class " + attributes.surface->name);
    }
    material.atmosphere = volume("Atmosphere", attributes.atmosphere.get(), varying);
    // They run on other primitives, which do not have the variables of this one.
    material.interior = volume("Interior", attributes.interior.get(), {});
    material.exterior = volume("Exterior", attributes.exterior.get(), {});
    if (material.interior) material.interior_opacity = opacity_of(*material.interior);
    if (material.exterior) material.exterior_opacity = opacity_of(*material.exterior);
    const bool sets_P = std::ranges::any_of(material.surface->layers, [](const BoundShader* layer) {
        return writes_variable(layer->program(), "P");
    });
    // Without a bound the surface stays: many surface shaders use P as just another point.
    material.surface_moves = sets_P && attributes.displacement_bound > 0;
    if (!material.surface_moves) material.surface_opacity = opacity_of(*material.surface);
    material.surface_only_sets_P = sets_P && !material.surface_moves && !material.displacement;
    material.surface_asks_volume = material.surface->asks_volume();
    for (const LayeredShader* shader : {material.surface, material.displacement, material.atmosphere})
        material.asks_primitive |= shader && shader->asks_primitive();
    for (const auto& instance : attributes.lights)
        if (const Lamp* shining = lamp(*instance)) {
            material.lights.push_back(shining);
            material.asks_primitive |= shining->asks_variables;
            if (!shining->area) material.other_lights.push_back(shining);
        }
    material.shades_vertices_apart = shades_vertices_apart(material);
}

/// A volume shader, if any is named.
const LayeredShader* Materials::volume(const char* request, const ShaderInstance* instance,
                                       const Names& varying) {
    if (!instance) return nullptr;
    const LayeredShader* found = layered(*instance, rsl::ShaderKind::Volume, varying);
    if (!found) report_missing(request, *instance, "there is none");
    return found;
}

/// A shader with its layers. Null when there is no such shader, or it has errors. An earlier layer that is
/// not found is reported and left out.
const LayeredShader* Materials::layered(const ShaderInstance& instance, rsl::ShaderKind kind,
                                        const Names& varying) {
    const auto [at, is_new] = shaders_.try_emplace({&instance, kind, varying});
    if (!is_new) return at->second.layers.empty() ? nullptr : &at->second;
    std::vector<const BoundShader*> layers;
    for (const auto& earlier : instance.earlier_layers) {
        if (const BoundShader* layer =
                bound(*earlier, kind, varying, connected_parameters(instance, earlier->layer)))
            layers.push_back(layer);
        else
            report_missing("ShaderLayer", *earlier, "the layer is left out");
    }
    const BoundShader* last = bound(instance, kind, varying, connected_parameters(instance, instance.layer));
    if (!last) return nullptr;
    layers.push_back(last);
    at->second = make_layered(instance, std::move(layers), diagnostics_);
    return &at->second;
}

const BoundShader* Materials::bound(const ShaderInstance& instance, rsl::ShaderKind kind, Names varying,
                                    std::span<const std::string> connected) {
    varying.insert(connected.begin(), connected.end());
    auto executable = library_.find(instance.name, kind, varying, instance.location);
    if (!executable) return nullptr;
    if (diagnostics_) report_unknown_parameters(instance, executable->program(), *diagnostics_);
    const SceneSpaces spaces(*context_.scene, context_.camera, &instance, nullptr);
    return &layers_.emplace_back(std::move(executable), instance, spaces, diagnostics_);
}

const LayeredShader* Materials::surface(const ShaderInstance* instance, const Names& varying) {
    if (!instance) instance = &default_instance_;
    if (const LayeredShader* found = layered(*instance, rsl::ShaderKind::Surface, varying)) return found;
    report_missing("Surface", *instance, "defaultsurface is used");
    return layered(default_instance_, rsl::ShaderKind::Surface, varying);
}

size_t Materials::endless_count() const {
    return library_.endless_count() +
           static_cast<size_t>(std::ranges::count_if(opacities_, [](const auto& of) {
               return of.second && of.second->last().executable()->is_endless();
           }));
}

/// Lights that only colour what is seen need not shine on it, nor send the rays of their shadows.
const LayeredShader* Materials::opacity_of(const LayeredShader& shader) {
    const auto [at, is_new] = opacities_.try_emplace(&shader);
    std::optional<LayeredShader>& part = at->second;
    if (is_new && shader.layers.size() == 1) {
        const BoundShader& whole = shader.last();
        rsl::Program program = rsl::slice(whole.program(), "Oi");
        if (program.code.size() < whole.program().code.size()) {
            const SceneSpaces spaces(*context_.scene, context_.camera, &whole.instance(), nullptr);
            const BoundShader& bound =
                layers_.emplace_back(std::make_shared<const vm::Executable>(std::move(program)),
                                     whole.instance(), spaces, nullptr);
            part = make_layered(whole.instance(), {&bound}, nullptr);
        }
    }
    return part ? &*part : nullptr;
}

const Lamp* Materials::lamp(const LightInstance& instance) {
    const auto [at, is_new] = lamps_.try_emplace(&instance);
    if (!is_new) return at->second.get();
    const ShaderInstance* shader = &instance.shader;
    auto executable = library_.find(shader->name, rsl::ShaderKind::Light, {}, shader->location);
    if (!executable) {
        shader = &stand_ins_.emplace_back(stand_in_light(instance.shader));
        report_missing("LightSource", instance.shader, shader->name + " is used");
        executable = library_.find(shader->name, rsl::ShaderKind::Light, {}, shader->location);
        if (!executable) return nullptr;
    } else if (diagnostics_) {
        report_unknown_parameters(*shader, executable->program(), *diagnostics_);
    }
    const bool asks_place = executable->program().find_global("P") != nullptr;
    if (instance.shape && !asks_place) shader = in_the_middle(instance, *shader);
    auto made = std::make_unique<Lamp>();
    if (instance.shape && asks_place) made->area = &instance;
    made->spaces = std::make_unique<SceneSpaces>(*context_.scene, context_.camera, shader, nullptr);
    made->shader = std::make_unique<BoundShader>(std::move(executable), *shader, *made->spaces, diagnostics_);
    made->position = shader->camera_from_shader.translation();
    made->asks_surface = std::ranges::any_of(made->shader->program().code, [](const rsl::Instruction& i) {
        return i.op == rsl::Op::SurfaceMessage;
    });
    made->asks_variables = asks_variables(made->shader->program());
    const auto place = {"u", "v", "s", "t", "dPdu", "dPdv"};
    made->asks_place = made->area && std::ranges::any_of(place, [&](const char* name) {
                           return made->shader->program().find_global(name) != nullptr;
                       });
    at->second = std::move(made);
    lamp_order_.push_back(at->second.get());
    return at->second.get();
}

/// A light whose shader does not ask for points of a shape has one place: the middle of the first shape.
const ShaderInstance* Materials::in_the_middle(const LightInstance& instance, const ShaderInstance& shader) {
    if (diagnostics_)
        diagnostics_->warning(
            shader.location,
            fmt::format("AreaLightSource \"{}\": the shader does not look at P, points of the "
                        "light; it shines from the middle of its first shape",
                        shader.name),
            "area-light " + shader.name);
    ShaderInstance& moved = stand_ins_.emplace_back(shader);
    moved.camera_from_shader = instance.shape->camera_from_middle;
    return &moved;
}

std::vector<const BoundShader*> Materials::shaders() const {
    std::vector<const BoundShader*> all;
    for (const BoundShader& layer : layers_) all.push_back(&layer);
    std::set<const Lamp*> seen;
    for (const Material& material : materials_)
        for (const Lamp* lamp : material.lights)
            if (seen.insert(lamp).second) all.push_back(lamp->shader.get());
    return all;
}

void Materials::report_missing(std::string_view request, const ShaderInstance& instance,
                               std::string_view instead) {
    if (!diagnostics_) return;
    const std::string kind = fmt::format("missing-shader {} {}", request, instance.name);
    if (library_.has_said_why_not(instance.name))
        diagnostics_->note(instance.location, fmt::format("{} \"{}\": {}", request, instance.name, instead),
                           kind);
    else
        diagnostics_->error(instance.location,
                            fmt::format("{}: there is no shader \"{}\"; {}", request, instance.name, instead),
                            kind);
}

}  // namespace trapeze
