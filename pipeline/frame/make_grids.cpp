#include "pipeline/frame/make_grids.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include "pipeline/frame/stopwatch.h"

namespace trapeze {
namespace {

/// What a thread needs to make grids.
struct GridMaker {
    ShadingGrid shading_grid;
    DiceScratch dice_scratch;
    ShadeScratch shade_scratch;
    ShadeStats shade_stats;
    GridArena arena;
    std::vector<Grid> grids;
    double dice_seconds = 0, shade_seconds = 0;
};

}  // namespace

/// Dices and shades a region's subpatches.
Grids make_grids(const RenderContext& context, const Region& region, const Tessellation& tessellation,
                 const Shading& shading, FrameStats& stats, Progress& progress) {
    Stopwatch wall;
    tbb::enumerable_thread_specific<GridMaker> makers;
    tbb::parallel_for(size_t{0}, region.subpatches.size(), [&](size_t i) {
        if (context.is_cancelled()) return;
        GridMaker& maker = makers.local();
        Stopwatch watch;
        tessellation.dice(region.subpatches[i], maker.shading_grid, maker.dice_scratch);
        maker.dice_seconds += watch.lap();
        shading.shade(maker.shading_grid, maker.shade_scratch, maker.shade_stats);
        int64_t not_finite = 0;
        maker.grids.push_back(pack_grid(maker.shading_grid, maker.arena, &not_finite));
        maker.shade_stats.not_finite_values += static_cast<uint64_t>(not_finite);
        maker.shade_seconds += watch.lap();
        progress.step();
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
