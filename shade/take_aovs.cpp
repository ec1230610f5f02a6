#include "shade/take_aovs.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/scene/light_groups.h"
#include "shade/light_layers.h"
#include "shade/made_variables.h"
#include "shade/materials/material.h"
#include "shade/shader_variables.h"

namespace trapeze {
namespace {

bool provides(const Material& material, const Aov& aov) {
    for (const LayeredShader* shader : {material.surface, material.displacement})
        if (shader && std::ranges::any_of(shader->layers, [&](const BoundShader* layer) {
                return has_output(layer->program(), aov);
            }))
            return true;
    return has_variable(material.surface->last().program(), aov);
}

/// Takes one channel of one grid, whose lanes begin at `first`. `from` null: the grid's own; 0 where that has
/// none either.
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
    const std::vector<float>* own = find_own_plane(grid, aov, channel);
    if (own && own->size() >= count)
        to.assign(own->begin(), own->begin() + static_cast<std::ptrdiff_t>(count));
    else
        to.assign(count, 0.0f);
}

/// Whether a variable is the normal as the primitive or the shader has it. Nobody has multiplied it by Oi, as
/// values that are summed through layers are to be.
bool is_plain_normal(const Aov& aov, LayerRegisters surface, LayerRegisters displacement) {
    if (aov.name != "N" || aov.channels != 3 || !aov.is_summed()) return false;
    for (const LayerRegisters layers : {surface, displacement})
        for (const vm::Registers* layer : layers)
            if (has_output(layer->program(), aov)) return false;
    return true;
}

void multiply_by_opacity(const Aov& aov, ShadingGrid& grid) {
    for (size_t i = 0; i < grid.vertex_count(); ++i) {
        const float opacity = (grid.Oi.c[0][i] + grid.Oi.c[1][i] + grid.Oi.c[2][i]) / 3;
        for (int c = 0; c < 3; ++c) grid.aovs[static_cast<size_t>(aov.offset + c)][i] *= opacity;
    }
}

/// Whether any grid will have a variable.
bool exists(const Aov& aov, const Materials& materials) {
    if (const auto group = light_group_asked(aov))
        return *group == kUnlitGroup || std::ranges::any_of(materials.lamps(), [&](const Lamp* lamp) {
            return light_group_of(lamp->shader->instance()) == *group;
        });
    return grids_have(aov) || is_made_variable(aov) ||
           std::any_of(materials.all().begin(), materials.all().end(),
                       [&](const Material& material) { return provides(material, aov); });
}

}  // namespace

void take_aovs(const AovLayout& layout, LayerRegisters surface, LayerRegisters displacement,
               const Camera& camera, std::span<ShadingGrid* const> grids) {
    for (ShadingGrid* grid : grids) grid->aovs.resize(static_cast<size_t>(layout.channel_count));
    for (const Aov& aov : layout.aovs) {
        const vm::Operand* from = find_shader_variable(aov, surface, displacement);
        const bool weighed = is_plain_normal(aov, surface, displacement);
        size_t first = 0;
        for (ShadingGrid* grid : grids) {
            if (!from && is_made_variable(aov)) {
                make_variable(aov, camera, *grid);
                continue;
            }
            for (int channel = 0; channel < aov.channels; ++channel)
                take_channel(aov, channel, from, first, *grid);
            if (weighed) multiply_by_opacity(aov, *grid);
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
        const auto group = light_group_asked(*aov);
        // Two displays may have one name.
        diagnostics.warning(
            display.location,
            group
                ? fmt::format(
                      "Display \"{}\": no light of the scene is of the group \"{}\"; it is 0 everywhere",
                      display.name, *group)
                : fmt::format("Display \"{}\": no surface or displacement shader of the scene has a variable "
                              "\"{}\" of {}; it is 0 everywhere",
                              display.name, aov->name, aov->channels == 1 ? "one number" : "three numbers"),
            fmt::format("display-variable {} {} {}", i, display.name, aov->name));
    }
}

}  // namespace trapeze
