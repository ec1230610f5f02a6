#include "shade/operations/ray_parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

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
    {"minsamples", Takes::Number},
    {"samplecone", Takes::Number},
    {"coneangle", Takes::Number},
    {"distribution", Takes::Text, {"cosine", "uniform"}},
    {"hitsides", Takes::Text, {"front", "back", "both"}},
    {"subset", Takes::Text},
    {"excludesubset", Takes::Text},
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
/// What occlusion() and indirectdiffuse() set.
constexpr std::string_view kSet[] = {"environmentcolor", "environmentdir", "hitdist", "occlusion"};
/// Of PRMan's shaders: how far fewer rays may do, and how far results may be interpolated from points nearby.
/// Every point sends all of its rays, and nearer surfaces always hide farther ones, so that results are at
/// least as good as these ask for.
constexpr std::string_view kHints[] = {"adaptive", "maxerror", "maxpixeldist", "maxvariation",
                                       "sortbleeding"};
/// Of PRMan's shaders: they would change the picture, but nothing is made of them.
constexpr std::string_view kWithoutEffect[] = {
    "attenuation", "brightness",  "cosinespread", "maxhits",      "occlusionscale", "radiosity", "raytype",
    "sides",       "surfaceblur", "surfacecolor", "transmission", "volume",         "weight"};
/// What calls with a map are told of how it is filtered; rays have no map.
constexpr std::string_view kOfMaps[] = {"width", "swidth", "twidth", "filter", "fill",
                                        "wrap",  "swrap",  "twrap",  "lerp",   "colorspace"};
/// Likewise; but who asks for it wants something blurred.
constexpr std::string_view kBlurs[] = {"blur", "sblur", "tblur"};

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

std::optional<SentName> sent_name(std::string_view text) {
    static constexpr std::pair<std::string_view, HitShader> kPrefixes[] = {
        {"send:surface:", HitShader::Surface},
        {"send:displacement:", HitShader::Displacement},
        {"send:volume:", HitShader::Volume},
        {"send:atmosphere:", HitShader::Volume}};
    for (const auto& [prefix, to] : kPrefixes)
        if (text.starts_with(prefix)) return SentName{to, text.substr(prefix.size())};
    return {};
}

std::string ray_argument_problem(std::string_view call, std::string_view name, const RayArgumentValue& value,
                                 bool of_map) {
    if (const std::optional<SentName> sent = sent_name(name); sent && call == "gather")
        return sent->name.empty() ? fmt::format("\"{}\" of gather() names no parameter", name) : "";
    const bool over_sky = call == "occlusion" || call == "indirectdiffuse";
    if (has(kHints, name) || (over_sky && has(kSet, name)) || (of_map && has(kOfMaps, name))) return {};
    if (has(kSet, name) || has(kWithoutEffect, name))
        return fmt::format("\"{}\" of {}() has no effect", name, call);
    if (of_map && has(kBlurs, name)) {
        if (value.number == 0.0f) return {};
        return fmt::format("\"{}\" of {}() has no effect on rays, which \"samplecone\" spreads", name, call);
    }
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
