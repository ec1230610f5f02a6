/// Figure 9: how well splits in parametric space approximate the greedy SAH [Hou10 sec. 5.2].
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "pipeline/compare/value_text.h"
#include "pipeline/study/paper_figures.h"
#include "pipeline/study/sah_cost.h"
#include "pipeline/study/shape_checks.h"
#include "pipeline/study/studies.h"
#include "pipeline/study/study_scenes.h"

namespace trapeze {
namespace {

/// Leaves have fewer micropolygons than this in both trees; and the width of the histogram's bins.
constexpr int kLeafBelow = 8;
constexpr double kBin = .05;

/// The relative difference in SAH cost of every grid that is split at all.
std::vector<double> relative_differences(const SharedFrame& frame) {
    std::vector<double> all(frame.grids.grids.size(), std::nan(""));
    tbb::parallel_for(size_t{0}, all.size(), [&](size_t i) {
        const Grid& grid = frame.grids.grids[i];
        if (grid.shape.micropolygon_count() < kLeafBelow) return;
        const SahCosts costs = sah_costs(grid, kLeafBelow);
        if (costs.greedy > 0) all[i] = costs.relative_difference();
    });
    std::erase_if(all, [](double value) { return std::isnan(value); });
    return all;
}

HistogramPlot histogram_of(const std::vector<double>& values) {
    HistogramPlot plot{"Relative difference in SAH cost, parametric against greedy",
                       "relative difference (negative: parametric splits are better)",
                       0,
                       kBin,
                       {}};
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    const double first = std::floor(*least / kBin), last = std::floor(*most / kBin);
    plot.low = first * kBin;
    plot.counts.resize(static_cast<size_t>(last - first) + 1);
    for (const double value : values) ++plot.counts[static_cast<size_t>(std::floor(value / kBin) - first)];
    return plot;
}

double part_at_most(const std::vector<double>& values, double bound) {
    const auto count =
        std::count_if(values.begin(), values.end(), [&](double value) { return value <= bound; });
    return static_cast<double>(count) / static_cast<double>(values.size());
}

}  // namespace

void study_fig9(StudyBench& bench, StudyResult& result) {
    const StudyScene scene = halberd_scene(bench);
    const SharedFrame frame = bench.frame(scene);
    bench.stage("SAH costs");
    const std::vector<double> differences = relative_differences(frame);
    if (differences.empty()) return;
    result.notes.push_back(fmt::format("Over {} grids; {} of fewer than {} micropolygons are not split.",
                                       differences.size(), frame.grids.grids.size() - differences.size(),
                                       kLeafBelow));
    const double mean = std::accumulate(differences.begin(), differences.end(), 0.0) /
                        static_cast<double>(differences.size());
    const double better = part_at_most(differences, 0), not_much_worse = part_at_most(differences, .2);
    const auto [least, most] = std::minmax_element(differences.begin(), differences.end());
    result.histograms.push_back(histogram_of(differences));
    result.tables.push_back(
        {"Relative difference in SAH cost",
         {"", "here", "the paper's"},
         {{"mean", percent_text(mean), percent_text(paper::kFigure9Mean)},
          {"at most 0", share_text(better), share_text(paper::kFigure9Better)},
          {"at most +20 %", share_text(not_much_worse), share_text(paper::kFigure9NotMuchWorse)},
          {"least", percent_text(*least), percent_text(paper::kFigure9Least)},
          {"most", percent_text(*most), percent_text(paper::kFigure9Most)}}});
    result.figures.push_back({{"scene", scene_command_line(scene)},
                              {"grids", differences.size()},
                              {"mean", mean},
                              {"part_at_most_0", better},
                              {"part_at_most_0.2", not_much_worse},
                              {"least", *least},
                              {"most", *most}});
    const HistogramPlot& histogram = result.histograms[0];
    for (size_t i = 0; i < histogram.counts.size(); ++i)
        result.figures.push_back({{"scene", scene_command_line(scene)},
                                  {"histogram_bin_low", histogram.low + static_cast<double>(i) * kBin},
                                  {"histogram_bin_width", kBin},
                                  {"histogram_grids", histogram.counts[i]}});
    result.checks =
        checks_of_splits({mean, better, not_much_worse},
                         {paper::kFigure9Mean, paper::kFigure9Better, paper::kFigure9NotMuchWorse});
}

}  // namespace trapeze
