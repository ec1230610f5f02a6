/// Tables of what this renderer looks at. A new option, attribute or parameter needs its row here, or
/// `trapeze check` says that nothing looks at it.
#include "pipeline/rib/state/recognised_names.h"

#include <algorithm>
#include <iterator>

namespace trapeze::rib {
namespace {

/// Sets of names are short, and are searched one by one.
struct Value {
    std::string_view category, name;  ///< an empty name: all of the category
};

/// Options by category and name.
constexpr Value kOptions[] = {{"user", ""},
                              {"color", "transfer"},
                              {"ocio", "config"},
                              {"ocio", "display"},
                              {"ocio", "look"},
                              {"ocio", "view"},
                              {"ocio", "workingspace"},
                              {"searchpath", "archive"},
                              {"searchpath", "procedural"},
                              {"searchpath", "shader"},
                              {"searchpath", "texture"},
                              {"limits", "texturememory"},
                              {"limits", "zthreshold"},
                              {"rib", "varsubst"},
                              {"ribparse", "varsubst"},
                              {"shadow", "bias"},
                              {"shadow", "bias0"},
                              {"trace", "maxdepth"},
                              {"trace", "levels"}};

/// Attributes likewise. An empty name stands for all of a category.
constexpr Value kAttributes[] = {{"user", ""},
                                 {"identifier", "name"},
                                 {"bound", "displacement"},
                                 {"displacementbound", ""},
                                 {"grouping", "membership"},
                                 {"shade", "diffusehitmode"},
                                 {"shade", "specularhitmode"},
                                 {"shade", "transmissionhitmode"},
                                 {"trace", "bias"},
                                 {"trace", "displacements"},
                                 {"trace", "maxdiffusedepth"},
                                 {"trace", "maxspeculardepth"},
                                 {"trace", "samplemotion"},
                                 {"visibility", "camera"},
                                 {"visibility", "diffuse"},
                                 {"visibility", "specular"},
                                 {"visibility", "trace"},
                                 {"visibility", "transmission"},
                                 {"render", "visibility"},
                                 {"render", "casts_shadows"},
                                 {"light", "nsamples"},
                                 {"light", "shadows"},
                                 {"light", "samples"},
                                 {"dice", "binary"},
                                 {"dice", "rasterorient"},
                                 {"dice", "minlength"},
                                 {"dice", "micropolygonlength"},
                                 {"trimcurve", "sense"},
                                 {"cull", "hidden"}};

/// Asked for by many exporters; the reason is shown to their users.
constexpr UnneededAttribute kUnneededAttributes[] = {
    {"cull", "backfacing", "all that is in view is shaded, whichever way it faces"},
    {"dice", "hair", "curves thinner than a micropolygon are one wide in any case"},
    {"stitch", "enable", "grids join without cracks in any case"},
    {"stitch", "newgroup", "grids join without cracks in any case"},
    {"stitch", "traceenable", "grids join without cracks in any case"},
    {"visibility", "photon", "there are no photons to see it"},
};

/// Parameters of Hider, whichever it is.
constexpr std::string_view kHider[] = {"aperture",   "depthfilter", "jitter",      "maxsamples",
                                       "maxvpdepth", "minsamples",  "samplemotion"};

/// Display "exrheader_NAME" writes an attribute of that name into the file: any name.
constexpr std::string_view kHeaderPrefix = "exrheader_", kHeaderAttributes = "exrheader_NAME";
constexpr std::string_view kDisplay[] = {"quantize",       "dither",      "type",          "exrpixeltype",
                                         "exrcompression", "compression", "colorspace",    "storage",
                                         "tilesize",       "filter",      "deeptolerance", kHeaderAttributes};

template <size_t kCount>
bool has(const Value (&values)[kCount], std::string_view category, std::string_view name) {
    return std::any_of(std::begin(values), std::end(values), [&](const Value& value) {
        return value.category == category && (value.name.empty() || value.name == name);
    });
}

template <size_t kCount>
bool has(const std::string_view (&names)[kCount], std::string_view name) {
    return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

/// For COMPLIANCE.md, in the order of the alphabet.
template <size_t kCount>
std::vector<std::string> listed(const Value (&values)[kCount]) {
    std::vector<std::string> names;
    for (const Value& value : values)
        names.push_back(std::string(value.category) + " " +
                        (value.name.empty() ? "(all)" : std::string(value.name)));
    std::sort(names.begin(), names.end());
    return names;
}

template <size_t kCount>
std::vector<std::string> listed(const std::string_view (&values)[kCount]) {
    std::vector<std::string> names(std::begin(values), std::end(values));
    std::sort(names.begin(), names.end());
    return names;
}

}  // namespace

/// Made anew at each call, for documents and messages; the reader asks by recognises_...() below.
RecognisedNames recognised_names() {
    return {listed(kOptions), listed(kAttributes), listed(kHider), listed(kDisplay)};
}

std::span<const UnneededAttribute> unneeded_attributes() {
    return kUnneededAttributes;
}
const UnneededAttribute* unneeded_attribute(std::string_view category, std::string_view name) {
    const auto found = std::ranges::find_if(kUnneededAttributes, [&](const UnneededAttribute& setting) {
        return setting.category == category && setting.name == name;
    });
    return found == std::end(kUnneededAttributes) ? nullptr : &*found;
}

bool recognises_option(std::string_view category, std::string_view name) {
    return has(kOptions, category, name);
}
bool recognises_attribute(std::string_view category, std::string_view name) {
    return has(kAttributes, category, name);
}
bool recognises_hider_parameter(std::string_view name) {
    return has(kHider, name);
}
bool recognises_display_parameter(std::string_view name) {
    return has(kDisplay, name) || name.starts_with(kHeaderPrefix);
}

}  // namespace trapeze::rib
