/// Micropolygons into the pictures of tuples: at a tuple's time and lens point a grid is a still mesh seen
/// through a pinhole.
#pragma once

#include <cstdint>
#include <vector>

#include "core/grid.h"
#include "core/scene/camera.h"
#include "core/stats.h"
#include "sample/interleave/uvt_tile.h"
#include "sample/rasterize/grid_bounds.h"
#include "sample/rasterize/vertex_rows.h"

namespace trapeze {

struct SampleScratch;

/// The tuples at which a grid may cover part of a tile, in the order of tuples.
struct UvtGridTuples {
    size_t count = 0;
    std::vector<int32_t> tuple;
    std::vector<float> slack;    ///< see RoundingSlack; in the image plane
    std::vector<float> careful;  ///< not 0: parts may be too near to be bounded, or clipped
    /// For culling, at each tuple: a depth that nothing of the grid is nearer than, and the first and last
    /// cells that the grid may cover.
    std::vector<float> z_min;
    std::vector<int32_t> first_x, last_x, first_y, last_y;

    /// Starts with no tuples; there will be `size` at most.
    void clear(size_t size) {
        count = 0;
        for (auto* plane : {&slack, &careful, &z_min}) plane->resize(size);
        for (auto* plane : {&tuple, &first_x, &last_x, &first_y, &last_y}) plane->resize(size);
    }
};

/// Micropolygons that a sample may see, to be tested. Pairs are collected over micropolygons, because one
/// micropolygon covers few samples of a tuple and a vector wants many.
struct UvtQueue {
    /// All lanes of a vector may be added to a queue that is not yet full.
    static constexpr size_t kFull = 256, kPadding = 16;

    size_t count = 0;
    int32_t quad[kFull + 2 * kPadding];   ///< its 00
    int32_t pixel[kFull + 2 * kPadding];  ///< as cell_pixels()
};

/// A thread's memory, kept from tile to tile. Planes of vertices are in the order of `rows`, padded to whole
/// vectors; what is at a tuple's time is overwritten by the next tuple.
struct UvtScratch {
    UvtTile tile;
    UvtGridTuples tuples;
    VertexRows rows;
    std::vector<float> inverse_z;  ///< of still grids
    std::vector<float> x, y, z;    ///< vertices at the tuple's time
    std::vector<float> raster_x, raster_y;
    /// Boxes of micropolygons, and their least depths, that are the same for all tuples.
    std::vector<float> x0, x1, y0, y1, depth;
    UvtQueue queue;
};

/// A tile, and where what its samples see goes.
struct UvtRaster {
    const Camera& camera;
    const InterleavedPattern& pattern;
    const UvtTuples& tuples;
    PixelRect pixels;        ///< the tile's
    bool all_opaque = true;  ///< else hits are also listed, as buffer_of_loose_hits() takes them
    bool cull = false;       ///< skip what lies behind the nearest opaque hits
    SampleScratch& scratch;
    UvtScratch& own;
};

/// Runs on the best instruction set at hand.
/// Adds what a grid's micropolygons give the tile's samples: nearest opaque hits in raster.own.tile, others
/// listed in raster.scratch. Grids may come in any order.
void raster_grid_uvt(UvtRaster& raster, const BoundedGrid& grid, SampleStats& stats);

}  // namespace trapeze
