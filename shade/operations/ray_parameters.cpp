#include "shade/operations/ray_parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace trapeze::rsl {
namespace {

using Is = RayArgumentValue::Is;

enum class Takes : uint8_t { Number, Color, Text };

struct RayParameter {
    std::string_view name;
    Takes takes;
    std::array<std::string_view, 3> words{};  ///< the texts that mean something; none: any
};

/// What rays are told (docs/rays.md, docs/point_clouds.md).
constexpr RayParameter kKnown[] = {
    {"samples", Takes::Number},
    {"samplecone", Takes::Number},
    {"coneangle", Takes::Number},
    {"distribution", Takes::Text, {"cosine", "uniform"}},
    {"hitsides", Takes::Text, {"front", "back", "both"}},
    {"subset", Takes::Text},
    {"hitmode", Takes::Text, {"shader", "primitive", "default"}},
    {"label", Takes::Text},
    {"samplebase", Takes::Number},
    {"environmentmap", Takes::Text},
    {"environmentspace", Takes::Text},
    {"bias", Takes::Number},
    {"maxdist", Takes::Number},
    {"falloff", Takes::Number},
    {"falloffmode", Takes::Number},
    {"othreshold", Takes::Color},
    {"pointbased", Takes::Number},
    {"filename", Takes::Text},
    {"coordsystem", Takes::Text},
    {"maxsolidangle", Takes::Number},
    {"clamp", Takes::Number},
};
/// What calls set; the analysis knows which do.
constexpr std::string_view kSet[] = {"environmentcolor", "environmentdir", "occlusion"};
/// Of PRMan's shaders: taken, and nothing changes. Most are about how results are interpolated between
/// points.
constexpr std::string_view kOverlooked[] = {
    "adaptive",     "attenuation",  "brightness",   "cosinespread",   "excludesubset", "maxerror", "maxhits",
    "maxpixeldist", "maxvariation", "minsamples",   "occlusionscale", "radiosity",     "raytype",  "sides",
    "sortbleeding", "surfaceblur",  "surfacecolor", "transmission",   "volume",        "weight",   "hitdist"};
/// What calls with a map are told; with rays nothing changes.
constexpr std::string_view kOfMaps[] = {"blur", "sblur", "tblur", "width", "swidth", "twidth",    "filter",
                                        "fill", "wrap",  "swrap", "twrap", "lerp",   "colorspace"};

constexpr std::string_view kIs[] = {"float", "triple of floats", "string", "matrix or an array"};
constexpr std::string_view kTakes[] = {"float", "color", "string"};

template <class List>
bool has(const List& list, std::string_view name) {
    return std::ranges::find(list, name) != std::end(list);
}

bool takes(const RayParameter& parameter, Is is) {
    if (is == Is::Text || parameter.takes == Takes::Text)
        return is == Is::Text && parameter.takes == Takes::Text;
    return is == Is::Number || (is == Is::Triple && parameter.takes == Takes::Color);
}

std::string listed(const std::string& text, std::string_view name) {
    return fmt::format("{}{}\"{}\"", text, text.empty() ? "" : ", ", name);
}

}  // namespace

std::string ray_argument_problem(std::string_view call, std::string_view name, const RayArgumentValue& value,
                                 bool of_map) {
    if (has(kSet, name) || has(kOverlooked, name) || (of_map && has(kOfMaps, name))) return {};
    std::string names;
    const auto* const known = std::ranges::find(kKnown, name, &RayParameter::name);
    if (known == std::end(kKnown)) {
        for (const RayParameter& parameter : kKnown) names = listed(names, parameter.name);
        return fmt::format("{}() knows no \"{}\", which changes nothing; rays know {}", call, name, names);
    }
    if (!takes(*known, value.is))
        return fmt::format("\"{}\" of {}() takes a {}, not a {}: it changes nothing", name, call,
                           kTakes[static_cast<size_t>(known->takes)], kIs[static_cast<size_t>(value.is)]);
    if (known->words[0].empty() || !value.text || value.text->empty() || has(known->words, *value.text))
        return {};
    for (const std::string_view word : known->words)
        if (!word.empty()) names = listed(names, word);
    return fmt::format("\"{}\" of {}() knows {}, not \"{}\"", name, call, names, *value.text);
}

std::string ray_argument_warning(uint32_t source, uint32_t line, uint32_t column, std::string_view name) {
    return fmt::format("rsl-ray-argument {}:{}:{} {}", source, line, column, name);
}

}  // namespace trapeze::rsl
