/// Requests of PRMan's path tracer (RIS), which has other shaders than RSL: surfaces have the colours, or the
/// textures, that its Bxdfs and Patterns are told, and its lights shine without shadows.
#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "pipeline/rib/requests/request_table.h"
#include "pipeline/rib/requests/ris_light_request.h"
#include "pipeline/rib/ris/ris_lights.h"
#include "pipeline/rib/ris/ris_network.h"

namespace trapeze::rib {
namespace {

/// Counts a request of RIS, and warns of them once, whatever the scene has of it.
void note(LightContext& r) {
    r.report.count_unsupported();
    r.report.warn_once("RIS shading is not supported; Bxdfs are seen by their colours and textures", "ris");
}

/// Black is the default of the stand-in's colours: scenes stay small without it.
void set_color(ShaderInstance& shader, const char* name, const V3f& v) {
    if (v.x != 0 || v.y != 0 || v.z != 0) set_triple(shader, name, ValueType::Color, v);
}

/// The shader that shows a look; its colour is Cs. Both shaders are the renderer's own; parameters at their
/// defaults are left out.
void show(const RisLook& look, ShaderInstance& shader) {
    shader.name = look.is_constant ? "constant" : "rissurface";
    if (look.is_constant) return;
    set_color(shader, "specularcolor", look.specular);
    set_color(shader, "emission", look.emission);
    set_number(shader, "roughness", look.roughness);
    if (look.opacity < 1) set_number(shader, "opacity", look.opacity);
    if (look.texture.empty()) return;
    set_text(shader, "texturename", look.texture);
    if (!look.colorspace.empty()) set_text(shader, "colorspace", look.colorspace);
    set_number(shader, "scales", look.scale_s);
    set_number(shader, "scalet", look.scale_t);
}

/// Exporters describe a material once, and name it by its id alone on every object that has it. A Bxdf with
/// parameters besides the id defines it anew.
RisLook known_look(RisNetwork& network, const std::string& shader, const RisParameters& parameters) {
    const std::string id = parameters.text("__materialid");
    const auto known = network.materials.find(id);
    if (known != network.materials.end() && parameters.all().size() == 1) return known->second;
    RisLook look = look_of_bxdf(shader, parameters, network);
    if (!id.empty()) network.materials[id] = look;
    return look;
}

/// The colour goes into Color, as the stand-in's other arguments go into its parameters: a Color after it
/// would win, as in RSL.
void bxdf(LightContext& r, ArgumentCursor& c) {
    ShaderInstance surface = r.shader(c, "bxdf");
    const std::string handle = c.handle("the handle");
    const RisParameters parameters = RisParameters::read(c);
    RisNetwork& network = r.state.scope().ris;
    const RisLook look = network.bxdfs[handle] = known_look(network, surface.name, parameters);
    r.state.change_attributes(Own::Color);
    Attributes& a = changeable_attributes(r, Own::Surface);
    a.color = look.color.value_or(look.is_constant ? V3f(1, 1, 1) : V3f(0.5f, 0.5f, 0.5f));
    show(look, surface);
    a.surface = std::make_shared<const ShaderInstance>(std::move(surface));
    note(r);
}

/// Kept until the frame or world ends, for Bxdfs to follow.
void pattern(LightContext& r, ArgumentCursor& c) {
    RisPattern made;
    made.shader = c.string("the pattern's name");
    const std::string handle = c.handle("the handle");
    made.parameters = RisParameters::read(c);
    r.state.scope().ris.patterns[handle] = std::move(made);
    note(r);
}

/// Light "shader" "handle" parameters.
void light(LightContext& r, ArgumentCursor& c) {
    const ShaderInstance shader = r.shader(c, "light");
    const std::string handle = c.handle("the handle");
    add_ris_light(r, handle, shader, RisParameters::read(c), false);
}

/// What only a path tracer can use, read past whole.
void skip(LightContext& r, ArgumentCursor& c) {
    c.skip_rest();
    note(r);
}

/// What the scene asks of a light and it does not do.
void warn_of_what_is_ignored(RequestReport& report, const std::string& shader,
                             const RisParameters& parameters, const LightInstance& light) {
    if (shader.find("DayLight") != std::string::npos)
        report.warn_once(fmt::format("the sun and sky of {} are not known; it shines as a dome of one colour",
                                     in_quotes(shader)),
                         "ris-light-day");
    if (light.shape->kind != LightShape::Kind::Dome && !parameters.text("lightColorMap").empty())
        report.warn_once(
            fmt::format("only domes have a \"lightColorMap\": {} shines in one colour", in_quotes(shader)),
            "ris-light-map");
}

/// Structure, as far as motion blocks go: a Bxdf within one is carried out at once.
constexpr RequestRow kRisRequests[] = {
    {"Bxdf", bxdf},       {"Pattern", pattern}, {"Light", light},        {"LightFilter", skip},
    {"Integrator", skip}, {"Displace", skip},   {"DisplayFilter", skip}, {"SampleFilter", skip},
};

}  // namespace

/// A mesh light is handed on before its shape is known: the emitter in the attributes shares it, and fills it
/// in when the first primitive comes (SceneBuilder::place_emitter).
void add_ris_light(LightContext& r, const std::string& handle, const ShaderInstance& shader,
                   const RisParameters& parameters, bool is_area_light) {
    if (r.state.attributes().attributes.user.float_or("lighting", "mute", 0) != 0) return;
    const int samples = light_samples(r);
    if (is_mesh_light(shader.name, is_area_light)) {
        auto emitter = std::make_shared<Emitter>();
        emitter->light = mesh_light(handle, shader, parameters, samples);
        emitter->is_of_ris = true;
        r.add_world_light(emitter->light);
        r.state.change_attributes(Own::Emitter).emitter = std::move(emitter);
        return;
    }
    auto light = ris_light(handle, shader, parameters, samples);
    if (!light)
        return r.report.warn_once(
            fmt::format("no light {} of RIS is known; \"{}\" does not shine", in_quotes(shader.name), handle),
            "ris-light " + shader.name);
    warn_of_what_is_ignored(r.report, shader.name, parameters, *light);
    light->moving_space = r.state.moving_current();
    if (r.add_world_light(light)) r.add_light_surface(*light);
}

/// An attribute that is there and wrong is said, and the next name is tried.
int light_samples(const LightContext& r) {
    const auto& user = r.state.attributes().attributes.user;
    for (const char* name : {"nsamples", "samples"}) {
        if (!user.find("light", name)) continue;
        const float given = user.float_or("light", name, 0);
        if (given >= 1 && given <= LightShape::kMostSamples) return static_cast<int>(given);
        r.report.warn_once(fmt::format("Attribute \"light\" \"{}\" must be 1 to {}; {} are used", name,
                                       LightShape::kMostSamples, LightShape::kDefaultSamples),
                           "light-samples");
    }
    return LightShape::kDefaultSamples;
}

std::span<const RequestRow> ris_requests() {
    return kRisRequests;
}

}  // namespace trapeze::rib
