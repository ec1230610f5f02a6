/// A guess at how a Bxdf looks, from the parameters of the common ones. What it looks at are names, which the
/// shaders of one renderer share.
#include <algorithm>
#include <cmath>
#include <string_view>

#include "pipeline/rib/ris/ris_network.h"

namespace trapeze::rib {
namespace {

constexpr int kDeepestPattern = 8;  ///< of patterns that stand behind each other
/// Looked at for one colour: networks that branch at every pattern would have no end.
constexpr int kMostPatterns = 256;

/// Where nothing says what colour a surface has.
const V3f kGrey(0.5f, 0.5f, 0.5f);

/// A colour, or the picture that it comes from.
struct Tint {
    V3f color{1, 1, 1};
    std::string texture = {};
    float scale_s = 1, scale_t = 1;
    std::string colorspace = {};  ///< of texture()
};

/// The plain mean: it only has to be finite where the colour is.
float brightness(const V3f& c) {
    return (c.x + c.y + c.z) / 3;
}

/// "handle:output" without the output.
std::string handle_of(const std::string& reference) {
    return reference.substr(0, reference.find(':'));
}

/// The texture of a pattern that reads a file, where its manifold lays it. Of the manifold the repetition
/// alone is taken; offsets and turns are left out.
Tint texture_of(const std::string& file, const RisParameters& parameters, const RisNetwork& network) {
    Tint tint{V3f(1, 1, 1), file};
    if (parameters.number_or("linearize", 0) != 0) tint.colorspace = "srgb";
    const RisParameter* manifold = parameters.find("manifold");
    if (!manifold || manifold->strings.empty()) return tint;
    const auto found = network.patterns.find(handle_of(manifold->strings[0]));
    if (found == network.patterns.end()) return tint;
    tint.scale_s = found->second.parameters.number_or("scaleS", 1);
    tint.scale_t = found->second.parameters.number_or("scaleT", 1);
    return tint;
}

/// How far patterns have been followed. A network may have cycles, and may branch at each node: depth ends
/// the first, the count the second.
struct Walk {
    const RisNetwork& network;
    int depth = 0, seen = 0;
};

std::optional<Tint> tint_of_pattern(const std::string& handle, Walk& walk);

/// What references lead to, the mean of all that is known: textures count where nothing else does. The first
/// texture wins over all colours, as a mean of a picture and a colour would have to be made pixel by pixel.
class Mean {
  public:
    void add(const V3f& color) { sum_ += color, ++count_; }
    void add(const Tint& tint) {
        if (tint.texture.empty())
            add(tint.color);
        else if (texture_.texture.empty())
            texture_ = tint;
    }
    std::optional<Tint> result() const {
        if (!texture_.texture.empty()) return texture_;
        if (count_ == 0) return {};
        return Tint{sum_ / static_cast<float>(count_)};
    }

