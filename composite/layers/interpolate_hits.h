/// Colours and opacities of hits from the corners of their micropolygons, many hits at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "composite/layers/corner_cache.h"
#include "composite/layers/ray_planes.h"
#include "core/grid.h"
#include "core/hit_buffer.h"

namespace trapeze {

/// Planes of hits: Ci red, green and blue, then Oi.
inline constexpr size_t kLayerPlanes = 6;
/// Numbers behind the last one of a plane that may be read.
inline constexpr size_t kLayerPadding = 16;

/// Hits in the order of their planes. Where those follow each other that lie on one micropolygon, it is
/// looked up once, and its corners are the same in all lanes.
struct HitsToInterpolate {
    const Hit* hits;
    const uint64_t* ids;     ///< Hit::id of each; null: those of `hits`
    const uint32_t* ray_of;  ///< of each
    size_t count;
    RayPlanes& rays;
    const Grids& grids;
    float* const* planes;  ///< a number for each

    uint64_t id(size_t place) const { return ids ? ids[place] : hits[place].id; }
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
