#include "shade/materials/unknown_parameters.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/scene/light_groups.h"
#include "shade/rsl/analysis/suggestions.h"

namespace trapeze {
namespace {

/// A name from a file as messages show it: on one line, and not too long.
std::string shown(std::string name) {
    constexpr size_t kLongest = 100;
    if (name.size() > kLongest) name = name.substr(0, kLongest) + "...";
    std::ranges::replace_if(
        name, [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '?');
    return name;
}

}  // namespace

void report_unknown_parameters(const ShaderInstance& instance, const rsl::Program& program,
                               Diagnostics& diagnostics) {
    for (const Parameter& given : instance.parameters.values) {
        const auto is_it = [&](const rsl::ProgramParameter& parameter) {
            return parameter.name == given.name;
        };
        const bool names_group = program.kind == rsl::ShaderKind::Light && given.name == kLightGroupParameter;
        if (names_group || std::ranges::any_of(program.parameters, is_it)) continue;
        rsl::Suggestion suggestion(given.name);
        for (const rsl::ProgramParameter& parameter : program.parameters) suggestion.consider(parameter.name);
        diagnostics.warning(instance.location,
                            fmt::format("shader \"{}\" has no parameter \"{}\"{}", shown(instance.name),
                                        shown(given.name), suggestion.text()),
                            fmt::format("shader-parameter-unknown {} {}", instance.name, given.name));
    }
}

}  // namespace trapeze
