#include "pipeline/frame/make_grids.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <deque>
#include <optional>

#include "pipeline/frame/collect_grids.h"
#include "pipeline/frame/cost/stopwatch.h"
#include "shade/materials/grid_parts.h"

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

/// Subpatches that a thread takes at a time, at least, where there are many.
constexpr size_t kGrain = 4;
/// With fewer subpatches than this for each thread, each is a task of its own, and those that can be are
/// divided, so that there are so many tasks for each thread.
constexpr size_t kFewForAThread = 16, kPartsForAThread = 2;

/// Packs a shaded grid into the thread's grids, and counts its values that are not finite.
void pack(const RenderContext& context, const ShadingGrid& grid, GridMaker& maker) {
    int64_t not_finite = 0;
    PackOptions options = pack_options(*context.scene, *grid.primitive);
    options.float_colors = context.float_colors;
    maker.grids.push_back(pack_grid(grid, maker.arena, &not_finite, options));
    maker.shade_stats.not_finite_values += static_cast<uint64_t>(not_finite);
}

/// Dices a region's i-th subpatch.
void dice(const Region& region, size_t i, const Tessellation& tessellation, ShadingGrid& grid,
          DiceScratch& scratch) {
    tessellation.dice(region.subpatches[i], grid, scratch);
    grid.wanted = region.wanted.empty() ? nullptr : &region.wanted[i];
}

/// Dices, shades and packs subpatches from `first` on, one batch; returns the first that is left.
size_t make_batch(const RenderContext& context, const Region& region, size_t first, size_t end,
                  const Tessellation& tessellation, const Shading& shading, GridMaker& maker) {
    Stopwatch watch;
    std::vector<ShadingGrid*> batch;
    size_t vertices = 0, next = first;
    const size_t most = shading.batch_vertices();
    for (; next < end && vertices < most; ++next) {
        if (maker.shading_grids.size() <= batch.size()) maker.shading_grids.emplace_back();
        batch.push_back(&maker.shading_grids[batch.size()]);
        dice(region, next, tessellation, *batch.back(), maker.dice_scratch);
        vertices += batch.back()->vertex_count();
    }
    maker.dice_seconds += watch.lap();
    shading.shade(batch, maker.shade_scratch, maker.shade_stats);
    for (const ShadingGrid* grid : batch) pack(context, *grid, maker);
    maker.shade_seconds += watch.lap();
    return next;
}

using GridMakers = tbb::enumerable_thread_specific<GridMaker>;

/// Many subpatches: each thread dices some, shades them as a batch and packs them.
void make_many(const RenderContext& context, const Region& region, const Tessellation& tessellation,
               const Shading& shading, Progress& progress, GridMakers& makers) {
    const tbb::blocked_range<size_t> all(0, region.subpatches.size(), kGrain);
    tbb::parallel_for(all, [&](const tbb::blocked_range<size_t>& range) {
        GridMaker& maker = makers.local();
        for (size_t i = range.begin(); i < range.end() && !context.is_cancelled();) {
            const size_t next = make_batch(context, region, i, range.end(), tessellation, shading, maker);
            for (; i < next; ++i) progress.step();
        }
    });
}

/// What a thread shades at a time where there are few grids: a whole grid, or some of its vertices.
struct Part {
    size_t grid = 0, first = 0;
    std::optional<ShadingGrid> own;  ///< nothing: the whole grid
};

/// The work of shading a few grids: whole grids, or parts of those that can be parted, about `wanted` tasks
/// in all.
std::vector<Part> divided(const std::vector<ShadingGrid>& grids, const Shading& shading, size_t wanted) {
    std::vector<Part> parts;
    const size_t for_each_grid = std::max<size_t>(wanted / grids.size(), 1);
    for (size_t g = 0; g < grids.size(); ++g) {
        const size_t vertices = grids[g].vertex_count(), size = part_size(vertices, for_each_grid);
        if (for_each_grid == 1 || size >= vertices || !shading.can_be_parted(grids[g])) {
            parts.push_back({g, 0, {}});
            continue;
        }
        for (size_t first = 0; first < vertices; first += size)
            parts.push_back({g, first, part_of(grids[g], first, std::min(size, vertices - first))});
    }
    return parts;
}

/// Calls use(i, maker) for 0 <= i < count, each i as a task of its own.
template <class Use>
void for_each_alone(const RenderContext& context, size_t count, GridMakers& makers, const Use& use) {
    tbb::parallel_for(
        tbb::blocked_range<size_t>(0, count, 1),
        [&](const tbb::blocked_range<size_t>& range) {
            for (size_t i = range.begin(); i < range.end() && !context.is_cancelled(); ++i)
                use(i, makers.local());
        },
        tbb::simple_partitioner());
}

/// Few grids, whose shaders may take long: dices all, then threads share the shading of each.
void make_few(const RenderContext& context, const Region& region, const Tessellation& tessellation,
              const Shading& shading, size_t threads, Progress& progress, GridMakers& makers) {
    std::vector<ShadingGrid> grids(region.subpatches.size());
    for_each_alone(context, grids.size(), makers, [&](size_t i, GridMaker& maker) {
        Stopwatch watch;
        dice(region, i, tessellation, grids[i], maker.dice_scratch);
        maker.dice_seconds += watch.lap();
    });
    if (context.is_cancelled()) return;
    std::vector<Part> parts = divided(grids, shading, kPartsForAThread * threads);
    for_each_alone(context, parts.size(), makers, [&](size_t i, GridMaker& maker) {
        Stopwatch watch;
        Part& part = parts[i];
        ShadingGrid& whole = grids[part.grid];
        ShadingGrid& shaded = part.own ? *part.own : whole;
        shading.shade(shaded, maker.shade_scratch, maker.shade_stats);
        if (part.first + shaded.vertex_count() == whole.vertex_count()) progress.step();
        maker.shade_seconds += watch.lap();
    });
    if (context.is_cancelled()) return;
    for (const Part& part : parts)
        if (part.own) put_part(*part.own, part.first, grids[part.grid]);
    for_each_alone(context, grids.size(), makers,
                   [&](size_t i, GridMaker& maker) { pack(context, grids[i], maker); });
}

}  // namespace

Grids make_grids(const RenderContext& context, const Region& region, const Tessellation& tessellation,
                 const Shading& shading, FrameStats& stats, Progress& progress) {
    Stopwatch wall;
    GridMakers makers;
    const auto threads = static_cast<size_t>(tbb::this_task_arena::max_concurrency());
    const size_t count = region.subpatches.size();
    if (threads > 1 && count > 0 && count < kFewForAThread * threads)
        make_few(context, region, tessellation, shading, threads, progress, makers);
    else
        make_many(context, region, tessellation, shading, progress, makers);

    double dice = 0, shade = 0;
    for (const GridMaker& maker : makers) {
        stats.shade += maker.shade_stats;
        dice += maker.dice_seconds, shade += maker.shade_seconds;
    }
    Grids grids = collect_grids(makers);
    stats.tessellate.grids += grids.grids.size();
    stats.tessellate.micropolygons += grids.micropolygon_count();
    const auto [dice_wall, shade_wall] = shared_out(wall.lap(), dice, shade);
    stats.seconds.tessellate += dice_wall;
    stats.seconds.shade += shade_wall;
    return grids;
}

}  // namespace trapeze
