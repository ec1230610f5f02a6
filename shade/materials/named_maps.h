/// The maps that a shader asks for by names that are known before it runs.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "shade/materials/bound_shader.h"

namespace trapeze {

struct NamedMap {
    std::string name;
    bool is_depths = false;  ///< of shadow()
    SourceLocation location;
};

/// Of texture(), environment(), bump() and shadow() those calls whose names are constants or values of the
/// instance, put together or not; calls that such values rule out are left out, and so are names that are
/// found while the shader runs. `varied`: parameters for which primitives bring values of their own.
std::vector<NamedMap> named_maps(const BoundShader& shader, const std::set<std::string>& varied);

}  // namespace trapeze
