/// What a frame cost: seconds by stage, counts, bytes. A value; the command line writes it as JSON.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/picture_tile.h"
#include "core/stats.h"

namespace trapeze {

/// Wall seconds of a frame's stages.
struct StageSeconds {
    double read = 0, tessellate = 0, shade = 0, build = 0, trace = 0, composite = 0, total = 0;
    double cull = 0;  ///< finding what is hidden, before it is shaded
    double rays = 0;  ///< making what rays of shaders meet; tracing them is part of shading

    StageSeconds& operator+=(const StageSeconds& o) {
        read += o.read, tessellate += o.tessellate, shade += o.shade, build += o.build;
        trace += o.trace, composite += o.composite, total += o.total, rays += o.rays, cull += o.cull;
        return *this;
    }
};

struct FrameStats {
    StageSeconds seconds;  ///< wall clock; work of a parallel loop is shared out by the threads' own times
    TessellateStats tessellate;
    ShadeStats shade;
    BuildStats build;  ///< summed over regions
    SampleStats sample;
    /// The most of any region, each by itself: bytes of grids, of grids and tree, of the tree.
    uint64_t grid_bytes = 0, peak_region_bytes = 0, tree_bytes = 0;  ///< largest region's
    uint64_t samples = 0;
    /// Passes over tiles beyond the first, as layers took too much memory; the most bytes that all threads'
    /// lists of hits took, each thread's most added up.
    uint64_t layer_passes = 0, hit_list_bytes = 0;
    /// Of the geometry that rays of shaders meet: all, those made (again, too, where memory is short), bytes
    /// of grids and trees that are held at the end, bytes of lists.
    uint64_t ray_micropolygons = 0, ray_micropolygons_made = 0, ray_bytes = 0, ray_list_bytes = 0;
    /// Grids, and their vertices, that no sample sees and that were not shaded (CullHidden).
    uint64_t unshaded_grids = 0, unshaded_vertices = 0;
    int regions = 0, threads = 0, width = 0, height = 0, frame = 0;
    bool shows_something = false;  ///< whether any sample has hit anything
    std::string sampler, simd_target;
    std::optional<PictureTile> tile;  ///< what was made, if that is not the whole crop
    struct Output {
        std::string path;
        uint64_t bytes = 0;
        double seconds = 0;  ///< of writing
    };
    std::vector<Output> outputs;

    double rays_per_second() const {
        return seconds.trace > 0 ? static_cast<double>(sample.rays) / seconds.trace : 0;
    }
};

/// Peak resident memory of this process so far, in bytes.
uint64_t peak_resident_bytes();

}  // namespace trapeze
