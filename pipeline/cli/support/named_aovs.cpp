#include "pipeline/cli/support/named_aovs.h"

#include <algorithm>
#include <filesystem>
#include <string_view>

#include "composite/displays/display_plan.h"
#include "composite/mattes/matte_layers.h"
#include "core/scene/aov.h"
#include "core/scene/deep_pictures.h"
#include "core/scene/light_groups.h"

namespace trapeze {
namespace {

constexpr const char* kAllLightGroups = "lightgroups";

struct NamedVariable {
    std::string_view name;
    ValueType type;
    VariableFilter filter;
};
constexpr NamedVariable kVariables[] = {{"albedo", ValueType::Color, VariableFilter::Picture},
                                        {"N", ValueType::Normal, VariableFilter::Picture},
                                        {"P", ValueType::Point, VariableFilter::Nearest},
                                        {"motion", ValueType::Vector, VariableFilter::Nearest},
                                        {"u", ValueType::Float, VariableFilter::Nearest},
                                        {"v", ValueType::Float, VariableFilter::Nearest}};
constexpr std::pair<std::string_view, ValueType> kTypes[] = {{"float", ValueType::Float},
                                                             {"color", ValueType::Color},
                                                             {"point", ValueType::Point},
                                                             {"vector", ValueType::Vector},
                                                             {"normal", ValueType::Normal}};

Display of_mode(std::string mode) {
    Display display;
    display.mode = std::move(mode);
    return display;
}

Display of_variable(const std::string& name, ValueType type, VariableFilter filter) {
    Display display = of_mode(name);
    display.variable = DisplayVariable{name, type, filter};
    return display;
}

/// "color foo" or foo.
bool add_shader_variable(const std::string& text, std::vector<Display>& displays) {
    const auto is_type = [](std::string_view word) {
        return std::any_of(std::begin(kTypes), std::end(kTypes),
                           [&](const auto& row) { return row.first == word; });
    };
    if (is_type(text)) return false;
    const size_t space = text.find(' ');
    std::string name = text;
    ValueType type = ValueType::Color;
    if (space != std::string::npos) {
        const auto known = std::find_if(std::begin(kTypes), std::end(kTypes), [&](const auto& row) {
            return row.first == std::string_view(text).substr(0, space);
        });
        if (known == std::end(kTypes)) return false;
        type = known->second;
        name = text.substr(text.find_first_not_of(' ', space));
    }
    if (!can_name_channels(name)) return false;
    displays.push_back(of_variable(name, type, VariableFilter::Picture));
    return true;
}

bool add_named(const std::string& name, std::vector<Display>& displays) {
    if (name == "uv") return add_named("u", displays) && add_named("v", displays);
    for (const NamedVariable& known : kVariables)
        if (known.name == name) {
            displays.push_back(of_variable(name, known.type, known.filter));
            return true;
        }
    if (name == "z" || name == "id" || name == kAllLightGroups || matte_layer_named(name)) {
        displays.push_back(of_mode(name));
        return true;
    }
    if (name == "alpha") {
        displays.push_back(of_mode("a"));
        return true;
    }
    if (name.starts_with("crypto_")) return false;
    return add_shader_variable(name, displays);
}

std::string trimmed_text(std::string_view text) {
    const size_t first = text.find_first_not_of(' ');
    if (first == std::string_view::npos) return {};
    return std::string(text.substr(first, text.find_last_not_of(' ') - first + 1));
}

bool shows_the_same(const Display& display, const Display& aov) {
    if (display.variable && aov.variable) return display.variable->name == aov.variable->name;
    if (display.variable || aov.variable) return false;
    // Colour, alpha and depth stand together in a mode.
    if (aov.mode == "a" || aov.mode == "z") {
        const std::string mode = display.mode.empty() ? "rgba" : display.mode;
        if (mode.starts_with("crypto_") || mode == "id") return false;
        return mode.find(aov.mode) != std::string::npos;
    }
    return display.mode == aov.mode;
}

/// Puts a variable of each group in place of "lightgroups".
std::vector<Display> with_light_groups(const std::vector<Display>& aovs, std::vector<std::string> groups) {
    groups.emplace_back(kUnlitGroup);
    std::vector<Display> all;
    for (const Display& aov : aovs)
        if (aov.mode != kAllLightGroups)
            all.push_back(aov);
        else
            for (const std::string& group : groups)
                all.push_back(of_variable(std::string(kLightGroupPrefix) + group, ValueType::Color,
                                          VariableFilter::Picture));
    return all;
}

}  // namespace

std::vector<Display> displays_of_aovs(const std::string& list, std::string* error) {
    std::vector<Display> displays;
    for (size_t begin = 0; begin <= list.size();) {
        const size_t end = std::min(list.find(',', begin), list.size());
        const std::string name = trimmed_text(std::string_view(list).substr(begin, end - begin));
        begin = end + 1;
        if (add_named(name, displays)) continue;
        *error =
            "\"" + name +
            "\" is none of albedo, N, P, motion, u, v, uv, z, id, alpha, crypto_object, crypto_material, "
            "crypto_asset, lightgroups, and no variable as in \"color foo\" or \"float foo\"";
        return {};
    }
    return displays;
}

std::string add_aovs(const std::vector<Display>& aovs, const std::vector<std::string>& light_groups,
                     std::vector<Display>& displays) {
    const Display first = displays.front();
    std::string file = first.name;
    std::string type = first.type;  // of windows, too, which files of another name stand for
    if (const auto format = file_format(first); format && *format != FileFormat::OpenExr) {
        file = std::filesystem::path(file).replace_extension(".exr").string();
        type = "file";
    } else if (is_deep(first)) {
        file = std::filesystem::path(file).replace_extension(".layers.exr").string();
        type = "file";
    }
    for (const Display& aov : with_light_groups(aovs, light_groups)) {
        if (std::any_of(displays.begin(), displays.end(), [&](const Display& known) {
                return known.name == file && shows_the_same(known, aov);
            }))
            continue;
        Display added = aov;
        added.name = file, added.type = type;
        added.location = first.location;
        displays.push_back(std::move(added));
    }
    return file;
}

}  // namespace trapeze
