/// Which registers hold a value for each vertex and which hold one for all, and what has to be done under a
/// mask.
#pragma once

#include <set>
#include <string>
#include <string_view>

#include "shade/code/program.h"

namespace trapeze::rsl {

/// Sets Register::varying, Instruction::varying and Instruction::masked. What the source declares is kept for
/// parameters alone: a local variable is uniform when all that it is given is uniform, wherever lanes do not
/// go separate ways. `varying` names the parameters that are given a value for each vertex. Once for a
/// program: instructions' flags are only ever set, so that another layout begins with another copy.
void infer_storage(Program& program, const std::set<std::string>& varying);

/// Predefined variables that have one value for a grid. E is the eye, at the origin of camera space; time and
/// dtime are the shutter's.
bool is_uniform_global(std::string_view name);

}  // namespace trapeze::rsl
