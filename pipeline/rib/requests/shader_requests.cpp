/// RISpec 4.2: shaders, their layers, and lights.
#include <algorithm>

#include "pipeline/rib/requests/request_table.h"
#include "pipeline/rib/requests/ris_light_request.h"
#include "pipeline/rib/ris/ris_lights.h"
#include "pipeline/rib/state/attribute_values.h"

namespace trapeze::rib {
namespace {

/// Where Attributes keeps the shader of a kind.
using ShaderMember = std::shared_ptr<const ShaderInstance> Attributes::*;

/// The shader of a kind, for a request that sets it or adds to it.
std::shared_ptr<const ShaderInstance>& changeable_shader(LightContext& r, ShaderMember where) {
    Own what = Own::Exterior;
    if (where == &Attributes::surface) what = Own::Surface;
    if (where == &Attributes::displacement) what = Own::Displacement;
    if (where == &Attributes::atmosphere) what = Own::Atmosphere;
    if (where == &Attributes::interior) what = Own::Interior;
    return changeable_attributes(r, what).*where;
}

/// Surface, Displacement and the like: name parameters. Replaces the shader of its kind, with all of its
/// layers.
template <ShaderMember kWhere>
void shader(LightContext& r, ArgumentCursor& c, const char* kind) {
    auto instance = std::make_shared<ShaderInstance>(r.shader(c, kind));
    instance->parameters = r.shader_parameters(c);
    // Exporters write "null" for what does nothing; the surface of that name is a shader.
    const bool is_none =
        instance->name.empty() || (instance->name == "null" && kWhere != &Attributes::surface);
    changeable_shader(r, kWhere) = is_none ? nullptr : std::move(instance);
}

/// Where layers of the kind stand; `kind` is the word itself, for the summary.
ShaderMember layered_kind(ArgumentCursor& c, std::string& kind) {
    kind = c.string("the kind of shader");
    if (kind == "surface") return &Attributes::surface;
    if (kind == "displacement") return &Attributes::displacement;
    if (kind == "atmosphere" || kind == "volume") return &Attributes::atmosphere;
    throw RequestError{
        in_quotes(kind) + " shaders have no layers here (surface, displacement, atmosphere do)", {}};
}

/// ShaderLayer type name layer parameters: a layer after those there are, or in the place of one of its name.
/// The last layer's instance holds those before it, with the connections of all; the attributes keep the last
/// alone.
void shader_layer(LightContext& r, ArgumentCursor& c) {
    constexpr size_t kMostLayers = 64;
    std::string kind;
    const ShaderMember where = layered_kind(c, kind);
    auto instance = std::make_shared<ShaderInstance>(r.shader(c, kind.c_str()));
    instance->layer = c.string("the layer's name");
    instance->parameters = r.shader_parameters(c);
    std::shared_ptr<const ShaderInstance>& current = changeable_shader(r, where);
    // A shader that is no layer is replaced by the first.
    std::vector<std::shared_ptr<const ShaderInstance>> layers;
    if (current && !current->layer.empty()) {
        layers = current->earlier_layers;
        auto last = std::make_shared<ShaderInstance>(*current);
        instance->connections = std::move(last->connections);
        last->earlier_layers.clear(), last->connections.clear();
        layers.push_back(std::move(last));
        std::erase_if(layers, [&](const auto& layer) { return layer->layer == instance->layer; });
        if (layers.size() >= kMostLayers)
            throw RequestError{"more than " + std::to_string(kMostLayers) + " layers", {}};
    }
    instance->earlier_layers = std::move(layers);
    current = std::move(instance);
}

/// ConnectShaderLayers type layer variable layer variable. Whether there are such layers and variables is
/// found when the shaders are loaded.
void connect_shader_layers(LightContext& r, ArgumentCursor& c) {
    std::string kind;
    const ShaderMember where = layered_kind(c, kind);
    LayerConnection connection;
    connection.from_layer = c.string("the earlier layer");
    connection.from_variable = c.string("its variable");
    connection.to_layer = c.string("the later layer");
    connection.to_variable = c.string("its variable");
    std::shared_ptr<const ShaderInstance>& current = changeable_shader(r, where);
    if (!current || current->layer.empty()) throw RequestError{"there are no layers to connect", {}};
    // Instances are shared with states that were saved and primitives that were made: they are copied, not
    // changed.
    auto connected = std::make_shared<ShaderInstance>(*current);
    connected->connections.push_back(std::move(connection));
    current = std::move(connected);
}

/// Some files leave the handle out: what follows the name is a parameter then, and no handle with parameters.
bool has_handle(const ArgumentCursor& c) {
    const Argument *first = c.peek(), *second = c.peek(1);
    if (!first || !second || first->kind != Argument::Kind::String) return true;
    return second->kind == Argument::Kind::String;
}

/// Lights that come after Attribute "light" "shadows" "on" cast shadows, as BMRT has it, with rays: the
/// standard lights by their kin with maps, which take "raytrace" for one. Others have shaders of their own
/// for that.
void cast_shadows(LightContext& r, ShaderInstance& shader) {
    if (r.state.attributes().attributes.user.string_or("light", "shadows", "") != "on") return;
    const auto trace = [&](const char* name, std::initializer_list<const char*> maps) {
        shader.name = name;
        for (const char* const map : maps) {
            Parameter parameter;
            parameter.name = map, parameter.declaration.type = ValueType::String;
            parameter.strings = {"raytrace"};
            shader.parameters.set(std::move(parameter));
        }
    };
    if (shader.name == "distantlight") return trace("shadowdistant", {"shadowname"});
    if (shader.name == "spotlight") return trace("shadowspot", {"shadowname"});
    if (shader.name == "pointlight")
        return trace("shadowpoint", {"sfpx", "sfnx", "sfpy", "sfny", "sfpz", "sfnz"});
}

/// A light of RSL: its shader, then its handle, which is text here whether it was a number or not.
std::shared_ptr<LightInstance> light_of(LightContext& r, ArgumentCursor& c) {
    auto light = std::make_shared<LightInstance>();
    light->shader = r.shader(c, "light");
    if (has_handle(c))
        light->handle = c.handle("the handle");
    else
        r.report.warn_once("the light has no handle, and cannot be switched", "light-without-handle");
    light->shader.parameters = r.shader_parameters(c);
    cast_shadows(r, light->shader);
    return light;
}

/// The light shines from the primitives that follow, until the attributes end or another light begins
/// [decision 0030].
void area_light_source(LightContext& r, ArgumentCursor& c) {
    if (const Argument* name = c.peek(); name && name->is_text() && is_ris_light(name->strings[0])) {
        const ShaderInstance shader = r.shader(c, "light");
        const std::string handle = c.handle("the handle");
        return add_ris_light(r, handle, shader, RisParameters::read(c), true);
    }
    auto light = light_of(r, c);
    if (light->shader.name.empty() || light->shader.name == "null") {  // ends an area light
        r.state.change_attributes(Own::Emitter).emitter = nullptr;
        return;
    }
    light->shape.emplace();
    light->shape->samples = light_samples(r);
    light->shape->camera_from_middle = light->shader.camera_from_shader;
    auto emitter = std::make_shared<Emitter>();
    emitter->light = light;
    r.add_light(std::move(light));
    r.state.scope().emitters.push_back(emitter);
    r.state.change_attributes(Own::Emitter).emitter = std::move(emitter);
}

/// A light that was once named is no stray any more, on or off (SceneBuilder::add_strays).
void illuminate(LightContext& r, ArgumentCursor& c) {
    const std::string handle = c.handle("the light's handle");
    const bool on = c.done() || c.number("0 or 1") != 0;
    const auto light = r.light(handle);
    if (!light) throw RequestError{"no light " + in_quotes(handle), {}};
    std::erase_if(r.state.scope().emitters, [&](const auto& emitter) { return emitter->light == light; });
    AttributeState& state = r.state.change_attributes();
    switch_light(light, on, state.attributes);
    if (r.state.in_object()) state.own.switch_light(light, on);
}

/// Motion blocks hold all of these: shaders do not change while the shutter is open.
constexpr RequestRow kShaderRequests[] = {
    {"Surface", [](LightContext& r, ArgumentCursor& c) { shader<&Attributes::surface>(r, c, "surface"); }},
    {"Displacement",
     [](LightContext& r, ArgumentCursor& c) { shader<&Attributes::displacement>(r, c, "displacement"); }},
    {"Atmosphere",
     [](LightContext& r, ArgumentCursor& c) { shader<&Attributes::atmosphere>(r, c, "atmosphere"); }},
    {"Interior", [](LightContext& r, ArgumentCursor& c) { shader<&Attributes::interior>(r, c, "interior"); }},
    {"Exterior", [](LightContext& r, ArgumentCursor& c) { shader<&Attributes::exterior>(r, c, "exterior"); }},
    {"ShaderLayer", shader_layer},
    {"ConnectShaderLayers", connect_shader_layers},
    {"LightSource", [](LightContext& r, ArgumentCursor& c) { r.add_light(light_of(r, c)); }},
    {"AreaLightSource", area_light_source},
    {"Illuminate", illuminate},
};

}  // namespace

std::span<const RequestRow> shader_requests() {
    return kShaderRequests;
}

}  // namespace trapeze::rib
