/// Single micropolygons as what the SAH divides.
#pragma once

#include <vector>

#include "accel/builders/grid_summary.h"
#include "accel/builders/sah_topology.h"
#include "core/grid.h"

namespace trapeze {

/// The boxes in a frame, at a time, of a grid's micropolygons, row by row into nu * nv items, whose ids count
/// from `first_id`.
void boxes_of_grid(const Grid& grid, const Frame& frame, float time01, uint32_t first_id, SahItem* items);

/// All micropolygons in order, and their axis-aligned boxes at mid-shutter. What has no bound is a point.
void micropolygon_items(const Grids& grids, const std::vector<GridSummary>& summaries,
                        std::vector<MicropolygonId>& ids, std::vector<SahItem>& items);

}  // namespace trapeze
