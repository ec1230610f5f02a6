#include "shade/take_aovs.h"

#include <fmt/format.h>

#include <algorithm>

#include "shade/materials/material.h"

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

/// A channel of a variable that the grid itself has; null for another variable.
const std::vector<float>* own_plane(const ShadingGrid& grid, const Aov& aov, int channel) {
    if (aov.channels == 3) {
        if (aov.name == "P") return &grid.P.front().c[channel];
        const TriplesMember triples = triples_named(aov.name);
        return triples ? &(grid.*triples).c[channel] : nullptr;
    }
    const FloatsMember floats = floats_named(aov.name);
    return floats ? &(grid.*floats) : nullptr;
}

bool grids_have(const Aov& aov) {
    if (aov.channels == 1) return floats_named(aov.name) != nullptr;
    return aov.name == "P" || triples_named(aov.name);
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

using LayerRegisters = std::span<vm::Registers* const>;

/// The register from which a variable is taken, in the order that take_aovs() tells; null when no shader has
/// it.
const vm::Operand* operand_of(const Aov& aov, LayerRegisters surface, LayerRegisters displacement) {
    if (is_result(aov)) return nullptr;
    for (const LayerRegisters layers : {surface, displacement})
        for (size_t i = layers.size(); i-- > 0;)
            if (const rsl::RegisterId* id = output_of(layers[i]->program(), aov))
                return &layers[i]->operand(*id);
    const rsl::RegisterId* id = register_of(surface.back()->program(), aov);
    return id ? &surface.back()->operand(*id) : nullptr;
}

bool provides(const Material& material, const Aov& aov) {
    for (const LayeredShader* shader : {material.surface, material.displacement})
        if (shader && std::ranges::any_of(shader->layers, [&](const BoundShader* layer) {
                return output_of(layer->program(), aov) != nullptr;
            }))
            return true;
    return register_of(material.surface->last().program(), aov) != nullptr;
}

/// Takes one channel of one grid, whose lanes begin at `first`. `from` null: the grid's own, or 0.
void take_channel(const Aov& aov, int channel, const vm::Operand* from, size_t first, ShadingGrid& grid) {
    const size_t count = grid.vertex_count();
    std::vector<float>& to = grid.aovs[static_cast<size_t>(aov.offset + channel)];
    if (from) {
        const float* plane = from->data + static_cast<size_t>(channel) * from->stride;
        if (from->lane_mask)
            to.assign(plane + first, plane + first + count);
        else
            to.assign(count, *plane);
        return;
    }
    const std::vector<float>* own = own_plane(grid, aov, channel);
    if (own && own->size() >= count)
        to.assign(own->begin(), own->begin() + static_cast<std::ptrdiff_t>(count));
    else
        to.assign(count, 0.0f);
}

/// Whether any grid will have a variable.
bool exists(const Aov& aov, const Materials& materials) {
    return grids_have(aov) || std::any_of(materials.all().begin(), materials.all().end(),
                                          [&](const Material& material) { return provides(material, aov); });
}

}  // namespace

void take_aovs(const AovLayout& layout, LayerRegisters surface, LayerRegisters displacement,
               std::span<ShadingGrid* const> grids) {
    for (ShadingGrid* grid : grids) grid->aovs.resize(static_cast<size_t>(layout.channel_count));
    for (const Aov& aov : layout.aovs) {
        const vm::Operand* from = operand_of(aov, surface, displacement);
        size_t first = 0;
        for (ShadingGrid* grid : grids) {
            for (int channel = 0; channel < aov.channels; ++channel)
                take_channel(aov, channel, from, first, *grid);
            first += grid->vertex_count();
        }
    }
}

void report_missing_aovs(const AovLayout& layout, const Materials& materials, const Options& options,
                         Diagnostics& diagnostics) {
    for (size_t i = 0; i < options.displays.size(); ++i) {
        const Display& display = options.displays[i];
        const Aov* aov = display.variable ? layout.find(*display.variable) : nullptr;
        if (!aov || exists(*aov, materials)) continue;
        // Two displays may have one name.
        diagnostics.warning(
            display.location,
            fmt::format("Display \"{}\": no surface or displacement shader of the scene has a variable "
                        "\"{}\" of {}; it is 0 everywhere",
                        display.name, aov->name, aov->channels == 1 ? "one number" : "three numbers"),
            fmt::format("display-variable {} {} {}", i, display.name, aov->name));
    }
}

}  // namespace trapeze
