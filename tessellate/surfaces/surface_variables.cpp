#include "tessellate/surfaces/surface_variables.h"

#include <algorithm>

#include "tessellate/surfaces/between.h"

namespace trapeze {
namespace {

/// Positions have been evaluated as the surface itself.
bool is_position(std::string_view name) {
    return name == "P" || name == "Pw";
}

/// Strings have nothing between two values, and are one for a face whatever their class.
bool is_uniform(const Parameter& parameter) {
    const StorageClass storage = parameter.declaration.storage;
    return parameter.is_string() || storage == StorageClass::Constant || storage == StorageClass::Uniform;
}

/// One component of a variable at all vertices, whether it varies or not.
void fill(const Parameter& parameter, int component, const VariableSource& source, std::span<float> values) {
    if (!is_uniform(parameter)) return source.component(parameter, component, values);
    const size_t stride = parameter.declaration.floats_per_item();
    const float value = parameter.floats[source.uniform_index(parameter) * stride + component];
    std::fill(values.begin(), values.end(), value);
}

/// The grid's own array that a variable's first component goes to, by name and type; nullptr: none.
Triples* own_triples(const Parameter& parameter, ShadingGrid& grid) {
    if (component_count(parameter.declaration.type) != 3 || parameter.declaration.array_length != 1)
        return nullptr;
    if (parameter.name == "Cs") return &grid.Cs;
    if (parameter.name == "Os") return &grid.Os;
    if (parameter.name == "N") return &grid.N;
    return nullptr;
}

/// Sets s and t from "st", "s" or "t"; false when the variable is none of these.
bool set_own_floats(const Parameter& parameter, const VariableSource& source, ShadingGrid& grid) {
    const int floats = parameter.is_string() ? 0 : parameter.declaration.floats_per_item();
    if (parameter.name == "st" && floats == 2) {
        fill(parameter, 0, source, grid.s);
        fill(parameter, 1, source, grid.t);
        return true;
    }
    if (floats != 1 || (parameter.name != "s" && parameter.name != "t")) return false;
    fill(parameter, 0, source, parameter.name == "s" ? grid.s : grid.t);
    return true;
}

}  // namespace

/// Grids are used again for other subpatches: what a slot held before is overwritten by the caller.
GridVariable& variable_slot(ShadingGrid& grid, size_t index, const Parameter& parameter, bool uniform) {
    if (index >= grid.variables.size()) grid.variables.resize(index + 1);
    // Names and planes are kept where they fit: grids of one surface have the same variables in the same
    // places.
    GridVariable& variable = grid.variables[index];
    if (variable.name != parameter.name) variable.name = parameter.name;
    variable.declaration = parameter.declaration;
    variable.uniform = uniform;
    const int planes = parameter.is_string() ? 0 : parameter.declaration.floats_per_item();
    variable.planes.resize(planes);
    for (std::vector<float>& plane : variable.planes) plane.resize(uniform ? 1 : grid.vertex_count());
    variable.strings.resize(parameter.is_string() ? parameter.declaration.array_length : 0);
    return variable;
}

/// Names decide where values go: shaders know Cs, Os, N, s and t as predefined variables, and all others by
/// the name of a parameter.
bool set_variables(const ParameterList& parameters, const VariableSource& source, ShadingGrid& grid) {
    size_t count = 0;
    bool has_normals = false;
    for (const Parameter& parameter : parameters.values) {
        // Where two variables have one name, the one that the list's find() gives counts.
        if (is_position(parameter.name) || parameters.find(parameter.name) != &parameter) continue;
        if (Triples* triples = own_triples(parameter, grid)) {
            for (int k = 0; k < 3; ++k) fill(parameter, k, source, triples->c[k]);
            has_normals |= triples == &grid.N;
            continue;
        }
        if (set_own_floats(parameter, source, grid)) continue;
        // Everything else is a variable of its own, in the order of the parameter list.
        const bool uniform = is_uniform(parameter);
        GridVariable& variable = variable_slot(grid, count++, parameter, uniform);
        for (size_t i = 0; i < variable.strings.size(); ++i)
            variable.strings[i] =
                parameter.strings[source.uniform_index(parameter) * variable.strings.size() + i];
        for (size_t k = 0; k < variable.planes.size(); ++k)
            fill(parameter, static_cast<int>(k), source, variable.planes[k]);
    }
    // What an earlier grid had besides goes.
    grid.variables.resize(count);
    return has_normals;
}

/// TextureCoordinates gives the corners (0, 0), (1, 0), (0, 1), (1, 1) in this order, s and t each.
void set_texture_coordinates(const Attributes& attributes, ShadingGrid& grid) {
    const std::array<float, 8>& c = attributes.texture_coordinates;
    for (size_t i = 0; i < grid.u.size(); ++i) {
        const float u = grid.u[i], v = grid.v[i];
        grid.s[i] = between_corners(c[0], c[2], c[4], c[6], u, v);
        grid.t[i] = between_corners(c[1], c[3], c[5], c[7], u, v);
    }
}

}  // namespace trapeze
