#include "pipeline/study/sequence.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <bit>

#include "pipeline/compare/value_text.h"
#include "pipeline/frame/cost/stopwatch.h"
#include "pipeline/frame/tiles/resolve_tiles.h"
#include "pipeline/frame/tiles/tile_order.h"

namespace trapeze {
namespace {

/// Samples of a frame's picture, tile by tile; every frame has the same.
std::vector<SampleTile> samples_of(const Sequence& sequence, const Sampler& sampler, int side) {
    const auto pattern = sampler.make_pattern(*sequence.context);
    const auto rects = tiles_of(sequence.pixels, side);
    std::vector<SampleTile> tiles(rects.size());
    tbb::parallel_for(size_t{0}, tiles.size(), [&](size_t i) { pattern->make_tile(rects[i], tiles[i]); });
    return tiles;
}

/// Finds the hits of all tiles; what that cost.
SampleStats trace_tiles(const std::vector<SampleTile>& tiles, const Visibility& visibility,
                        std::vector<HitBuffer>& hits) {
    hits.resize(tiles.size());
    tbb::enumerable_thread_specific<SampleScratch> scratch;
    tbb::enumerable_thread_specific<SampleStats> stats;
    tbb::parallel_for(
        size_t{0}, tiles.size(),
        [&](size_t i) { visibility.resolve(tiles[i], hits[i], scratch.local(), stats.local()); },
        tbb::simple_partitioner());
    return stats.combine([](SampleStats a, const SampleStats& b) { return a += b; });
}

/// A sum over what samples see, bits of depths too, whatever the order of the tiles.
uint64_t hash_of(const std::vector<HitBuffer>& tiles) {
    uint64_t sum = 0;
    for (const HitBuffer& tile : tiles)
        for (const Hit& hit : tile.hits) {
            const uint64_t depth = std::bit_cast<uint32_t>(hit.depth);
            const uint64_t mixed = (hit.id ^ depth << 32) * 0x9E3779B97F4A7C15u;
            sum += mixed ^ mixed >> 29;
        }
    return sum;
}

}  // namespace

SequenceTimes::SequenceTimes(size_t frames)
    : update(kSequenceRowCount, std::vector<std::vector<double>>(frames)),
      trace(update),
      seen(kSequenceRowCount, std::vector<uint64_t>(frames)),
      nodes(kSequenceRowCount),
      tests(kSequenceRowCount),
      sah(kSequenceRowCount, std::vector<double>(frames)) {}

paper::SequenceCosts SequenceTimes::costs(size_t row, size_t frame) const {
    return {median(update[row][frame]), median(trace[row][frame])};
}

paper::SequenceCosts SequenceTimes::mean_costs(size_t row) const {
    paper::SequenceCosts sum{0, 0};
    const size_t frames = update[row].size();
    for (size_t frame = 1; frame < frames; ++frame) {
        const paper::SequenceCosts one = costs(row, frame);
        sum.update += one.update / static_cast<double>(frames - 1);
        sum.trace += one.trace / static_cast<double>(frames - 1);
    }
    return sum;
}

void follow(const StudyBench& bench, const Sequence& sequence, size_t row, SequenceTimes& times) {
    std::string error;
    const Sampler sampler = choose_sampler(kSequenceRows[row].method, "", &error).value();
    std::unique_ptr<Visibility> tree;
    std::vector<SampleTile> tiles;
    std::vector<HitBuffer> hits;
    SampleStats all;
    for (size_t f = 0; f < sequence.frames.size(); ++f) {
        bench.go_on();
        const Grids& grids = *sequence.frames[f];
        Stopwatch watch;
        const bool told = kSequenceRows[row].told && !sequence.changed.empty();
        if (!tree || !tree->update(grids, told ? &sequence.changed[f] : nullptr))
            tree = sampler.prepare(*sequence.context, grids);
        times.update[row][f].push_back(watch.lap());
        if (tiles.empty()) tiles = samples_of(sequence, sampler, tree->tile_side());
        watch.lap();
        const SampleStats stats = trace_tiles(tiles, *tree, hits);
        times.trace[row][f].push_back(watch.lap());
        times.seen[row][f] = hash_of(hits);
        times.sah[row][f] = tree->build_stats().tree_sah_cost;
        bench.figure(fmt::format(
            "{}, frame {}, {}: update {}, trace {}, {} nodes a ray", sequence.label, f,
            kSequenceRows[row].name, seconds_text(times.update[row][f].back()),
            seconds_text(times.trace[row][f].back()),
            number_text(static_cast<double>(stats.nodes_visited) / static_cast<double>(stats.rays))));
        all += stats;
    }
    const auto a_ray = [&](uint64_t count) {
        return static_cast<double>(count) / static_cast<double>(all.rays);
    };
    times.nodes[row] = a_ray(all.nodes_visited), times.tests[row] = a_ray(all.predicate_tests);
}

}  // namespace trapeze
