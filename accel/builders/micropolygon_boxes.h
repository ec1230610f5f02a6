/// Single micropolygons as what the SAH divides: for the tree without parametric splits, and for measuring
/// how good those splits are.
#pragma once

#include <vector>

#include "accel/builders/grid_summary.h"
#include "accel/builders/sah_topology.h"
#include "core/grid.h"
#include "core/memory/large_pages.h"

namespace trapeze {

/// The micropolygon that comes as number i of a grid's in the order of rows.
inline MicropolygonId micropolygon_of_grid(size_t grid, const GridShape& shape, int i) {
    return {static_cast<uint32_t>(grid), static_cast<uint8_t>(i % shape.nu),
            static_cast<uint8_t>(i / shape.nu)};
}

/// Writes the boxes of a grid's micropolygons in some axes, at a time of [0, 1], row by row (u fastest), into
/// nu
/// * nv items of weight 1, whose ids count from `first_id`.
void boxes_of_grid(const Grid& grid, const Axes& axes, float time01, uint32_t first_id, SahItem* items);

/// All micropolygons, in the order of grids and then of rows, and their axis-aligned boxes at mid-shutter:
/// items[i] is ids[i] until the SAH sorts the items, and items keep i as their id. A micropolygon of a grid
/// without a bound is a point at the origin. There are at most 2^31 micropolygons: links of the topology
/// count them in 31 bits.
void micropolygon_items(const Grids& grids, const std::vector<GridSummary>& summaries,
                        UnsetVector<MicropolygonId>& ids, UnsetVector<SahItem>& items);

}  // namespace trapeze
