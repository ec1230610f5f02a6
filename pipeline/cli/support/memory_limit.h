/// The last of the bounds on memory: what the system lets the process have.
#pragma once

#include <cstddef>

namespace trapeze {

/// Bounds the process's memory from now on: four times the budget, which a file, its scene and the grids may
/// each take, and a gibibyte for everything else. What needs more ends the process with kExitNoMemory.
/// Programs built with sanitizers, whose own memory counts, are not bounded.
void limit_memory(size_t budget);

}  // namespace trapeze
