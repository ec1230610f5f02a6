/// What a shader does with the parameters that it has: the maps that it asks for by names that are known
/// before it runs, and the code that is left.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "shade/materials/bound_shader.h"

namespace trapeze {

/// Names of the variables of all primitives. A primitive's variable replaces the shader parameter of its
/// name, so that such a parameter's value is not known before it runs.
std::set<std::string> variables_of(const Scene& scene);

/// A map that a shader will look up.
struct NamedMap {
    std::string name;         ///< as the shader has it, before any search
    bool is_depths = false;   ///< of shadow()
    SourceLocation location;  ///< of the call in the shader's source
};

/// The maps whose names are constants or values of the instance, put together or not, in calls of texture(),
/// environment(), bump() and shadow(). Calls that such values rule out are left out, and so are names that
/// are found only while the shader runs; rays are no maps. `varied`: parameters for which primitives bring
/// values of their own.
std::vector<NamedMap> named_maps(const BoundShader& shader, const std::set<std::string>& varied);

/// A copy of the shader's code without what its values rule out. It is not to be run.
rsl::Program specialised_program(const BoundShader& shader, const std::set<std::string>& varied);

}  // namespace trapeze
