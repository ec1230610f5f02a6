/// Requests of PRMan's path tracer (RIS), which has other shaders than RSL: of them the colour of a surface
/// is taken, so that its geometry can be seen.
#include <algorithm>
#include <string_view>

#include "pipeline/rib/request_table.h"

namespace trapeze::rib {
namespace {

/// Parameters that hold what a surface looks like from afar, the better ones first.
constexpr std::string_view kColors[] = {"baseColor",         "diffuseColor", "emitColor", "frontColor",
                                        "diffuseFrontColor", "color",        "tint"};

std::string_view last_word(std::string_view token) {
    const size_t space = token.rfind(' ');
    return space == std::string_view::npos ? token : token.substr(space + 1);
}

/// The colour among a Bxdf's parameters; those that a Pattern computes have none.
std::optional<V3f> color_of(ArgumentCursor& c) {
    std::optional<V3f> color;
    size_t rank = std::size(kColors);
    while (!c.done()) {
        const std::string token = c.string("a parameter's name");
        if (c.done()) throw RequestError{in_quotes(token) + " has no value", {}};
        Argument value = c.take("a value");
        std::vector<float> numbers = value.take_numbers();
        while (value.kind == Argument::Kind::Number && c.next_is_number() && !c.next_is_array())
            numbers.push_back(c.number("a value"));
        const auto place = static_cast<size_t>(
            std::find(std::begin(kColors), std::end(kColors), last_word(token)) - std::begin(kColors));
        if (numbers.size() != 3 || place >= rank) continue;
        color = V3f(numbers[0], numbers[1], numbers[2]);
        rank = place;
    }
    return color;
}

void note(Reader& r) {
    r.count_unsupported();
    r.warn_once("RIS shading is not supported; geometry is drawn by defaultsurface, in the colours of Bxdfs",
                "ris");
}

void bxdf(Reader& r, ArgumentCursor& c) {
    ShaderInstance surface = r.shader(c, "bxdf");
    c.handle("the handle");
    const std::optional<V3f> color = color_of(c);
    const bool is_constant = surface.name == "PxrConstant" || surface.name == "PxrBlack";
    Attributes& a = r.change_attributes().attributes;
    if (color) a.color = *color;
    if (surface.name == "PxrBlack") a.color = V3f(0);
    surface.name = is_constant ? "constant" : "defaultsurface";
    a.surface = std::make_shared<const ShaderInstance>(std::move(surface));
    note(r);
}

void skip(Reader& r, ArgumentCursor& c) {
    while (!c.done()) c.take("");
    note(r);
}

constexpr RequestRow kRows[] = {
    {"Bxdf", bxdf},       {"Pattern", skip},  {"Light", skip},         {"LightFilter", skip},
    {"Integrator", skip}, {"Displace", skip}, {"DisplayFilter", skip}, {"SampleFilter", skip},
};

}  // namespace

std::span<const RequestRow> ris_requests() {
    return kRows;
}

}  // namespace trapeze::rib
