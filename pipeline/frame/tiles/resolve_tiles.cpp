#include "pipeline/frame/tiles/resolve_tiles.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <atomic>

#include "pipeline/frame/cost/stopwatch.h"
#include "pipeline/frame/tiles/adaptive_tile.h"
#include "pipeline/frame/tiles/tile_order.h"
#include "sample/hit_lists.h"

namespace trapeze {
namespace {

/// What a thread needs to resolve tiles, and what it has counted.
struct TileResolver {
    SampleTile samples;
    SampleScratch scratch;
    SampleHeat heat;
    LayerPasses passes;
    AdaptiveTile adaptive;
    SampleStats stats;
    uint64_t sample_count = 0;
    double pattern_seconds = 0;  ///< making samples
};

/// Lets the method count the costs of this tile's samples.
void clear_heat(TileResolver& resolver) {
    resolver.heat.tests.assign(resolver.samples.size(), 0);
    resolver.heat.nodes.assign(resolver.samples.size(), 0);
    resolver.scratch.heat = &resolver.heat;
}

/// Writes the means over the samples of each pixel. No two tiles have a pixel in common, so threads need no
/// lock.
void take_heat(const TileResolver& resolver, HeatMap& heat) {
    const SampleTile& samples = resolver.samples;
    const auto count = static_cast<size_t>(samples.samples_per_pixel);
    const auto mean = [count](const std::vector<uint32_t>& costs, size_t first) {
        uint64_t sum = 0;
        for (size_t s = first; s < first + count; ++s) sum += costs[s];
        return static_cast<float>(static_cast<double>(sum) / static_cast<double>(count));
    };
    for (int y = samples.pixels.y0; y < samples.pixels.y1; ++y)
        for (int x = samples.pixels.x0; x < samples.pixels.x1; ++x) {
            const size_t first = samples.first_of_pixel(x, y), at = heat.index(x, y);
            heat.tests[at] = mean(resolver.heat.tests, first);
            heat.nodes[at] = mean(resolver.heat.nodes, first);
            heat.samples[at] = static_cast<float>(count);
        }
}

}  // namespace

void resolve_tiles(const RenderContext& context, const PixelRect& pixels, const Grids& grids,
                   const Visibility& visibility, const SamplePattern& pattern, Film& film, FrameStats& stats,
                   const std::function<void()>& on_step, const ResolveOptions& options) {
    const LayerLimits& limits = options.limits;
    HeatMap* const heat = options.heat;
    Stopwatch wall;
    const bool all_opaque = every_grid_is_opaque(grids);
    const bool adaptive = pattern.levels() != nullptr;
    std::vector<PixelRect> tiles = tiles_of(pixels, adaptive ? kTileSide : visibility.tile_side());
    if (options.order == TileOrder::CoarseFirst) tiles = coarse_first(tiles);
    tbb::enumerable_thread_specific<TileResolver> resolvers;
    const auto resolve = [&](size_t i) {
        if (context.is_cancelled()) return;
        if (!film.awaits(tiles[i])) return on_step();
        TileResolver& resolver = resolvers.local();
        if (adaptive) {
            resolver.sample_count +=
                resolver.adaptive.add({context, pattern, visibility, grids, all_opaque, limits, film},
                                      tiles[i], resolver.passes, resolver.scratch, resolver.stats);
            if (heat) resolver.adaptive.count_samples(*heat);
            on_step();
            return;
        }
        Stopwatch watch;
        pattern.make_tile(tiles[i], resolver.samples);
        if (heat) clear_heat(resolver);
        resolver.pattern_seconds += watch.lap();
        resolver.sample_count += resolver.samples.size();
        resolver.passes.add_tile({visibility, grids, all_opaque, limits, film}, resolver.samples,
                                 resolver.scratch, resolver.stats);
        if (heat) take_heat(resolver, *heat);
        on_step();
    };
    // Tiles differ in cost by ten and more: one at a time, or a thread is left alone with a run of slow ones.
    // In their order, whichever part of the range a thread has: threads would begin far from each other.
    std::atomic<size_t> next{0};
    const auto resolve_next = [&](size_t) { resolve(next.fetch_add(1, std::memory_order_relaxed)); };
    if (options.order == TileOrder::CoarseFirst)
        tbb::parallel_for(size_t{0}, tiles.size(), resolve_next, tbb::simple_partitioner());
    else
        tbb::parallel_for(size_t{0}, tiles.size(), resolve, tbb::simple_partitioner());
    double trace = 0, composite = 0;
    uint64_t list_bytes = 0;
    for (const TileResolver& resolver : resolvers) {
        const LayerCosts& costs = resolver.passes.costs();
        stats.sample += resolver.stats;
        stats.samples += resolver.sample_count;
        stats.layer_passes += costs.further_passes;
        stats.shows_something = stats.shows_something || costs.shows_something;
        list_bytes += costs.list_bytes;
        trace += resolver.pattern_seconds + resolver.adaptive.pattern_seconds() + costs.trace_seconds;
        composite += costs.composite_seconds + resolver.adaptive.composite_seconds();
    }
    stats.hit_list_bytes = std::max(stats.hit_list_bytes, list_bytes);
    const auto [trace_wall, composite_wall] = shared_out(wall.lap(), trace, composite);
    stats.seconds.trace += trace_wall;
    stats.seconds.composite += composite_wall;
}

}  // namespace trapeze