  private:
    V3f sum_{0, 0, 0};
    int count_ = 0;
    Tint texture_;
};

/// Numbers of a colour, or of several in an array.
void add_colors(const RisParameter& parameter, Mean& mean) {
    for (size_t i = 0; i + 2 < parameter.numbers.size(); i += 3) {
        const V3f color(parameter.numbers[i], parameter.numbers[i + 1], parameter.numbers[i + 2]);
        if (std::isfinite(brightness(color))) mean.add(color);
    }
}

/// Outputs of other patterns; those that lead nowhere add nothing.
void add_references(const RisParameter& parameter, Walk& walk, Mean& mean) {
    for (const std::string& reference : parameter.strings)
        if (const auto tint = tint_of_pattern(handle_of(reference), walk)) mean.add(*tint);
}

/// A pattern with a file is that file; another is the mean of the colours in it and behind it.
std::optional<Tint> tint_of_pattern(const std::string& handle, Walk& walk) {
    const auto found = walk.network.patterns.find(handle);
    if (found == walk.network.patterns.end() || walk.depth >= kDeepestPattern || walk.seen >= kMostPatterns)
        return {};
    ++walk.seen;
    const RisParameters& parameters = found->second.parameters;
    for (const char* name : {"filename", "filename0", "fileTextureName"})
        if (const std::string file = parameters.text(name); !file.empty())
            return texture_of(file, parameters, walk.network);
    Mean mean;
    ++walk.depth;
    for (const RisParameter& parameter : parameters.all()) {
        const bool may_be_color = parameter.is_color() || parameter.type == "struct";
        if (parameter.is_reference && may_be_color)
            add_references(parameter, walk, mean);
        else if (parameter.is_color())
            add_colors(parameter, mean);
    }
    --walk.depth;
    return mean.result();
}

/// A colour that is given, or that patterns make; none where the parameter is not there.
std::optional<Tint> tint_of(const RisParameters& parameters, std::string_view name,
                            const RisNetwork& network) {
    const RisParameter* found = parameters.find(name);
    if (!found) return {};
    if (const auto color = parameters.color(name)) return Tint{*color};
    if (!found->is_reference) return {};
    Mean mean;
    Walk walk{network};
    add_references(*found, walk, mean);
    return mean.result().value_or(Tint{kGrey});
}

/// What a conductor, or glass, reflects of what comes straight. Mode 1 is physical: Fresnel's reflectance of
/// a conductor at normal incidence, ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2), of which the edge colour is a
/// tint.
V3f reflected(const RisParameters& parameters, const RisNetwork& network) {
    const auto color = [&](std::string_view name, float without) {
        return tint_of(parameters, name, network).value_or(Tint{V3f(without)}).color;
    };
    const V3f edge = color("specularEdgeColor", 0);
    if (parameters.number_or("specularFresnelMode", 0) != 1) return color("specularFaceColor", 0);
    const V3f n = color("specularIor", 1.5f), k = color("specularExtinctionCoeff", 0);
    V3f result;
    for (int i = 0; i < 3; ++i) {
        const float k2 = k[i] * k[i], down = (n[i] - 1) * (n[i] - 1) + k2, up = (n[i] + 1) * (n[i] + 1) + k2;
        result[i] = up > 0 ? edge[i] * down / up : 0;
    }
    return result;
}

/// The last texture counts: a look has one.
void take_texture(const Tint& tint, RisLook& look) {
    if (tint.texture.empty()) return;
    look.texture = tint.texture;
    look.scale_s = tint.scale_s, look.scale_t = tint.scale_t;
    look.colorspace = tint.colorspace;
}

/// PxrSurface, and layers of it. Defaults are those of the plugin's documentation; clearcoat, fuzz and
/// iridescence are left out.
void take_lobes(const RisParameters& p, const RisNetwork& network, RisLook& look) {
    const auto add = [&](const char* gain, float without, const char* name, const V3f& otherwise) {
        const float weight = p.number_or(gain, without);
        if (weight == 0) return;
        const Tint tint = tint_of(p, name, network).value_or(Tint{otherwise});
        take_texture(tint, look);
        look.color = look.color.value_or(V3f(0, 0, 0)) + tint.color * weight;
    };
    add("diffuseGain", 1, "diffuseColor", V3f(0.18f, 0.18f, 0.18f));
    add("subsurfaceGain", 0, "subsurfaceColor", V3f(0.83f, 0.791f, 0.753f));
    add("singlescatterGain", 0, "singlescatterColor", V3f(0.83f, 0.791f, 0.753f));
    look.specular = reflected(p, network);
    // A mirror shows what is around it, which here nothing traces: most of that is taken to be as bright as
    // lit surfaces are.
    look.color = look.color.value_or(V3f(0, 0, 0)) + look.specular * 0.8f;
    look.roughness = p.number_or("specularRoughness", 0.2f);
    look.emission = tint_of(p, "glowColor", network).value_or(Tint{}).color * p.number_or("glowGain", 0);
    const float through = std::clamp(p.number_or("refractionGain", 0), 0.0f, 1.0f);
    if (through > 0) {
        look.color =
            *look.color + tint_of(p, "refractionColor", network).value_or(Tint{}).color * (0.2f * through);
        look.specular = V3f(1, 1, 1);
        look.opacity = 1 - 0.7f * through;
    }
}

/// Bxdfs that others layer: the mean of what is under them. All but the colour is that of the first:
/// highlights and textures cannot be averaged.
bool take_layers(const RisParameters& parameters, const RisNetwork& network, RisLook& look) {
    std::vector<const RisLook*> under;
    for (const RisParameter& parameter : parameters.all())
        if (parameter.is_reference && parameter.type == "bxdf")
            for (const std::string& reference : parameter.strings)
                if (const auto found = network.bxdfs.find(handle_of(reference)); found != network.bxdfs.end())
                    under.push_back(&found->second);
    if (under.empty()) return false;
    look = *under.front();
    const float weight = 1 / static_cast<float>(under.size());
    V3f color(0, 0, 0);
    for (const RisLook* one : under) color += one->color.value_or(kGrey) * weight;
    look.color = color;
    return true;
}

/// Parameters that hold what a surface looks like from afar, of several makers' shaders; the better ones
/// first.
constexpr std::string_view kColorParameters[] = {
    "baseColor",    "diffuseColor", "frontColor",    "diffuseFrontColor",
    "color",        "emitColor",    "emissionColor", "transmissionColor",
    "reflectivity", "albedo",       "tint"};

/// Takes the first of kColorParameters that is there. A look without any stays without a colour, and is grey
/// where it is shown.
void take_any_color(const RisParameters& parameters, const RisNetwork& network, RisLook& look) {
    for (const std::string_view name : kColorParameters)
        if (const auto tint = tint_of(parameters, name, network)) {
            look.color = tint->color;
            take_texture(*tint, look);
            return;
        }
}

/// Whole names, since a shader of a similar name may look quite different.
bool is_one_of(std::string_view shader, std::initializer_list<std::string_view> names) {
    return std::find(names.begin(), names.end(), shader) != names.end();
}

}  // namespace

/// PxrSurface by its lobes, layers by what is under them, all others by the first colour that they have.
RisLook look_of_bxdf(const std::string& shader, const RisParameters& parameters, const RisNetwork& network) {
    RisLook look;
    if (shader == "PxrBlack") return {.color = V3f(0, 0, 0), .texture = {}, .is_constant = true};
    look.is_constant = is_one_of(shader, {"PxrConstant", "PxrLightEmission", "LamaEmission"});
    if (is_one_of(shader, {"PxrSurface", "PxrLayerSurface"})) {
        take_lobes(parameters, network, look);
    } else if (!take_layers(parameters, network, look)) {
        take_any_color(parameters, network, look);
        if (shader.find("Disney") != std::string::npos) {
            look.specular = V3f(0.08f, 0.08f, 0.08f) * parameters.number_or("specular", 0.5f);
            look.roughness = parameters.number_or("roughness", 0.5f);
        }
        if (!look.is_constant) look.emission = parameters.color("emitColor").value_or(V3f(0, 0, 0));
        if (is_one_of(shader, {"PxrGlass", "PxrDielectric", "LamaDielectric"}))
            look.opacity = 0.3f, look.specular = V3f(1, 1, 1);
        if (shader == "PxrVolume") look.opacity = 0.2f;
    }
    look.opacity *= std::clamp(parameters.number_or("presence", 1), 0.0f, 1.0f);
    // RSL's exponent is 8 / roughness; the width of these lobes goes with the square of theirs.
    look.roughness = std::clamp(4 * look.roughness * look.roughness, 0.016f, 8.0f);
    return look;
}

}  // namespace trapeze::rib
