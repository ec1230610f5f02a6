/// The last of the bounds on memory: what the system lets the process have.
#pragma once

#include <cstddef>

namespace trapeze {

/// From now on the process gets no more than four times the budget, which a file, its scene and the grids may
/// each take, and a gibibyte for everything else. Beyond it ends with kExitNoMemory. Programs built with
/// sanitizers, whose own memory counts, stay as they are.
void limit_memory(size_t budget);

}  // namespace trapeze
