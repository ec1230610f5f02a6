/// When a moving micropolygon reaches into a cell: closer than its box can tell, as of a hair that runs
/// across many cells and whose box fills them.
#pragma once

#include "accel/moving/shutter_span.h"
#include "core/grid.h"

namespace trapeze {

/// The shortest span of `within` that separating axes can tell to hold all times at which the micropolygon
/// reaches into the cell. The axes are those of its plane and of its edges with the axes of space, as they
/// are at `pose_time`: any fixed axis tells the truth while things move, these tell most. For coordinates
/// within kBoundableCoordinate.
ShutterSpan when_in_cell(const Grid& grid, const MicropolygonId& id, float pose_time, const Box3f& cell,
                         ShutterSpan within);

}  // namespace trapeze
