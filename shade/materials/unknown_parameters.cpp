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
        rsl::Suggestion suggestion(given.name);
        bool is_known = false;
        for (const rsl::ProgramParameter& parameter : program.parameters) {
            is_known = is_known || parameter.name == given.name;
            suggestion.consider(parameter.name);
        }
        const bool names_group = program.kind == rsl::ShaderKind::Light && given.name == kLightGroupParameter;
        if (is_known || names_group) continue;
        diagnostics.warning(instance.location,
                            fmt::format("shader \"{}\" has no parameter \"{}\"{}", shown(instance.name),
                                        shown(given.name), suggestion.text()),
                            fmt::format("shader-parameter-unknown {} {}", instance.name, given.name));
    }
}

}  // namespace trapeze
