#include "shade/answer_hits.h"

#include <algorithm>

#include "shade/named_values.h"

namespace trapeze {
namespace {

using Of = HitOutput::Of;

/// Where a hit's answer goes: whether there is one, and its numbers.
using Answer = std::span<float>;

bool take_own(const ShadingGrid& grid, const Aov& aov, size_t vertex, Answer answer) {
    for (int k = 0; k < aov.channels; ++k) {
        const std::vector<float>* plane = find_own_plane(grid, aov, k);
        if (!plane || plane->size() <= vertex) return false;
        answer[1 + static_cast<size_t>(k)] = (*plane)[vertex];
    }
    return true;
}

bool take_variable(const ShadingGrid& grid, const Aov& aov, size_t vertex, Answer answer) {
    const GridVariable* variable = grid.find(aov.name);
    if (!variable || variable->planes.size() != static_cast<size_t>(aov.channels)) return false;
    for (size_t k = 0; k < variable->planes.size(); ++k) {
        const std::vector<float>& plane = variable->planes[k];
        if (plane.empty()) return false;
        answer[1 + k] = plane[variable->uniform ? 0 : std::min(vertex, plane.size() - 1)];
    }
    return true;
}

bool take_attribute(const ShadingGrid& grid, const HitOutput& output, Answer answer) {
    const std::optional<NamedValue> value =
        find_attribute_value(*grid.primitive->attributes, grid.primitive, output.name);
    if (!value || value->numbers.size() < static_cast<size_t>(output.width)) return false;
    std::copy_n(value->numbers.begin(), output.width, answer.begin() + 1);
    return true;
}

bool take_register(const vm::Operand& from, int width, size_t lane, Answer answer) {
    for (int k = 0; k < width; ++k) {
        const float* plane = from.data + static_cast<size_t>(k) * from.stride;
        answer[1 + static_cast<size_t>(k)] = plane[from.lane_mask ? lane : 0];
    }
    return true;
}

/// The variable of the last layer that has it; null where none has.
const vm::Operand* find_in(LayerRegisters layers, const Aov& aov) {
    for (size_t i = layers.size(); i-- > 0;)
        if (const vm::Operand* from = find_shader_variable(aov, layers.subspan(i, 1), {})) return from;
    return nullptr;
}

}  // namespace

void answer_hits(const HitOutputs& outputs, LayerRegisters surface, LayerRegisters displacement,
                 LayerRegisters atmosphere, std::span<ShadingGrid* const> grids) {
    for (ShadingGrid* grid : grids) grid->answers.assign(outputs.size, 0.0f);
    for (const HitOutput& output : outputs.all) {
        const Aov aov{output.name, output.width, 0};
        const vm::Operand* from = nullptr;
        if (output.of == Of::Surface) from = find_shader_variable(aov, surface, displacement);
        if (output.of == Of::Displacement) from = find_in(displacement, aov);
        if (output.of == Of::Volume) from = find_in(atmosphere, aov);
        const bool ran = !surface.empty();
        size_t first = 0;
        for (ShadingGrid* grid : grids) {
            const auto vertex = static_cast<size_t>(std::max(grid->hit_vertex, 0));
            const Answer answer =
                Answer(grid->answers).subspan(output.at, 1 + static_cast<size_t>(output.width));
            bool found = false;
            if (output.of == Of::Attribute)
                found = take_attribute(*grid, output, answer);
            else if (output.of == Of::Primitive)
                found = take_own(*grid, aov, vertex, answer) || take_variable(*grid, aov, vertex, answer);
            else if (from)
                found = take_register(*from, output.width, first + vertex, answer);
            else if (output.of == Of::Surface && ran)
                found = take_own(*grid, aov, vertex, answer);
            answer[0] = found ? 1.0f : 0.0f;
            first += grid->vertex_count();
        }
    }
}

}  // namespace trapeze
