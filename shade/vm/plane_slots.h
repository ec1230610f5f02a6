/// Which varying registers may share memory because they are never alive together.
#pragma once

#include <cstdint>
#include <vector>

#include "shade/code/program.h"

namespace trapeze::vm {

/// Places in a block of planes, in planes.
struct PlaneSlots {
    std::vector<uint32_t> first;  ///< plane of each register; unused for those that are not varying
    uint32_t planes = 0;          ///< of all together
};

/// Planes that a register of this type takes.
uint32_t plane_count(const rsl::Type& type);

/// Parameters and predefined variables keep theirs, for others may read them after the run, as does what the
/// parameters' defaults use; locals and temporaries get a linear scan over their lifetimes in program.code.
PlaneSlots assign_plane_slots(const rsl::Program& program);

}  // namespace trapeze::vm
