/// Tables 1, 2 and 5: sampling times of ray tracing and of the rasterizers [Hou10 sec. 5.1].
#include <fmt/format.h>

#include <algorithm>

#include "pipeline/compare/comparison.h"
#include "pipeline/compare/value_text.h"
#include "pipeline/study/paper_figures.h"
#include "pipeline/study/shape_checks.h"
#include "pipeline/study/studies.h"
#include "pipeline/study/study_scenes.h"

namespace trapeze {
namespace {

constexpr const char* kPaperMethods = "raytrace interval interleaveuvt:k=2 interleaveuvt:k=4";
constexpr size_t kMethodCount = paper::kMethods.size();

/// Seconds by row, then by column; negative where there are none.
using Times = std::vector<std::vector<double>>;

/// Measured, the paper's, and both as ratios to the first row: here (paper).
void add_tables(StudyResult& result, const std::vector<std::string>& columns, const Times& here,
                const Times& paper, const std::string& what) {
    std::vector<std::string> header{"method"};
    header.insert(header.end(), columns.begin(), columns.end());
    StudyTable measured{what + ", measured here", header, {}};
    StudyTable printed{what + ", the paper's", header, {}};
    StudyTable ratios{"Ratios to ray tracing: here (the paper's)", header, {}};
    for (size_t m = 0; m < kMethodCount; ++m) {
        std::vector<std::string> a{std::string(paper::kMethods[m])}, b = a, c = a;
        for (size_t i = 0; i < columns.size(); ++i) {
            a.push_back(seconds_text(here[m][i]));
            b.push_back(paper_seconds(paper[m][i]));
            const bool has_paper = paper[m][i] > 0 && paper[0][i] > 0;
            c.push_back(fmt::format("{} ({})", number_text(here[m][i] / here[0][i]),
                                    has_paper ? number_text(paper[m][i] / paper[0][i]) : "-"));
        }
        measured.rows.push_back(a), printed.rows.push_back(b), ratios.rows.push_back(c);
    }
    for (StudyTable& table : {std::ref(measured), std::ref(printed), std::ref(ratios)})
        result.tables.push_back(std::move(table));
}

std::vector<double> totals(const std::vector<MethodResult>& results) {
    std::vector<double> seconds;
    for (const MethodResult& result : results) seconds.push_back(result.total_median());
    return seconds;
}

std::vector<double> column_of(const Times& grid, size_t column) {
    std::vector<double> values;
    for (const auto& row : grid) values.push_back(row[column]);
    return values;
}

template <size_t N>
Times times_of(const double (&rows)[kMethodCount][N]) {
    Times grid;
    for (const auto& row : rows) grid.emplace_back(std::begin(row), std::end(row));
    return grid;
}

void set_column(Times& grid, size_t column, const std::vector<double>& values) {
    for (size_t m = 0; m < kMethodCount; ++m) grid[m][column] = values[m];
}

void add_effect_checks(StudyResult& result, const Times& here) {
    const Times printed = times_of(paper::kTable1);
    result.checks = checks_of_effects(here, printed);
    for (size_t effect = 0; effect < 3; ++effect) {
        constexpr const char* kEffects[] = {"defocus", "motion blur", "both"};
        result.checks.push_back(
            check_of_order(kEffects[effect], column_of(here, effect), column_of(printed, effect)));
    }
}

}  // namespace

void study_table1(StudyBench& bench, StudyResult& result) {
    const SampleRate rate = bench.reference_rate();
    result.notes.push_back("All at " + rate_text(rate) + " samples a pixel; the paper's at 13x13.");
    Times here(kMethodCount, std::vector<double>(3));
    for (size_t effect = 0; effect < 3; ++effect) {
        const StudyScene scene = car_scene_with(bench, effect != 0, effect != 1);
        const SharedFrame frame = bench.frame(scene);
        set_column(here, effect, totals(bench.measure(frame, scene, kPaperMethods, {rate})));
    }
    add_tables(result, {"defocus", "motion blur", "both"}, here, times_of(paper::kTable1), "Sampling time");
    add_effect_checks(result, here);
}

void study_table2(StudyBench& bench, StudyResult& result) {
    const SampleRate rate = bench.reference_rate();
    result.notes.push_back("All at " + rate_text(rate) + " samples a pixel; the paper's at 13x13 and more.");
    Times here(kMethodCount, std::vector<double>(4));
    std::vector<std::string> columns;
    size_t column = 0;
    for (const StudyScene& scene : scenes_of_the_paper(bench)) {
        columns.push_back(fmt::format("{} ({})", paper::kScenes[column], scene.name));
        const SharedFrame frame = bench.frame(scene);
        set_column(here, column++, totals(bench.measure(frame, scene, kPaperMethods, {rate})));
    }
    const Times printed = times_of(paper::kTable2);
    add_tables(result, columns, here, printed, "Sampling time");
    for (size_t i = 0; i < columns.size(); ++i)
        result.checks.push_back(check_of_order(columns[i], column_of(here, i), column_of(printed, i)));
}

namespace {

/// A row of table 5: four sample rates, then two coarser shading rates at the last of them.
Times rates_of_scene(StudyBench& bench, const StudyScene& scene, const std::vector<SampleRate>& rates) {
    Times here(kMethodCount, std::vector<double>(rates.size() + 2));
    {
        const SharedFrame frame = bench.frame(scene);
        const auto seconds = totals(bench.measure(frame, scene, kPaperMethods, rates));
        for (size_t r = 0; r < rates.size(); ++r)
            for (size_t m = 0; m < kMethodCount; ++m) here[m][r] = seconds[r * kMethodCount + m];
    }
    size_t column = rates.size();
    for (const double coarser : {4.0, 16.0}) {
        StudyScene coarse = scene;
        coarse.parameters.shading_rate = coarser;
        const SharedFrame frame = bench.frame(coarse);
        set_column(here, column++, totals(bench.measure(frame, coarse, kPaperMethods, {rates.back()})));
    }
    return here;
}

RateSeries series_of(const std::string& scene, const std::vector<SampleRate>& rates, const Times& grid) {
    RateSeries series{scene, {}, {}};
    for (const SampleRate& rate : rates) series.samples.push_back(rate.per_pixel());
    for (const auto& row : grid)
        series.seconds.emplace_back(row.begin(), row.begin() + static_cast<std::ptrdiff_t>(rates.size()));
    return series;
}

}  // namespace

void study_table5(StudyBench& bench, StudyResult& result) {
    std::vector<SampleRate> rates = {{1, 1}, {4, 4}, {8, 8}, {13, 13}};
    if (bench.quick()) rates = {{1, 1}, {2, 2}, {4, 4}, {8, 8}};
    result.notes.push_back("Ref is " + rate_text(rates.back()) +
                           " samples a pixel; SRx4 and SRx16 are at Ref.");
    std::vector<std::string> columns;
    for (size_t i = 0; i + 1 < rates.size(); ++i) columns.push_back(rate_text(rates[i]));
    for (const char* name : {"Ref", "SRx4", "SRx16"}) columns.emplace_back(name);
    bench.offer_scenes({std::begin(paper::kScenes), std::end(paper::kScenes)});
    size_t s = 0;
    for (const StudyScene& scene : scenes_of_the_paper(bench)) {
        Times printed = times_of(paper::kTable5[s++]);
        if (!bench.takes(scene.label)) continue;
        const Times here = rates_of_scene(bench, scene, rates);
        const int side = paper::kReferenceSide[s - 1];
        const RateSeries printed_series =
            series_of(scene.label, {{1, 1}, {4, 4}, {8, 8}, {side, side}}, printed);
        auto checks = checks_of_rates(series_of(scene.label, rates, here), printed_series);
        checks.push_back(check_of_coarser_shading(scene.label, column_of(here, 3), column_of(here, 5),
                                                  column_of(printed, 3), column_of(printed, 5)));
        result.checks.insert(result.checks.end(), checks.begin(), checks.end());
        if (bench.quick())  // the paper has no 2x2; its 4x4 and Ref stand where they belong
            for (auto& row : printed) row = {row[0], -1, row[1], row[3], row[4], row[5]};
        add_tables(result, columns, here, printed, fmt::format("{} ({})", scene.label, scene.name));
    }
}

}  // namespace trapeze
