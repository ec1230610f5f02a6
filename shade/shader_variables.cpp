#include "shade/shader_variables.h"

#include <string_view>

namespace trapeze {
namespace {

/// Variables that grids have by themselves, by name and type.
using TriplesMember = Triples ShadingGrid::*;
using FloatsMember = std::vector<float> ShadingGrid::*;

TriplesMember triples_named(std::string_view name) {
    static constexpr std::pair<std::string_view, TriplesMember> kNames[] = {
        {"Ci", &ShadingGrid::Ci},     {"Oi", &ShadingGrid::Oi},    {"N", &ShadingGrid::N},
        {"Ng", &ShadingGrid::Ng},     {"Cs", &ShadingGrid::Cs},    {"Os", &ShadingGrid::Os},
        {"dPdu", &ShadingGrid::dPdu}, {"dPdv", &ShadingGrid::dPdv}};
    for (const auto& [known, member] : kNames)
        if (known == name) return member;
    return nullptr;
}

FloatsMember floats_named(std::string_view name) {
    static constexpr std::pair<std::string_view, FloatsMember> kNames[] = {
        {"u", &ShadingGrid::u}, {"v", &ShadingGrid::v}, {"s", &ShadingGrid::s}, {"t", &ShadingGrid::t}};
    for (const auto& [known, member] : kNames)
        if (known == name) return member;
    return nullptr;
}

/// Whether a variable is a result, Ci or Oi: the atmosphere changes these after the surface has run, so they
/// are taken from the grid.
bool is_result(const Aov& aov) {
    return aov.name == "Ci" || aov.name == "Oi";
}

bool fits(const rsl::Type& type, const Aov& aov) {
    return !type.is_array() && rsl::width_of(type.base) == aov.channels;
}

/// The register of an output parameter; null when the program has none of that name and as many numbers.
const rsl::RegisterId* output_of(const rsl::Program& program, const Aov& aov) {
    for (const rsl::ProgramParameter& parameter : program.parameters)
        if (parameter.output && parameter.name == aov.name && fits(parameter.type, aov)) return &parameter.id;
    return nullptr;
}

/// The register of any variable that the program has; null when it has none of that name and as many numbers.
const rsl::RegisterId* register_of(const rsl::Program& program, const Aov& aov) {
    const rsl::RegisterId* id = program.find_global(aov.name);
    for (const rsl::ProgramParameter& parameter : program.parameters)
        if (parameter.name == aov.name) id = &parameter.id;
    return id && fits(program.reg(*id).type, aov) ? id : nullptr;
}

}  // namespace

bool grids_have(const Aov& aov) {
    if (aov.channels == 1) return floats_named(aov.name) != nullptr;
    return aov.name == "P" || triples_named(aov.name);
}

const std::vector<float>* find_own_plane(const ShadingGrid& grid, const Aov& aov, int channel) {
    if (aov.channels == 3) {
        if (aov.name == "P") return &grid.P.front().c[channel];
        const TriplesMember triples = triples_named(aov.name);
        return triples ? &(grid.*triples).c[channel] : nullptr;
    }
    const FloatsMember floats = floats_named(aov.name);
    return floats ? &(grid.*floats) : nullptr;
}

bool has_output(const rsl::Program& program, const Aov& aov) {
    return output_of(program, aov) != nullptr;
}
bool has_variable(const rsl::Program& program, const Aov& aov) {
    return register_of(program, aov) != nullptr;
}

const vm::Operand* find_shader_variable(const Aov& aov, LayerRegisters surface, LayerRegisters displacement) {
    if (is_result(aov)) return nullptr;
    for (const LayerRegisters layers : {surface, displacement})
        for (size_t i = layers.size(); i-- > 0;)
            if (const rsl::RegisterId* id = output_of(layers[i]->program(), aov))
                return &layers[i]->operand(*id);
    if (surface.empty()) return nullptr;
    const rsl::RegisterId* id = register_of(surface.back()->program(), aov);
    return id ? &surface.back()->operand(*id) : nullptr;
}

}  // namespace trapeze
