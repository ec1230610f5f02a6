/// Trees over the frames of a sequence: updated, refitted, or built anew [DynBvh06 table 1 and figure 7].
#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>

#include "pipeline/compare/value_text.h"
#include "pipeline/frame/regions.h"
#include "pipeline/frame/resolve_tiles.h"
#include "pipeline/frame/stopwatch.h"
#include "pipeline/study/moving_checks.h"
#include "pipeline/study/studies.h"

namespace trapeze {
namespace {

constexpr int kSequenceFrames = 11;     ///< as the report has of its falling triangles
constexpr double kBetweenFrames = .24;  ///< seconds

/// A row of the tables. Of a tree that cannot be updated, each frame's is built.
struct SequenceRow {
    const char *name, *method;
};

// The first three are those of paper::kFalling.
constexpr SequenceRow kSequenceRows[] = {
    {"inserted anew (Goldsmith-Salmon)", "raytrace:tree=gs"},
    {"updated (dynamic)", "raytrace:tree=dynamic"},
    {"loose", "raytrace:tree=loose"},
    {"updated, nodes thinned at 1.2", "raytrace:tree=dynamic,thinning=1.2"},
    {"loose, all at the lowest level", "raytrace:tree=loose,place=lowest"},
    {"refitted", "raytrace:tree=refit,bundle=off"},
    {"interpolated boxes, built anew", "raytrace:tree=interpolated,bundle=off"},
    {"linear, built anew", "raytrace:tree=lbvh,bundle=off"},
    {"hyper-trapezoids, built anew", "raytrace:tree=paper,bundle=off"},
    {"Trapeze's wide tree, built anew", "raytrace"}};
constexpr size_t kSequenceRowCount = std::size(kSequenceRows), kRefittedRow = 5, kInterpolatedRow = 6;

/// Seconds by row, then frame, then round.
using SequenceSeconds = std::vector<std::vector<std::vector<double>>>;

struct SequenceTimes {
    SequenceSeconds update{kSequenceRowCount, std::vector<std::vector<double>>(kSequenceFrames)};
    SequenceSeconds trace = update;
    std::vector<std::vector<uint64_t>> seen{kSequenceRowCount,
                                            std::vector<uint64_t>(kSequenceFrames)};  ///< hits' hash
    std::vector<double> nodes, tests;  ///< a ray, by row: means of the frames
    /// By row, then frame; 0 where a tree does not count it.
    std::vector<std::vector<double>> sah{kSequenceRowCount, std::vector<double>(kSequenceFrames)};

