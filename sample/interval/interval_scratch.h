/// What a thread needs for the method "interval".
#pragma once

#include <cstdint>
#include <vector>

#include "sample/interval/sample_slots.h"
#include "sample/rasterize/grid_bounds.h"

namespace trapeze {

/// A grid's vertices in a slot, row by row, and its micropolygons' boxes. Overwritten for each grid in each
/// slot.
struct SlotGridScratch {
    std::vector<float> vertices;                                  ///< [part][component][vertex]
    std::vector<float> min_x, max_x, min_y, max_y, min_z, max_z;  ///< of vertices
    std::vector<int32_t> x0, x1, y0, y1;  ///< pixels of micropolygons; none when x0 > x1
    std::vector<float> depth;             ///< least depth of micropolygons
    std::vector<uint32_t> rows_of_cell;   ///< bits of the rows of micropolygons that may reach a cell
};

/// One per thread, reused from tile to tile.
struct IntervalScratch {
    std::vector<uint32_t> still, blurred;  ///< of the tile
    std::vector<uint32_t> key_of_pixel;
    std::vector<SegmentPart> parts;
    SampleSlots slots;
    SlotGridScratch grid;
};

}  // namespace trapeze
