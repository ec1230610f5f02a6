/// Colours and opacities of hits from the corners of their micropolygons, many hits at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "composite/layers/corner_cache.h"
#include "core/grid.h"
#include "core/hit_buffer.h"
#include "core/rays.h"

namespace trapeze {

/// Planes of hits: Ci red, green and blue, then Oi.
inline constexpr size_t kLayerPlanes = 6;

struct HitsToInterpolate {
    std::span<const Hit> hits;
    const uint32_t* ray_of;  ///< of each hit
    const AxisRay* rays;
    const Grids& grids;
    float* const* planes;  ///< a number for each hit
};

/// What is known of some hits.
struct HitKinds {
    bool all_cover = true;  ///< all are on grids that hide all behind them, whatever their colour
    bool all_plain = true;  ///< all are on grids that are there and hold nothing out
};

/// Writes the planes, to the bit as layer_at() has them. Those of hits on grids that are not there are
/// undefined.
HitKinds interpolate_hits(const HitsToInterpolate& task, CornerCache& cache);

}  // namespace trapeze
