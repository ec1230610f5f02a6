/// Parameters of a shader's instance that the shader does not have.
#pragma once

#include "core/diagnostics.h"
#include "core/scene/scene.h"
#include "shade/code/program.h"

namespace trapeze {

/// Warns, once for each name, of parameters that the shader does not have, with the one that may have been
/// meant.
void report_unknown_parameters(const ShaderInstance& instance, const rsl::Program& program,
                               Diagnostics& diagnostics);

}  // namespace trapeze
