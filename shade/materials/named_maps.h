/// The maps that a shader asks for by names that are known before it runs.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "shade/materials/bound_shader.h"

namespace trapeze {

/// A map that a shader will look up.
struct NamedMap {
    std::string name;         ///< as the shader has it, before any search
    bool is_depths = false;   ///< of shadow()
    SourceLocation location;  ///< of the call in the shader's source
};

/// The maps whose names are constants or values of the instance, put together or not, in calls of texture(),
/// environment(), bump() and shadow(). Calls that such values rule out are left out, and so are names that
/// are found only while the shader runs. `varied`: parameters for which primitives bring values of their own.
std::vector<NamedMap> named_maps(const BoundShader& shader, const std::set<std::string>& varied);

}  // namespace trapeze
