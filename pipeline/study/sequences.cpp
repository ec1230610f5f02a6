/// Trees over the frames of sequences: updated, refitted, or built anew [DynBvh06 table 1 and figure 7].
#include <fmt/format.h>

#include <algorithm>

#include "pipeline/compare/value_text.h"
#include "pipeline/study/bart_sequence.h"
#include "pipeline/study/moving_checks.h"
#include "pipeline/study/sequence.h"
#include "pipeline/study/studies.h"

namespace trapeze {
namespace {

constexpr int kFallingFrames = 11;  ///< as the report has of its falling triangles
constexpr const char* kFallingTriangles = "Falling triangles";
constexpr double kBetweenFrames = .24;  ///< seconds

std::vector<SharedFrame> falling_frames(StudyBench& bench) {
    std::vector<SharedFrame> frames;
    for (int i = 0; i < kFallingFrames; ++i) {
        StudyScene scene = bench.scene(fmt::format("Falling triangles, frame {}", i), "falling", 1);
        SceneParameters& p = scene.parameters;
        p.motion = p.defocus = 0, p.time = kBetweenFrames * i;
        frames.push_back(bench.frame(scene));
    }
    return frames;
}

void add_sequence_table(StudyResult& result, const std::string& label, const SequenceTimes& times,
                        const paper::SequenceClaims& report) {
    StudyTable table{
        label + ": a frame's mean, but the first's",
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
    for (size_t r = 0; r < std::size(report.costs); ++r) {
        add(std::string(kSequenceRows[r].name) + ", the report's", report.costs[r], report.costs[0]);
        table.rows.back().insert(table.rows.back().end(), {"-", "-"});
    }
    result.tables.push_back(std::move(table));
}

void add_sequence_curves(StudyResult& result, const std::string& label, const SequenceTimes& times) {
    for (const bool of_updates : {true, false}) {
        LinePlot plot{label + (of_updates ? ": update" : ": trace"), "frame", "seconds", {}};
        for (size_t r = 0; r < kSequenceRowCount; ++r) {
            PlotSeries& series = plot.series.emplace_back();
            series.name = kSequenceRows[r].name;
            for (size_t frame = 0; frame < times.update[r].size(); ++frame) {
                const paper::SequenceCosts costs = times.costs(r, frame);
                series.points.emplace_back(static_cast<double>(frame),
                                           of_updates ? costs.update : costs.trace);
            }
        }
        result.plots.push_back(std::move(plot));
    }
}

/// [Gruenschloss11 figure 5], of interpolated boxes.
void add_sah_curves(StudyResult& result, const std::string& label, const SequenceTimes& times) {
    LinePlot plot{
        label + ": cost by the surface area heuristic", "frame", "expected tests and steps of a line", {}};
    for (size_t r = 0; r < kSequenceRowCount; ++r) {
        if (times.sah[r].front() == 0) continue;
        PlotSeries& series = plot.series.emplace_back();
        series.name = kSequenceRows[r].name;
        for (size_t f = 0; f < times.sah[r].size(); ++f)
            series.points.emplace_back(static_cast<double>(f), times.sah[r][f]);
    }
    result.plots.push_back(std::move(plot));
}

void add_sequence_figures(StudyResult& result, const std::string& label, const SequenceTimes& times) {
    for (size_t r = 0; r < kSequenceRowCount; ++r)
        for (size_t f = 0; f < times.update[r].size(); ++f)
            result.figures.push_back({{"sequence", label},
                                      {"method", kSequenceRows[r].method},
                                      {"frame", f},
                                      {"update_seconds_by_round", times.update[r][f]},
                                      {"trace_seconds_by_round", times.trace[r][f]},
                                      {"tests_a_ray", times.tests[r]},
                                      {"nodes_a_ray", times.nodes[r]},
                                      {"tree_sah_cost", times.sah[r][f]}});
}

StudyCheck check_of_agreement(const std::string& label, const SequenceTimes& times) {
    const auto differing =
        std::ranges::count_if(times.seen, [&](const auto& row) { return row != times.seen[0]; });
    return {label + ": all trees see the same in every frame, bit for bit", "-",
            fmt::format("{} of {} differ from the first", differing, kSequenceRowCount), differing == 0};
}

/// Follows a sequence with all rows in turn, and adds what comes of it.
void study_sequence(StudyBench& bench, const Sequence& sequence, const paper::SequenceClaims& report,
                    StudyResult& result) {
    SequenceTimes times(sequence.frames.size());
    for (int round = 0; round < bench.rounds(); ++round)
        for (size_t row = 0; row < kSequenceRowCount; ++row) {
            bench.stage(fmt::format("following {}: {}", sequence.label, kSequenceRows[row].name));
            follow(bench, sequence, row, times);
        }
    const std::string& label = sequence.label;
    add_sequence_table(result, label, times, report);
    add_sequence_curves(result, label, times);
    add_sah_curves(result, label, times);
    add_sequence_figures(result, label, times);
    const auto add = [&](const std::vector<StudyCheck>& checks) {
        result.checks.insert(result.checks.end(), checks.begin(), checks.end());
    };
    add(checks_of_updates(label, {times.mean_costs(0), times.mean_costs(1), times.mean_costs(2)}, report));
    add({check_of_refitting(label, times.sah[kRefittedRow], times.sah[kInterpolatedRow]),
         check_of_agreement(label, times)});
}

void study_falling(StudyBench& bench, StudyResult& result) {
    const std::vector<SharedFrame> shared = falling_frames(bench);
    const RenderContext context = shared[0].context_at({1, 1});
    Sequence sequence{kFallingTriangles, &context, shared[0].pixels, {}};
    for (const SharedFrame& frame : shared) sequence.frames.push_back(&frame.grids);
    const bool same_objects = std::ranges::all_of(sequence.frames, [&](const Grids* grids) {
        return grids->micropolygon_count() == sequence.frames[0]->micropolygon_count();
    });
    if (!same_objects)
        result.notes.push_back("Not all frames have the same objects: where they differ, trees are built.");
    study_sequence(bench, sequence, paper::kFalling, result);
}

/// Kitchen and museum, where their files are to be had.
void study_bart(StudyBench& bench, StudyResult& result) {
    if (bench.bart_folder().empty()) {
        result.notes.push_back(
            "Kitchen and museum are followed where --bart names the folder that has them.");
        return;
    }
    for (const BartScene& scene : kBartScenes) {
        if (!bench.takes(scene.label)) continue;
        const auto frames = bart_frames(bench, scene, result);
        if (frames) study_sequence(bench, frames->sequence, scene.report, result);
    }
}

}  // namespace

void study_dynamic(StudyBench& bench, StudyResult& result) {
    result.notes.push_back(
        "One camera ray a pixel, and none of second order; the report has rays of depth 2. Its trees have one "
        "thread, ours two or more: the first two are updated by one, too.");
    std::vector<std::string> labels{kFallingTriangles};
    for (const BartScene& scene : kBartScenes) labels.emplace_back(scene.label);
    bench.offer_scenes(labels);
    if (bench.takes(kFallingTriangles)) study_falling(bench, result);
    study_bart(bench, result);
}

}  // namespace trapeze
