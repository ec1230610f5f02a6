#include "sample/rasterize/rasterizer.h"

#include <algorithm>

#include "sample/hit_lists.h"

namespace trapeze {

/// Bins and bounds are all that is prepared; what a method needs for a micropolygon it makes when the
/// micropolygon comes.
Rasterizer::Rasterizer(const VisibilityInput& input, int tile_side)
    : context_(input.context),
      grids_(input.grids),
      tile_side_(tile_side),
      cull_(input.spec.has("cull") && input.spec.is_on("cull")),
      all_opaque_(every_grid_is_opaque(input.grids)),
      bins_(input.context.camera, input.grids, tile_side),
      bounds_(input.context.camera, input.grids) {}

/// Culling needs grids front to back. The hits do not depend on their order: equal depths are told apart by
/// id.
void Rasterizer::resolve(const SampleTile& samples, HitBuffer& hits, SampleScratch& scratch,
                         SampleStats& stats) const {
    std::vector<uint32_t>& grids = scratch.own.of<RasterizerScratch>().grids;
    bins_.find(samples.pixels, grids);
    if (cull_)
        std::stable_sort(grids.begin(), grids.end(),
                         [this](uint32_t a, uint32_t b) { return bounds_[a].z_min < bounds_[b].z_min; });
    scratch.nearest.assign(samples.size(), Hit{kInfinity, MicropolygonId::kNone});
    scratch.found.begin(samples.size(), scratch.window);
    raster(samples, grids, scratch, stats);
    stats.rays += samples.size();
    if (all_opaque_)
        buffer_of_nearest(scratch, samples.size(), hits);
    else
        buffer_of_loose_hits(scratch, samples.size(), hits);
}

/// Rasterizers have no tree: what they keep for finding grids is counted in its place.
BuildStats Rasterizer::build_stats() const {
    BuildStats stats;
    stats.tree_bytes = bins_.bytes() + bounds_.bytes();
    return stats;
}

}  // namespace trapeze
