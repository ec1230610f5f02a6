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

/// Checks that blur, which grows from none, costs little. Seconds are by amount of blur.
StudyCheck check_of_blur(const std::string& method, const std::vector<double>& times);

/// What a ray costs in one scene with ever more micropolygons.
struct GrowthSeries {
    std::string name;
    std::vector<double> micropolygons, nanoseconds, nodes;  ///< the latter two a ray
};

/// Checks how the cost of a ray grows, in bundles and alone, in the same scenes.
std::vector<StudyCheck> checks_of_growth(const GrowthSeries& bundles, const GrowthSeries& alone);

}  // namespace trapeze
