#include "pipeline/frame/cull_hidden.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <optional>

#include "pipeline/frame/collect_grids.h"
#include "sample/hit_lists.h"

namespace trapeze {
namespace {

constexpr size_t kSubpatchesATask = 16;

/// A thread's memory for grids without shading.
struct PlainGridMaker {
    ShadingGrid grid;
    DiceScratch scratch;
    GridArena arena;
    std::vector<Grid> grids;
};

/// Grids of the candidates, where they will be once they are shaded. They hide what is behind them only where
/// it is known that no shader lets that through.
Grids plain_grids(const RenderContext& context, const std::vector<uint32_t>& candidates,
                  const Tessellation& tessellation, const Shading& shading) {
    tbb::enumerable_thread_specific<PlainGridMaker> makers;
    tbb::parallel_for(tbb::blocked_range<size_t>(0, candidates.size(), kSubpatchesATask),
                      [&](const auto& range) {
                          PlainGridMaker& maker = makers.local();
                          for (size_t i = range.begin(); i != range.end() && !context.is_cancelled(); ++i) {
                              ShadingGrid& grid = maker.grid;
                              tessellation.dice(candidates[i], grid, maker.scratch, DiceFor::Hits);
                              grid.aovs.clear();
                              grid.Ci.fill(grid.vertex_count(), V3f(0));
                              grid.Oi.fill(grid.vertex_count(), V3f(1));
                              PackOptions options = pack_options(*context.scene, *grid.primitive);
                              if (!shading.hides_for_sure(grid.primitive_index))
                                  options.keep_hits_behind = true;
                              int64_t not_finite = 0;
                              maker.grids.push_back(pack_grid(grid, maker.arena, &not_finite, options));
                          }
                      });
    return collect_grids(makers);
}

/// What a thread needs to look at tiles.
struct TileLooker {
    SampleTile samples;
    HitBuffer hits;
    SampleScratch scratch;
    SampleStats stats;
};

/// For each grid, whether a sample of some pixels has a hit on it; nothing where there is no room for all
/// hits.
std::optional<std::vector<std::atomic<bool>>> seen_grids(const RenderContext& context,
                                                         const PixelRect& pixels, const Grids& grids,
                                                         const Visibility& visibility,
                                                         const SamplePattern& pattern,
                                                         const LayerLimits& limits) {
    std::vector<std::atomic<bool>> seen(grids.grids.size());
    std::atomic<bool> has_room{true};
    const bool bounded = !every_grid_is_opaque(grids);
    const std::vector<PixelRect> tiles = tiles_of(pixels, visibility.tile_side());
    tbb::enumerable_thread_specific<TileLooker> lookers;
    const auto look = [&](size_t i) {
        if (context.is_cancelled() || !has_room.load(std::memory_order_relaxed)) return;
        TileLooker& looker = lookers.local();
        pattern.make_tile(tiles[i], looker.samples);
        looker.scratch.window = bounded ? LayerWindow{{}, limits.most, limits.room} : LayerWindow{};
        const bool fits = !bounded || looker.samples.size() <= limits.room / 2;
        if (fits) visibility.resolve(looker.samples, looker.hits, looker.scratch, looker.stats);
        if (!fits || !holds_all(looker.scratch, looker.hits, limits.most))
            return has_room.store(false, std::memory_order_relaxed);
        for (const Hit& hit : looker.hits.hits)
            seen[MicropolygonId::unpack(hit.id).grid].store(true, std::memory_order_relaxed);
    };
    tbb::parallel_for(size_t{0}, tiles.size(), look, tbb::simple_partitioner());
    if (!has_room.load()) return {};
    return seen;
}

}  // namespace

std::vector<uint32_t> seen_subpatches(const RenderContext& context, const Region& region,
                                      const Tessellation& tessellation, const Shading& shading,
                                      const Sampler& sampler, const SamplePattern& pattern,
                                      const LayerLimits& limits, FrameStats& stats) {
    std::vector<uint32_t> candidates, shaded;
    for (const uint32_t subpatch : region.subpatches) {
        const bool may_stay = shading.may_stay_unshaded(tessellation.subpatches()[subpatch].primitive);
        (may_stay ? candidates : shaded).push_back(subpatch);
    }
    const Grids grids = plain_grids(context, candidates, tessellation, shading);
    if (context.is_cancelled() || grids.grids.empty()) return region.subpatches;
    const std::unique_ptr<Visibility> visibility = sampler.prepare(context, grids);
    const auto seen = seen_grids(context, region.pixels, grids, *visibility, pattern, limits);
    if (!seen) return region.subpatches;
    for (size_t g = 0; g < seen->size(); ++g) {
        if ((*seen)[g].load(std::memory_order_relaxed)) {
            shaded.push_back(static_cast<uint32_t>(grids.grids[g].ordinal));
            continue;
        }
        ++stats.unshaded_grids;
        stats.unshaded_vertices += static_cast<uint64_t>(grids.grids[g].shape.vertex_count());
    }
    std::ranges::sort(shaded);
    return shaded;
}

}  // namespace trapeze
