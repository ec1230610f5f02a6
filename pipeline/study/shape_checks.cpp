#include "pipeline/study/shape_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pipeline/compare/value_text.h"

namespace trapeze {
namespace {

// Rows of paper::kMethods.
constexpr size_t kRaytraceRow = 0, kIntervalRow = 1, kUvt2Row = 2, kUvt4Row = 3;

/// How far from 1 the exponent of something linear may measure.
constexpr double kLinear = .15;
/// How far from 1 the ratio of what is alike may measure.
constexpr double kAlike = .1;
/// How many times more or less than the logarithm what is logarithmic may grow: some of a ray's cost is
/// constant, and caches are outgrown.
constexpr double kLogarithmic = 1.25;

std::string times(double ratio) {
    return number_text(ratio) + "x";
}

/// Between the two rates given; one sample a pixel is mostly set-up.
double exponent_of(const RateSeries& series, size_t method, size_t from, size_t to) {
    return growth_exponent(series.samples[from], series.seconds[method][from], series.samples[to],
                           series.seconds[method][to]);
}

std::string exponent_text(double exponent) {
    return fmt::format("time ~ samples^{:.2f}", exponent);
}

bool is_complete(const RateSeries& series) {
    for (const auto& row : series.seconds)
        for (const double seconds : row)
            if (seconds <= 0) return false;
    return true;
}

/// Sets what a check says of both series, in the same words; "-" where the paper is not legible.
template <class Text>
void set_texts(StudyCheck& check, const RateSeries& here, const RateSeries& paper, Text text) {
    check.here = text(here);
    check.paper = is_complete(paper) ? text(paper) : "-";
}

StudyCheck uvt_is_linear(const RateSeries& here, const RateSeries& paper) {
    StudyCheck check{
        here.scene +
            ": INTERLEAVEUVT k = 2 costs in proportion to samples, from the second rate on (power .85 to "
            "1.15)",
        "", ""};
    const size_t last = here.samples.size() - 1;
    set_texts(check, here, paper,
              [&](const RateSeries& s) { return exponent_text(exponent_of(s, kUvt2Row, 1, last)); });
    check.held = std::abs(exponent_of(here, kUvt2Row, 1, last) - 1) <= kLinear;
    return check;
}

StudyCheck interval_is_sublinear(const RateSeries& here, const RateSeries& paper) {
    StudyCheck check{here.scene + ": INTERVAL costs less than in proportion to samples (power below .85)", "",
                     ""};
    const size_t last = here.samples.size() - 1;
    set_texts(check, here, paper,
              [&](const RateSeries& s) { return exponent_text(exponent_of(s, kIntervalRow, 0, last)); });
    check.held = exponent_of(here, kIntervalRow, 0, last) < 1 - kLinear;
    return check;
}

StudyCheck larger_tiles_cost_more(const RateSeries& here, const RateSeries& paper) {
    StudyCheck check{here.scene +
                         ": k = 4 costs more than k = 2 at the most samples, by less than its four "
                         "times as many tuples",
                     "", ""};
    const auto ratio = [](const RateSeries& s) {
        return s.seconds[kUvt4Row].back() / s.seconds[kUvt2Row].back();
    };
    set_texts(check, here, paper, [&](const RateSeries& s) { return times(ratio(s)); });
    check.held = ratio(here) > 1 && ratio(here) < 4;
    return check;
}

StudyCheck samples_favour_tracing(const RateSeries& here, const RateSeries& paper) {
    StudyCheck check{
        here.scene +
            ": INTERLEAVEUVT k = 2 is ahead of ray tracing at 1x1, and relatively slower at the most "
            "samples",
        "", ""};
    const auto ratio = [](const RateSeries& s, size_t rate) {
        return s.seconds[kUvt2Row][rate] / s.seconds[kRaytraceRow][rate];
    };
    const size_t last = here.samples.size() - 1;
    set_texts(check, here, paper, [&](const RateSeries& s) {
        return fmt::format("{} its time at 1x1, {} at most samples", times(ratio(s, 0)),
                           times(ratio(s, last)));
    });
    check.held = ratio(here, 0) < 1 && ratio(here, last) > ratio(here, 0);
    return check;
}

/// Whether y grows from the first point on as the logarithm of x does, but for kLogarithmic, and falls from
/// no point to the next: where the logarithm grows by less than kLogarithmic, that alone would let it.
bool is_logarithmic(const std::vector<double>& x, const std::vector<double>& y) {
    if (!std::is_sorted(y.begin(), y.end())) return false;
    for (size_t i = 1; i < x.size(); ++i) {
        const double ratio = y[i] / y.front() / (std::log(x[i]) / std::log(x.front()));
        if (!(ratio <= kLogarithmic && ratio >= 1 / kLogarithmic)) return false;
    }
    return true;
}

}  // namespace

double growth_exponent(double x0, double y0, double x1, double y1) {
    return std::log(y1 / y0) / std::log(x1 / x0);
}

double spread(const std::vector<double>& values) {
    if (values.empty()) return 0;
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    return *high / *low;
}

std::string percent_text(double part) {
    return fmt::format("{:+.1f} %", 100 * part);
}

std::string share_text(double part) {
    return fmt::format("{:.0f} % of the grids", 100 * part);
}

std::string paper_seconds(double seconds) {
    return seconds < 0 ? "-" : number_text(seconds) + " s";
}

std::vector<StudyCheck> checks_of_rates(const RateSeries& here, const RateSeries& paper) {
    return {uvt_is_linear(here, paper), interval_is_sublinear(here, paper),
            larger_tiles_cost_more(here, paper), samples_favour_tracing(here, paper)};
}

StudyCheck check_of_coarser_shading(const std::string& scene, const std::vector<double>& reference,
                                    const std::vector<double>& coarser,
                                    const std::vector<double>& paper_reference,
                                    const std::vector<double>& paper_coarser) {
    StudyCheck check{scene + ": micropolygons 16 times as large help rasterizers more than ray tracing", "",
                     ""};
    const auto text = [](const std::vector<double>& before, const std::vector<double>& after) {
        return fmt::format("time times {} traced, {} INTERVAL, {} k = 2, {} k = 4",
                           number_text(after[kRaytraceRow] / before[kRaytraceRow]),
                           number_text(after[kIntervalRow] / before[kIntervalRow]),
                           number_text(after[kUvt2Row] / before[kUvt2Row]),
                           number_text(after[kUvt4Row] / before[kUvt4Row]));
    };
    const double traced = coarser[kRaytraceRow] / reference[kRaytraceRow];
    check.here = text(reference, coarser);
    check.paper = paper_coarser[kIntervalRow] > 0 ? text(paper_reference, paper_coarser) : "-";
    check.held = coarser[kIntervalRow] / reference[kIntervalRow] < traced &&
                 coarser[kUvt2Row] / reference[kUvt2Row] < traced &&
                 coarser[kUvt4Row] / reference[kUvt4Row] < traced;
    return check;
}

std::vector<StudyCheck> checks_of_growth(const GrowthSeries& bundles, const GrowthSeries& alone) {
    const auto grown = [](const std::vector<double>& y) { return y.back() / y.front(); };
    const auto& count = alone.micropolygons;
    const double logarithm = std::log(count.back()) / std::log(count.front());
    StudyCheck single{
        "time and nodes of a ray by itself grow like the logarithm of micropolygons, at every number of them "
        "(neither 1.25 times as much nor 1.25 times less), and never fall",
        "like the logarithm",
        fmt::format(
            "micropolygons times {}, their logarithm times {:.2f}: time times {:.2f}, nodes times {:.2f}",
            number_text(grown(count)), logarithm, grown(alone.nanoseconds), grown(alone.nodes))};
    single.held = is_logarithmic(count, alone.nanoseconds) && is_logarithmic(count, alone.nodes);
    StudyCheck shared{"bundles' time a ray grows slower than the fourth root of micropolygons", "-",
                      fmt::format("time ~ micropolygons^{:.2f}, nodes ~ ^{:.2f}",
                                  growth_exponent(1, 1, grown(count), grown(bundles.nanoseconds)),
                                  growth_exponent(1, 1, grown(count), grown(bundles.nodes)))};
    shared.held = growth_exponent(1, 1, grown(count), grown(bundles.nanoseconds)) < .25;
    double least = HUGE_VAL;
    for (size_t i = 0; i < count.size(); ++i)
        least = std::min(least, alone.nanoseconds[i] / bundles.nanoseconds[i]);
    StudyCheck ahead{"bundles stay ahead of rays by themselves at every number of micropolygons", "-",
                     "at least " + times(least) + " as fast"};
    ahead.held = least > 1;
    return {single, shared, ahead};
}

StudyCheck check_of_blur(const std::string& method, const std::vector<double>& times_by_blur) {
    constexpr double kMost = 2.5;
    const double most = *std::max_element(times_by_blur.begin(), times_by_blur.end()) / times_by_blur.front();
    StudyCheck check{fmt::format("{} takes less than {} times as long at any blur as at none", method, kMost),
                     "\"constant\" in theory", "at most " + times(most)};
    check.held = most < kMost;
    return check;
}

StudyCheck check_of_order(const std::string& scene, const std::vector<double>& here,
                          const std::vector<double>& paper) {
    StudyCheck check{scene + ": ray tracing is the fastest", "", ""};
    const auto text = [](const std::vector<double>& seconds) {
        return fmt::format("INTERVAL {}, k = 2 {}, k = 4 {} its time",
                           times(seconds[kIntervalRow] / seconds[kRaytraceRow]),
                           times(seconds[kUvt2Row] / seconds[kRaytraceRow]),
                           times(seconds[kUvt4Row] / seconds[kRaytraceRow]));
    };
    check.here = text(here), check.paper = text(paper);
    check.held = here[kRaytraceRow] < std::min({here[kIntervalRow], here[kUvt2Row], here[kUvt4Row]});
    return check;
}

std::vector<StudyCheck> checks_of_effects(const std::vector<std::vector<double>>& here,
                                          const std::vector<std::vector<double>>& paper) {
    const auto spread_text = [](const std::vector<double>& row) {
        return number_text(spread(row)) + " between the slowest and the fastest effect";
    };
    StudyCheck uvt{"INTERLEAVEUVT k = 2 costs the same for every effect, but for a quarter",
                   spread_text(paper[kUvt2Row]), spread_text(here[kUvt2Row])};
    uvt.held = spread(here[kUvt2Row]) <= 1.25;
    const auto both = [](const std::vector<double>& row) { return row[2] / std::max(row[0], row[1]); };
    const auto both_text = [&](const std::vector<double>& row) {
        return "both effects " + number_text(both(row)) + "x the dearer one alone";
    };
    StudyCheck interval{
        "INTERVAL costs at least 1.5 times as much for both effects as for the dearer one alone",
        both_text(paper[kIntervalRow]), both_text(here[kIntervalRow])};
    interval.held = both(here[kIntervalRow]) >= 1.5;
    StudyCheck tracing{"a second effect adds less to ray tracing than to INTERVAL",
                       both_text(paper[kRaytraceRow]), both_text(here[kRaytraceRow])};
    tracing.held = both(here[kRaytraceRow]) < both(here[kIntervalRow]);
    return {uvt, interval, tracing};
}

std::vector<StudyCheck> checks_of_structure(const std::vector<std::vector<double>>& rmse,
                                            const std::vector<std::vector<double>>& together) {
    constexpr size_t kEffects = 3, kBoth = 2;
    const auto to_tracing = [](const std::vector<std::vector<double>>& figures, size_t method) {
        std::vector<double> ratios;
        for (size_t e = 0; e < kEffects; ++e) ratios.push_back(figures[method][e] / figures[kRaytraceRow][e]);
        return ratios;
    };
    const auto text = [](const std::vector<double>& ratios) {
        return fmt::format("{} with defocus, {} with motion blur, {} with both", times(ratios[0]),
                           times(ratios[1]), times(ratios[2]));
    };
    const std::vector<double> interval = to_tracing(together, kIntervalRow),
                              uvt2 = to_tracing(together, kUvt2Row), uvt4 = to_tracing(together, kUvt4Row);
    StudyCheck alone{"INTERVAL's pixels err as one no more than ray tracing's (10 %) with one effect",
                     "alias-free", text(interval)};
    alone.held = interval[0] <= 1 + kAlike && interval[1] <= 1 + kAlike;
    StudyCheck both{"INTERVAL's pixels err as one more than ray tracing's (10 %) with both effects",
                    "\"may result in aliasing\"", text(interval)};
    both.held = interval[kBoth] > 1 + kAlike;
    StudyCheck tiles{
        "INTERLEAVEUVT's pixels err as one more than ray tracing's, and less with k = 4 than with k = 2",
        "\"increasing k improves quality\"", "k = 2: " + text(uvt2) + "; k = 4: " + text(uvt4)};
    tiles.held = true;
    for (size_t e = 0; e < kEffects; ++e) tiles.held = tiles.held && uvt2[e] > uvt4[e] && uvt4[e] > 1;
    if (!tiles.held)
        tiles.why =
            "the k x k pixels of a tile share one stratification of lens and time, so that their errors may cancel "
            "where a block has all of them";
    StudyCheck noise{
        "ray tracing's error is less than INTERLEAVEUVT's with every effect", "\"less noise\"",
        "k = 2: " + text(to_tracing(rmse, kUvt2Row)) + "; k = 4: " + text(to_tracing(rmse, kUvt4Row))};
    noise.held = true;
    for (const size_t method : {kUvt2Row, kUvt4Row})
        for (const double ratio : to_tracing(rmse, method)) noise.held = noise.held && ratio > 1;
    return {alone, both, tiles, noise};
}

std::vector<StudyCheck> checks_of_sweep(const std::string& what,
                                        const std::vector<std::vector<double>>& seconds,
                                        const std::vector<double>& alone) {
    constexpr size_t kRaytrace = 0, kInterval = 1, kUvt = 2;
    const auto growth = [&](size_t method) { return seconds[method].back() / seconds[method].front(); };
    StudyCheck interval{
        what + ": ray tracing's time grows less than INTERVAL's from none to most",
        "\"significantly less sensitive\" (to defocus)",
        fmt::format("{} against {} from none to most", times(growth(kRaytrace)), times(growth(kInterval)))};
    interval.held = growth(kRaytrace) < growth(kInterval);
    double least = 1e30;
    for (size_t i = 0; i < seconds[kUvt].size(); ++i)
        least = std::min(least, seconds[kUvt][i] / seconds[kRaytrace][i]);
    StudyCheck uvt{what + ": ray tracing stays ahead of INTERLEAVEUVT k = 4 at every blur",
                   "ahead everywhere", "k = 4 takes at least " + number_text(least) + "x its time"};
    uvt.held = least > 1;
    return {interval, uvt, check_of_blur(what + ": ray tracing", seconds[kRaytrace]),
            check_of_blur(what + ": a ray by itself", alone)};
}

std::vector<StudyCheck> checks_of_splits(const SplitCosts& here, const SplitCosts& paper) {
    return {{"parametric splits cost no more than greedy SAH on the mean", percent_text(paper.mean),
             percent_text(here.mean), here.mean <= 0},
            {"parametric splits are at least as good for most grids", share_text(paper.at_most_0),
             share_text(here.at_most_0), here.at_most_0 > .5},
            {"they are no worse than 20 % for at least nine grids in ten", share_text(paper.at_most_fifth),
             share_text(here.at_most_fifth), here.at_most_fifth >= .9}};
}

StudyCheck check_of_bounds(const std::string& scene, const std::string& others, double here, double paper) {
    return {scene + ": oriented boxes beat " + others + " by at least the paper's ratio",
            number_text(paper) + "x the trace time", number_text(here) + "x the trace time", here >= paper};
}

StudyCheck check_of_parametric_splits(const std::string& scene, const GreedyRatios& here,
                                      const GreedyRatios& paper) {
    const auto text = [](const GreedyRatios& ratios) {
        return fmt::format("without: build {}x, trace {}x", number_text(ratios.build),
                           number_text(ratios.trace));
    };
    return {scene +
                ": parametric splits build more than twice as fast as greedy SAH, and trace no more "
                "than 5 % slower",
            text(paper), text(here), here.build > 2 && here.trace >= .95};
}

}  // namespace trapeze