    paper::SequenceCosts costs(size_t row, int frame) const {
        return {median(update[row][static_cast<size_t>(frame)]),
                median(trace[row][static_cast<size_t>(frame)])};
    }
    /// Means of the frames but the first, which is built by all.
    paper::SequenceCosts mean_costs(size_t row) const {
        paper::SequenceCosts sum{0, 0};
        for (int frame = 1; frame < kSequenceFrames; ++frame) {
            const paper::SequenceCosts one = costs(row, frame);
            sum.update += one.update / (kSequenceFrames - 1), sum.trace += one.trace / (kSequenceFrames - 1);
        }
        return sum;
    }
};

std::vector<SharedFrame> sequence_frames(StudyBench& bench) {
    std::vector<SharedFrame> frames;
    for (int i = 0; i < kSequenceFrames; ++i) {
        StudyScene scene = bench.scene(fmt::format("Falling triangles, frame {}", i), "falling", 1);
        SceneParameters& p = scene.parameters;
        p.motion = p.defocus = 0, p.time = kBetweenFrames * i;
        frames.push_back(bench.frame(scene));
    }
    return frames;
}

/// Samples of a frame's picture, tile by tile; every frame has the same.
std::vector<SampleTile> samples_of(const RenderContext& context, const PixelRect& pixels,
                                   const Sampler& sampler, int side) {
    const auto pattern = sampler.make_pattern(context);
    const auto rects = tiles_of(pixels, side);
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

/// Follows the sequence once with one row's tree.
void follow(const StudyBench& bench, const std::vector<SharedFrame>& frames, size_t row,
            SequenceTimes& times) {
    std::string error;
    const Sampler sampler = choose_sampler(kSequenceRows[row].method, "", &error).value();
    std::unique_ptr<Visibility> tree;
    std::vector<SampleTile> tiles;
    std::vector<HitBuffer> hits;
    SampleStats all;
    const RenderContext context = frames[0].context_at({1, 1});  // camera and shutter are those of all
    for (size_t f = 0; f < frames.size(); ++f) {
        bench.go_on();
        Stopwatch watch;
        if (!tree || !tree->update(frames[f].grids)) tree = sampler.prepare(context, frames[f].grids);
        times.update[row][f].push_back(watch.lap());
        if (tiles.empty()) tiles = samples_of(context, frames[0].pixels, sampler, tree->tile_side());
        watch.lap();
        const SampleStats stats = trace_tiles(tiles, *tree, hits);
        times.trace[row][f].push_back(watch.lap());
        times.seen[row][f] = hash_of(hits);
        times.sah[row][f] = tree->build_stats().tree_sah_cost;
        bench.figure(fmt::format(
            "frame {}, {}: update {}, trace {}, {} nodes a ray", f, kSequenceRows[row].name,
            seconds_text(times.update[row][f].back()), seconds_text(times.trace[row][f].back()),
            number_text(static_cast<double>(stats.nodes_visited) / static_cast<double>(stats.rays))));
        all += stats;
    }
    const auto a_ray = [&](uint64_t count) {
        return static_cast<double>(count) / static_cast<double>(all.rays);
    };
    times.nodes[row] = a_ray(all.nodes_visited), times.tests[row] = a_ray(all.predicate_tests);
}

void add_sequence_table(StudyResult& result, const SequenceTimes& times) {
    StudyTable table{
        "A frame's mean, but the first's",
        {"", "update", "trace", "total", "update, x", "trace, x", "total, x", "tests a ray", "nodes a ray"},
        {}};
    const auto speed_ups = [](const paper::SequenceCosts& base, const paper::SequenceCosts& one) {
        return std::array{base.update / one.update, base.trace / one.trace,
                          (base.update + base.trace) / (one.update + one.trace)};
    };
    const auto add = [&](const std::string& name, const paper::SequenceCosts& one,
                         const paper::SequenceCosts& base) {
        auto& row = table.rows.emplace_back(1, name);
        for (const double seconds : {one.update, one.trace, one.update + one.trace})
            row.push_back(seconds_text(seconds));
        for (const double speed_up : speed_ups(base, one)) row.push_back(number_text(speed_up));
    };
    for (size_t r = 0; r < kSequenceRowCount; ++r) {
        add(kSequenceRows[r].name, times.mean_costs(r), times.mean_costs(0));
        table.rows.back().push_back(number_text(times.tests[r]));
        table.rows.back().push_back(number_text(times.nodes[r]));
    }
    for (size_t r = 0; r < std::size(paper::kFalling); ++r) {
        add(std::string(kSequenceRows[r].name) + ", the report's", paper::kFalling[r], paper::kFalling[0]);
        table.rows.back().insert(table.rows.back().end(), {"-", "-"});
    }
    result.tables.push_back(std::move(table));
}

void add_sequence_curves(StudyResult& result, const SequenceTimes& times) {
    for (const bool of_updates : {true, false}) {
        LinePlot plot{of_updates ? "Update" : "Trace", "frame", "seconds", {}};
        for (size_t r = 0; r < kSequenceRowCount; ++r) {
            PlotSeries& series = plot.series.emplace_back();
            series.name = kSequenceRows[r].name;
            for (int frame = 0; frame < kSequenceFrames; ++frame) {
                const paper::SequenceCosts costs = times.costs(r, frame);
                series.points.emplace_back(frame, of_updates ? costs.update : costs.trace);
            }
        }
        result.plots.push_back(std::move(plot));
    }
}

/// [Gruenschloss11 figure 5], of interpolated boxes.
void add_sah_curves(StudyResult& result, const SequenceTimes& times) {
    LinePlot plot{"Cost by the surface area heuristic", "frame", "expected tests and steps of a line", {}};
    for (size_t r = 0; r < kSequenceRowCount; ++r) {
        if (times.sah[r].front() == 0) continue;
        PlotSeries& series = plot.series.emplace_back();
        series.name = kSequenceRows[r].name;
        for (size_t f = 0; f < times.sah[r].size(); ++f)
            series.points.emplace_back(static_cast<double>(f), times.sah[r][f]);
    }
    result.plots.push_back(std::move(plot));
}

void add_sequence_figures(StudyResult& result, const SequenceTimes& times) {
    for (size_t r = 0; r < kSequenceRowCount; ++r)
        for (size_t f = 0; f < times.update[r].size(); ++f)
            result.figures.push_back({{"method", kSequenceRows[r].method},
                                      {"frame", f},
                                      {"update_seconds_by_round", times.update[r][f]},
                                      {"trace_seconds_by_round", times.trace[r][f]},
                                      {"tests_a_ray", times.tests[r]},
                                      {"nodes_a_ray", times.nodes[r]},
                                      {"tree_sah_cost", times.sah[r][f]}});
}

StudyCheck check_of_agreement(const SequenceTimes& times) {
    const auto differing =
        std::ranges::count_if(times.seen, [&](const auto& row) { return row != times.seen[0]; });
    return {"all trees see the same in every frame, bit for bit", "-",
            fmt::format("{} of {} differ from the first", differing, kSequenceRowCount), differing == 0};
}

}  // namespace

void study_dynamic(StudyBench& bench, StudyResult& result) {
    result.notes.push_back(
        "One camera ray a pixel, and none of second order; the report has rays of depth 2, kitchen and museum "
        "too. Its trees have one thread, ours two or more: the first two are updated by one, too.");
    const std::vector<SharedFrame> frames = sequence_frames(bench);
    const bool same_objects = std::ranges::all_of(frames, [&](const SharedFrame& frame) {
        return frame.grids.micropolygon_count() == frames[0].grids.micropolygon_count();
    });
    if (!same_objects)
        result.notes.push_back("Not all frames have the same objects: where they differ, trees are built.");
    SequenceTimes times;
    times.nodes.resize(kSequenceRowCount), times.tests.resize(kSequenceRowCount);
    for (int round = 0; round < bench.rounds(); ++round)
        for (size_t row = 0; row < kSequenceRowCount; ++row) {
            bench.stage(fmt::format("following the sequence: {}", kSequenceRows[row].name));
            follow(bench, frames, row, times);
        }
    add_sequence_table(result, times);
    add_sequence_curves(result, times);
    add_sah_curves(result, times);
    add_sequence_figures(result, times);
    result.checks =
        checks_of_updates("Falling triangles",
                          {times.mean_costs(0), times.mean_costs(1), times.mean_costs(2)}, paper::kFalling);
    result.checks.push_back(
        check_of_refitting("Falling triangles", times.sah[kRefittedRow], times.sah[kInterpolatedRow]));
    result.checks.push_back(check_of_agreement(times));
}

}  // namespace trapeze
