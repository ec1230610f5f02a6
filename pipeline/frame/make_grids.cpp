#include "pipeline/frame/make_grids.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <deque>

#include "composite/film.h"
#include "core/level_of_detail.h"
#include "pipeline/frame/stopwatch.h"
#include "sample/cut_hits.h"

namespace trapeze {
namespace {

/// What a thread needs to make grids.
struct GridMaker {
    std::deque<ShadingGrid> shading_grids;  ///< a batch, memory kept
    DiceScratch dice_scratch;
    ShadeScratch shade_scratch;
    ShadeStats shade_stats;
    GridArena arena;
    std::vector<Grid> grids;
    double dice_seconds = 0, shade_seconds = 0;
};

/// The fewest subpatches that a thread takes at a time.
constexpr size_t kGrain = 4;

/// Points, and curves without normals, have no back.
bool faces_the_eye(const Shape& shape) {
    if (std::holds_alternative<Points>(shape.topology)) return true;
    return std::holds_alternative<Curves>(shape.topology) && !shape.variables.find("N");
}

PackOptions packing(const Scene& scene, const Primitive& primitive) {
    const bool cut = may_be_cut(scene, primitive);
    return {cut || !seen_numbers(*primitive.attributes).are_all() ||
                depth_filter(scene.options) == DepthFilter::Midpoint,
            cut || faces_the_eye(primitive.shape())};
}

/// Dices, shades and packs subpatches from `first` on, one batch; returns the first that is left.
size_t make_batch(const Scene& scene, const Region& region, size_t first, size_t end,
                  const Tessellation& tessellation, const Shading& shading, GridMaker& maker) {
    Stopwatch watch;
    std::vector<ShadingGrid*> batch;
    size_t vertices = 0, next = first;
    for (; next < end && vertices < Shading::kBatchVertices; ++next) {
        if (maker.shading_grids.size() <= batch.size()) maker.shading_grids.emplace_back();
        batch.push_back(&maker.shading_grids[batch.size()]);
        tessellation.dice(region.subpatches[next], *batch.back(), maker.dice_scratch);
        vertices += batch.back()->vertex_count();
    }
    maker.dice_seconds += watch.lap();
    shading.shade(batch, maker.shade_scratch, maker.shade_stats);
    int64_t not_finite = 0;
    for (const ShadingGrid* grid : batch)
        maker.grids.push_back(pack_grid(*grid, maker.arena, &not_finite, packing(scene, *grid->primitive)));
    maker.shade_stats.not_finite_values += static_cast<uint64_t>(not_finite);
    maker.shade_seconds += watch.lap();
    return next;
}

}  // namespace

/// Dices and shades a region's subpatches.
Grids make_grids(const RenderContext& context, const Region& region, const Tessellation& tessellation,
                 const Shading& shading, FrameStats& stats, Progress& progress) {
    Stopwatch wall;
    tbb::enumerable_thread_specific<GridMaker> makers;
    const tbb::blocked_range<size_t> all(0, region.subpatches.size(), kGrain);
    tbb::parallel_for(all, [&](const tbb::blocked_range<size_t>& range) {
        GridMaker& maker = makers.local();
        for (size_t i = range.begin(); i < range.end() && !context.is_cancelled();) {
            const size_t next =
                make_batch(*context.scene, region, i, range.end(), tessellation, shading, maker);
            for (; i < next; ++i) progress.step();
        }
    });

    Grids grids;
    double dice = 0, shade = 0;
    for (GridMaker& maker : makers) {
        grids.grids.insert(grids.grids.end(), maker.grids.begin(), maker.grids.end());
        grids.arenas.push_back(std::move(maker.arena));
        stats.shade += maker.shade_stats;
        dice += maker.dice_seconds, shade += maker.shade_seconds;
    }
    tbb::parallel_sort(grids.grids.begin(), grids.grids.end(),
                       [](const Grid& a, const Grid& b) { return a.ordinal < b.ordinal; });
    stats.tessellate.grids += grids.grids.size();
    stats.tessellate.micropolygons += grids.micropolygon_count();
    const auto [dice_wall, shade_wall] = shared_out(wall.lap(), dice, shade);
    stats.seconds.tessellate += dice_wall;
    stats.seconds.shade += shade_wall;
    return grids;
}

}  // namespace trapeze
