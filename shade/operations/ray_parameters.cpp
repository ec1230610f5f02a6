#include "shade/operations/ray_parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace trapeze::rsl {
namespace {

using Is = RayArgumentValue::Is;

enum class Takes : uint8_t { Number, Color, Text };

/// Calls, as bits.
enum Call : uint8_t {
    kTrace = 1,
    kTransmission = 2,
    kOcclusion = 4,
    kIndirectDiffuse = 8,
    kEnvironment = 16,
    kShadow = 32,
    kGather = 64,
};
constexpr uint8_t kAll = 127;
constexpr uint8_t kOverSky = kOcclusion | kIndirectDiffuse;
/// Those whose rays go about one direction, unless they are spread.
constexpr uint8_t kOneWay = kTrace | kTransmission | kEnvironment | kShadow;
/// Those that tell what is behind everything.
constexpr uint8_t kSeeSky = kOverSky | kTrace | kEnvironment;

constexpr std::pair<std::string_view, Call> kCalls[] = {
    {"trace", kTrace},
    {"transmission", kTransmission},
    {"occlusion", kOcclusion},
    {"indirectdiffuse", kIndirectDiffuse},
    {"environment", kEnvironment},
    {"shadow", kShadow},
    {"gather", kGather},
};

struct RayParameter {
    std::string_view name;
    Takes takes;
    uint8_t calls;                            ///< that heed it
    std::array<std::string_view, 3> words{};  ///< the texts that mean something; none: any
};

/// What rays are told (docs/rays.md, docs/point_clouds.md).
constexpr RayParameter kKnown[] = {
    {"samples", Takes::Number, kAll},
    {"minsamples", Takes::Number, kAll},
    {"samplecone", Takes::Number, kOneWay},
    {"blur", Takes::Number, kOneWay},
    {"coneangle", Takes::Number, kOverSky | kGather},
    {"distribution", Takes::Text, kOverSky | kGather, {"cosine", "uniform"}},
    {"hitsides", Takes::Text, kAll, {"front", "back", "both"}},
    {"subset", Takes::Text, kAll},
    {"excludesubset", Takes::Text, kAll},
    {"hitmode", Takes::Text, kAll, {"shader", "primitive", "default"}},
    {"label", Takes::Text, kAll},
    {"samplebase", Takes::Number, kAll},
    {"environmentmap", Takes::Text, kSeeSky},
    {"environmentspace", Takes::Text, kSeeSky},
    {"bias", Takes::Number, kAll},
    {"maxdist", Takes::Number, kAll},
    {"falloff", Takes::Number, kOverSky},
    {"falloffmode", Takes::Number, kOverSky},
    {"othreshold", Takes::Color, kAll},
    {"pointbased", Takes::Number, kOverSky},
    {"filename", Takes::Text, kOverSky},
    {"coordsystem", Takes::Text, kOverSky},
    {"maxsolidangle", Takes::Number, kOverSky},
    {"clamp", Takes::Number, kOverSky},
};
/// What calls set, and which.
constexpr std::pair<std::string_view, uint8_t> kSet[] = {{"environmentcolor", kOverSky},
                                                         {"environmentdir", kOverSky},
                                                         {"hitdist", kOverSky | kTrace},
                                                         {"occlusion", kOverSky},
                                                         {"transmission", kTrace}};
/// Of PRMan's shaders: how far fewer rays may do, and how far results may be interpolated from points nearby.
/// Every point sends all of its rays, and nearer surfaces always hide farther ones, so that results are at
/// least as good as these ask for.
constexpr std::string_view kHints[] = {"adaptive", "maxerror", "maxpixeldist", "maxvariation",
                                       "sortbleeding"};
/// Of PRMan's shaders: they would change the picture, but nothing is made of them.
constexpr std::string_view kWithoutEffect[] = {"attenuation",    "brightness",   "cosinespread", "maxhits",
                                               "occlusionscale", "radiosity",    "raytype",      "sides",
                                               "surfaceblur",    "surfacecolor", "volume",       "weight"};
/// What calls with a map are told of how it is filtered; rays have no map.
constexpr std::string_view kOfMaps[] = {"width", "swidth", "twidth", "filter", "fill",
                                        "wrap",  "swrap",  "twrap",  "lerp",   "colorspace"};
/// Likewise; but who asks for it wants something blurred.
constexpr std::string_view kBlurs[] = {"sblur", "tblur"};

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
    const auto* const of = std::ranges::find(kCalls, call, &std::pair<std::string_view, Call>::first);
    const uint8_t bit = of == std::end(kCalls) ? kAll : static_cast<uint8_t>(of->second);
    const auto* const set = std::ranges::find(kSet, name, &std::pair<std::string_view, uint8_t>::first);
    const auto* const known = std::ranges::find(kKnown, name, &RayParameter::name);
    const bool sets = set != std::end(kSet), knows = known != std::end(kKnown);
    if (has(kHints, name) || (sets && (set->second & bit)) || (of_map && has(kOfMaps, name))) return {};
    if (sets || has(kWithoutEffect, name) || (knows && !(known->calls & bit)))
        return fmt::format("\"{}\" of {}() has no effect", name, call);
    if (of_map && has(kBlurs, name)) {
        if (value.number == 0.0f) return {};
        return fmt::format("\"{}\" of {}() has no effect on rays, which \"blur\" spreads", name, call);
    }
    std::string names;
    if (!knows) {
        for (const RayParameter& parameter : kKnown)
            if (parameter.calls & bit) names = listed(names, parameter.name);
        return fmt::format("{}() knows no \"{}\", which changes nothing; it knows {}", call, name, names);
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
