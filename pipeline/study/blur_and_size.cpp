/// Figure 10: time against motion and defocus [Hou10 sec. 5.2]; and, not in the paper as a figure, cost
/// against the number of micropolygons.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pipeline/compare/comparison.h"
#include "pipeline/compare/value_text.h"
#include "pipeline/study/shape_checks.h"
#include "pipeline/study/studies.h"
#include "pipeline/study/study_scenes.h"

namespace trapeze {
namespace {

constexpr const char* kMethods = "raytrace interval interleaveuvt:k=4";
constexpr const char* kNames[] = {"ray tracing", "INTERVAL", "INTERLEAVEUVT k = 4"};
/// The paper's tree with each ray from its root: what a ray costs that owes nothing to its neighbours. Few
/// samples are enough.
constexpr const char* kAlone = "raytrace:tree=paper,bundle=off";
constexpr SampleRate kAloneRate{2, 2};
constexpr double kLargestMotion = 190, kLargestDefocus = 9.5;  ///< pixels of 1280x720; times the scene's own

/// Adds a measured scene to a series, and its figures to a row of the table.
void add_size(const MethodResult& r, GrowthSeries& series, std::vector<std::string>& row) {
    const double nanoseconds = 1e9 / r.samples_per_second();
    series.micropolygons.push_back(static_cast<double>(r.micropolygons));
    series.nanoseconds.push_back(nanoseconds);
    series.nodes.push_back(r.nodes_per_sample());
    for (const std::string& text :
         {seconds_text(r.build_median()), number_text(nanoseconds) + " ns", number_text(r.nodes_per_sample()),
          number_text(r.tests_per_sample()), number_text(r.bytes_per_micropolygon())})
        row.push_back(text);
}

/// One half of the figure: x, then seconds by method; and of a ray by itself.
struct Sweep {
    std::vector<double> x;
    std::vector<std::vector<double>> seconds{3};
    std::vector<double> alone_nanoseconds, alone_nodes;
};

/// Measures the methods and single rays at one point of a sweep.
void measure_point(StudyBench& bench, const StudyScene& scene, const SharedFrame& frame, double x,
                   Sweep& sweep) {
    const auto results = bench.measure(frame, scene, kMethods, {{8, 8}});
    sweep.x.push_back(x);
    for (size_t m = 0; m < 3; ++m) sweep.seconds[m].push_back(results[m].total_median());
    const auto alone = bench.measure(frame, scene, kAlone, {kAloneRate});
    sweep.alone_nanoseconds.push_back(1e9 / alone.front().samples_per_second());
    sweep.alone_nodes.push_back(alone.front().nodes_per_sample());
}

/// The motion factor at which the fastest vertex moves so many pixels: motion is in proportion to it.
double motion_for(StudyBench& bench, const StudyScene& scene, double pixels) {
    StudyScene probe = scene;
    probe.parameters.motion = 1;
    bench.frame(probe);
    const float largest = bench.last_facts().largest_motion;
    return largest > 0 ? pixels / static_cast<double>(largest) : 1;
}

LinePlot plot_alone(const Sweep& sweep, const std::string& title, const std::string& x_title) {
    LinePlot plot{title, x_title, "trace, nanoseconds a ray", {{"rays by themselves", {}}}};
    for (size_t i = 0; i < sweep.x.size(); ++i)
        plot.series[0].points.emplace_back(sweep.x[i], sweep.alone_nanoseconds[i]);
    return plot;
}

LinePlot plot_of(const Sweep& sweep, const std::string& title, const std::string& x_title) {
    LinePlot plot{title, x_title, "sampling time, seconds", {}};
    for (size_t m = 0; m < 3; ++m) {
        PlotSeries series{kNames[m], {}};
        for (size_t i = 0; i < sweep.x.size(); ++i)
            series.points.emplace_back(sweep.x[i], sweep.seconds[m][i]);
        plot.series.push_back(std::move(series));
    }
    return plot;
}

StudyTable table_of(const Sweep& sweep, const std::string& title, const std::string& x_title) {
    StudyTable table{title, {x_title}, {}};
    for (const char* name : kNames) table.columns.emplace_back(name);
    for (const char* name : {"a ray by itself", "its nodes"}) table.columns.emplace_back(name);
    for (size_t i = 0; i < sweep.x.size(); ++i) {
        std::vector<std::string> row{number_text(sweep.x[i])};
        for (size_t m = 0; m < 3; ++m) row.push_back(seconds_text(sweep.seconds[m][i]));
        row.push_back(number_text(sweep.alone_nanoseconds[i]) + " ns");
        row.push_back(number_text(sweep.alone_nodes[i]));
        table.rows.push_back(row);
    }
    return table;
}

void add_sweep(StudyResult& result, const Sweep& sweep, const std::string& what, const std::string& x_title) {
    result.plots.push_back(plot_of(sweep, "Time against " + what, x_title));
    result.plots.push_back(plot_alone(sweep, "A ray by itself against " + what, x_title));
    result.tables.push_back(table_of(sweep, "Time against " + what, x_title));
    const auto checks = checks_of_sweep(what, sweep.seconds, sweep.alone_nanoseconds);
    result.checks.insert(result.checks.end(), checks.begin(), checks.end());
}

}  // namespace

void study_fig10(StudyBench& bench, StudyResult& result) {
    result.notes.push_back(
        "All at 8x8 samples a pixel; the paper does not say at how many. Beside them, at " +
        rate_text(kAloneRate) + ", the trace time of each ray by itself through the paper's tree.");
    const StudyScene scene = halberd_scene(bench);
    const double picture = bench.quick() ? .5 : 1;  // the same part of the picture
    const double most = motion_for(bench, scene, kLargestMotion * picture);
    result.scenes.clear();
    const int steps = bench.quick() ? 4 : 8;
    Sweep motion, defocus;
    for (int i = 0; i <= steps; ++i) {
        StudyScene moving = scene;
        moving.parameters.motion = most * i / steps;
        const SharedFrame frame = bench.frame(moving);
        measure_point(bench, moving, frame, static_cast<double>(bench.last_facts().largest_motion), motion);
    }
    for (int i = 0; i <= steps; ++i) {
        StudyScene soft = scene;
        soft.parameters.defocus = kLargestDefocus * i / steps;
        const SharedFrame frame = bench.frame(soft);
        measure_point(bench, soft, frame, soft.parameters.defocus, defocus);
    }
    add_sweep(result, motion, "motion", "largest motion, pixels");
    add_sweep(result, defocus, "defocus", "defocus, times the scene's own");
}

void study_growth(StudyBench& bench, StudyResult& result) {
    result.notes.push_back(
        "The halberd at 4x4 samples a pixel, diced ever finer: the wide tree and its bundles, and the "
        "paper's "
        "tree with each ray by itself, whose cost owes nothing to its neighbours.");
    std::vector<double> factors = {.5, 1, 3, 10, 30};
    if (bench.quick()) factors = {.5, 2, 8};
    StudyTable table{"Cost of a ray against micropolygons", {"micropolygons"}, {}};
    GrowthSeries bundles{"bundles", {}, {}, {}}, alone{"rays by themselves", {}, {}, {}};
    for (const GrowthSeries* series : {&bundles, &alone})
        for (const char* what :
             {"build", "trace, a ray", "nodes a ray", "tests a ray", "bytes a micropolygon"})
            table.columns.push_back(series->name + ": " + what);
    for (const double factor : factors) {
        const StudyScene scene = bench.scene("Halberd", "halberd", factor);
        const SharedFrame frame = bench.frame(scene);
        const auto results = bench.measure(frame, scene, "raytrace raytrace:tree=paper,bundle=off", {{4, 4}});
        std::vector<std::string> row{count_text(static_cast<double>(results.front().micropolygons))};
        add_size(results[0], bundles, row);
        add_size(results[1], alone, row);
        table.rows.push_back(row);
    }
    result.tables.push_back(table);
    for (const auto& [title, y_title, values] :
         {std::tuple{"Nodes", "nodes a ray", &GrowthSeries::nodes},
          std::tuple{"Time", "nanoseconds a ray", &GrowthSeries::nanoseconds}}) {
        LinePlot plot{
            std::string(title) + " of a ray against micropolygons", "log10 of micropolygons", y_title, {}};
        for (const GrowthSeries* series : {&bundles, &alone}) {
            PlotSeries line{series->name, {}};
            for (size_t i = 0; i < series->micropolygons.size(); ++i)
                line.points.emplace_back(std::log10(series->micropolygons[i]), (series->*values)[i]);
            plot.series.push_back(std::move(line));
        }
        result.plots.push_back(std::move(plot));
    }
    result.checks = checks_of_growth(bundles, alone);
}

}  // namespace trapeze
