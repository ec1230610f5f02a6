/// Primitive variables onto grids: which names go to which of the grid's own arrays, and memory that is
/// reused from grid to grid.
#pragma once

#include <array>
#include <span>

#include "core/scene/scene.h"
#include "core/scene/shading_grid.h"

namespace trapeze {

/// What a kind of surface knows of its variables: values of one component at the grid's vertices, in the
/// variable's own space. One for each grid. It interpolates and knows nothing of grids' arrays;
/// set_variables() knows those and nothing of topology.
class VariableSource {
  public:
    virtual ~VariableSource() = default;
    /// Sets component `component` of a value (of an array: counted through its items) at every vertex.
    virtual void component(const Parameter& parameter, int component, std::span<float> values) const = 0;
    /// Which of the parameter's values is the face's, for what has one value over a face.
    virtual size_t uniform_index(const Parameter& parameter) const = 0;
};

/// Sets st, Cs, Os, N and the other variables of a parameter list; positions are left out. Returns whether
/// there is an N.
bool set_variables(const ParameterList& parameters, const VariableSource& source, ShadingGrid& grid);

/// s and t where no variable sets them: the attributes' texture coordinates, bilinear in the grid's u and v.
void set_texture_coordinates(const Attributes& attributes, ShadingGrid& grid);

/// Makes grid.variables[index] ready for a parameter: name, declaration and planes of the right size, of
/// which those of an earlier grid are reused. Values are not set.
GridVariable& variable_slot(ShadingGrid& grid, size_t index, const Parameter& parameter, bool uniform);

}  // namespace trapeze
