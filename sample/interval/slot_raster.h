/// Micropolygons into the samples of one slot: boxes that hold for the slot's part of the shutter and of the
/// lens, then the predicate on the samples in them.
#pragma once

#include <cstdint>
#include <vector>

#include "core/grid.h"
#include "core/scene/camera.h"
#include "core/stats.h"
#include "sample/interval/sample_slots.h"
#include "sample/rasterize/grid_bounds.h"

namespace trapeze {

struct SampleScratch;
struct SlotGridScratch;

/// A tile whose samples are in slots, and where what they see goes.
struct SlotRaster {
    const Camera& camera;
    SampleSlots& slots;
    int tile_x = 0, tile_y = 0;  ///< the tile's corner
    bool all_opaque = true;      ///< else hits are also listed, as buffer_of_loose_hits() takes them
    bool cull = false;           ///< skip what lies behind the nearest opaque hits
    bool sparse = false;         ///< cells hold few of their pixels: pixels are looked at before samples
    SampleScratch& scratch;
};

/// A slot, and what it means for a grid.
struct GridInSlot {
    const Grid& grid;
    uint32_t index;
    const GridBound& bound;
    size_t slot;
    const std::vector<SegmentPart>& parts;
    const LensBox& lens;
    PixelRect pixels;  ///< of the tile, from its corner, that the grid may cover
    float z_min;       ///< no deeper than any of its micropolygons
};

/// Tests a grid's micropolygons against the samples of one slot of a tile, on the best instruction set at
/// hand.
void raster_grid(SlotRaster& raster, const GridInSlot& grid, SlotGridScratch& scratch, SampleStats& stats);

}  // namespace trapeze
