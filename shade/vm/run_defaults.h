/// Defaults of parameters may be any expressions. Those that look at the point, at maps, or at what else is
/// around a run are known only when the shader runs.
#pragma once

#include <vector>

#include "shade/code/program.h"

namespace trapeze::vm {

/// For each of program.parameters, whether its default is to be computed in each run: it reads predefined
/// variables, asks the surroundings, or reads a parameter before it of which this holds. Others are the same
/// in all runs.
std::vector<bool> has_run_default(const rsl::Program& program);

/// Whether code may ask for the space named "object".
bool may_ask_object_space(const rsl::Program& program, const rsl::Code& code);

}  // namespace trapeze::vm
