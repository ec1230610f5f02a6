/// Shapes that figures have, as checks: what must hold of a faithful repetition, whatever the machine.
#pragma once

#include <string>
#include <vector>

#include "pipeline/study/study_result.h"

namespace trapeze {

/// The power of x that y grows with between the first and the last point; 1 is linear.
double growth_exponent(double x0, double y0, double x1, double y1);

/// The ratio of the largest value to the smallest; 0 of none.
double spread(const std::vector<double>& values);

/// A figure of the paper as tables show it: "5.2 s", and "-" where the paper has none (negative).
std::string paper_seconds(double seconds);

/// "+1.5 %", and "15 % of the grids".
std::string percent_text(double part);
std::string share_text(double part);

/// What one scene costs four methods (paper::kMethods) at growing numbers of samples.
struct RateSeries {
    std::string scene;
    std::vector<int> samples;                  ///< a pixel
    std::vector<std::vector<double>> seconds;  ///< by method, then by rate
};

/// Checks that rasterizers cost in proportion to samples, k = 4 against k = 2, and that ray tracing gains
/// from more samples; against the same figures of the paper.
std::vector<StudyCheck> checks_of_rates(const RateSeries& here, const RateSeries& paper);

/// Checks that coarser shading helps rasterizers more than ray tracing. Seconds are by method, at the
/// reference rate and with micropolygons 16 times as large.
StudyCheck check_of_coarser_shading(const std::string& scene, const std::vector<double>& reference,
                                    const std::vector<double>& coarser,
                                    const std::vector<double>& paper_reference,
                                    const std::vector<double>& paper_coarser);

/// Checks where ray tracing stands against the rasterizers at one rate. Seconds are by method.
StudyCheck check_of_order(const std::string& scene, const std::vector<double>& here,
                          const std::vector<double>& paper);

/// Checks what motion blur, defocus and both of them cost. Seconds are by method (paper::kMethods), then by
/// defocus, motion, both.
std::vector<StudyCheck> checks_of_effects(const std::vector<std::vector<double>>& here,
                                          const std::vector<std::vector<double>>& paper);

/// Checks that blur, which grows from none, costs little. Seconds are by amount of blur.
StudyCheck check_of_blur(const std::string& method, const std::vector<double>& times);

/// Checks how pictures err: root mean square errors, and pixels that err as one. Both are by method
/// (paper::kMethods), then by defocus, motion, both.
std::vector<StudyCheck> checks_of_structure(const std::vector<std::vector<double>>& rmse,
                                            const std::vector<std::vector<double>>& together);

/// Checks how costs grow with blur. Seconds are by method (ray tracing, INTERVAL, k = 4), then by amount of
/// blur; `alone`: of a ray by itself.
std::vector<StudyCheck> checks_of_sweep(const std::string& what,
                                        const std::vector<std::vector<double>>& seconds,
                                        const std::vector<double>& alone);

/// How the SAH costs of grids by parametric splits differ from those by the greedy SAH, relatively: the mean,
/// and the parts of the grids that differ by at most 0 and at most .2.
struct SplitCosts {
    double mean, at_most_0, at_most_fifth;
};

/// Checks that parametric splits cost about as little as the greedy SAH.
std::vector<StudyCheck> checks_of_splits(const SplitCosts& here, const SplitCosts& paper);

/// Checks that oriented boxes trace faster than others: `here` and `paper` are the others' trace time, by
/// that of oriented ones.
StudyCheck check_of_bounds(const std::string& scene, const std::string& others, double here, double paper);

/// Times of building by the greedy SAH and of tracing what it built, by those of parametric splits.
struct GreedyRatios {
    double build, trace;
};

/// Checks that parametric splits build faster and trace as fast.
StudyCheck check_of_parametric_splits(const std::string& scene, const GreedyRatios& here,
                                      const GreedyRatios& paper);

/// What a ray costs in one scene with ever more micropolygons.
struct GrowthSeries {
    std::string name;
    std::vector<double> micropolygons, nanoseconds, nodes;  ///< the latter two a ray
};

/// Checks how the cost of a ray grows, in bundles and alone, in the same scenes.
std::vector<StudyCheck> checks_of_growth(const GrowthSeries& bundles, const GrowthSeries& alone);

}  // namespace trapeze
