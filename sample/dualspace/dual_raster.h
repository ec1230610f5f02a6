/// Micropolygons into samples through bounds in (u, v, time) for each pixel.
#pragma once

#include <cstdint>
#include <vector>

#include "core/grid.h"
#include "core/samples.h"
#include "core/scene/camera.h"
#include "core/stats.h"
#include "sample/dualspace/sample_masks.h"
#include "sample/rasterize/grid_bounds.h"
#include "sample/rasterize/vertex_rows.h"

namespace trapeze {

struct SampleScratch;

/// For each column (or row) of pixels of a tile, when and through what part of an axis of the lens (of the
/// pixel, without a lens) a micropolygon may be seen there: bins of SampleMasks, first to last.
struct DualIntervals {
    static constexpr int kPadding = 16;
    /// Lens samples lie in the unit disk, but for rounding: within this on each axis.
    static constexpr float kLensRim = 1 + 0x1p-16f;

    std::vector<float> low, high;  ///< the image plane at the pixels' sides
    std::vector<int32_t> first_s, last_s, first_t, last_t;

    /// `count` pixels from `first`.
    void set_pixels(int first, int count, float plane_scale, float plane_offset);
    /// Everything, in pixels first to last.
    void see_all(int first, int last);
};

/// A grid during a part of a motion segment, as DualMesh sets it; one entry for each vertex or micropolygon.
struct DualMeshScratch {
    std::vector<float> at[2][3];  ///< [end of the part][component]: vertices in camera space
    std::vector<float> lens[2];   ///< [end]: camera-space radius of the lens times 1 - z / F
    std::vector<float> min[3],
        max[3];  ///< of vertices, in the image plane through any part of the lens; depth
    std::vector<int32_t> x0, x1, y0,
        y1;  ///< pixels of micropolygons from the tile's corner; none where x1 < 0

    /// All planes; what they held before has no meaning afterwards.
    void resize(size_t count);
};

/// A thread's memory, kept from tile to tile: the masks and intervals of the tile, the vertices and boxes of
/// the grid that is being rasterized.
struct DualScratch {
    SampleMasks masks;
    DualIntervals columns, rows;
    VertexRows vertices;
    DualMeshScratch mesh;
    std::vector<SegmentPart> part;
    std::vector<uint32_t> candidates;  ///< samples to test
};

/// A tile, and where what its samples see goes.
struct DualRaster {
    const Camera& camera;
    const SampleTile& samples;
    int parts;        ///< of the shutter, at least, that are bounded apart; a power of two
    bool all_opaque;  ///< else hits are also listed, as buffer_of_loose_hits() takes them
    SampleScratch& scratch;
    DualScratch& own;
};

/// Runs on the best instruction set at hand.
void raster_grid_dual(DualRaster& raster, const BoundedGrid& grid, SampleStats& stats);

}  // namespace trapeze
