/// The binary tree over grids: centroid SAH with the orientation-aware fallback [Hou10 sec. 3.3], one grid a
/// leaf, a grid's cost being its micropolygons.
#pragma once

#include <span>

#include "accel/builders/grid_summary.h"
#include "accel/builders/sah_topology.h"

namespace trapeze {

/// The topology over some grids, whose leaf links are indices of grids. `orient_split`: see PaperTreeOptions;
/// false takes the best split even where it saves nothing. Deterministic, whatever the number of threads.
TopTopology build_top_topology(std::span<const GridSummary> grids, bool orient_split = true);

}  // namespace trapeze
