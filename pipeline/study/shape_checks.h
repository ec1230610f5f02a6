/// Shapes that figures have, as checks: what must hold of a faithful repetition, whatever the machine.
#pragma once

#include <string>
#include <vector>

#include "pipeline/study/study_result.h"

namespace trapeze {

/// The power of x that y grows with between the first and the last point; 1 is linear.
double growth_exponent(double x0, double y0, double x1, double y1);

/// The largest to the smallest; 0 of none.
double spread(const std::vector<double>& values);

/// "5.2 s", and "-" of what there is not (negative).
std::string paper_seconds(double seconds);

/// Checks of one row of four methods (paper::kMethods) at growing samples a pixel.
struct RateSeries {
    std::string scene;
    std::vector<int> samples;                  ///< a pixel
    std::vector<std::vector<double>> seconds;  ///< by method, then by rate
};

/// rasterizers: cost against samples, and k = 4 against k = 2; ray tracing: what more samples do for it.
std::vector<StudyCheck> checks_of_rates(const RateSeries& here, const RateSeries& paper);

/// Coarser shading helps rasterizers more than ray tracing. Seconds by method, at the reference rate and with
/// micropolygons 16 times as large.
StudyCheck check_of_coarser_shading(const std::string& scene, const std::vector<double>& reference,
                                    const std::vector<double>& coarser,
                                    const std::vector<double>& paper_reference,
                                    const std::vector<double>& paper_coarser);

/// Ray tracing against the rasterizers at one rate: by method.
StudyCheck check_of_order(const std::string& scene, const std::vector<double>& here,
                          const std::vector<double>& paper);

/// That blur, which grows from none, costs little: a method's times by blur.
StudyCheck check_of_blur(const std::string& method, const std::vector<double>& times);

/// What a ray costs in scenes of ever more micropolygons.
struct GrowthSeries {
    std::string name;
    std::vector<double> micropolygons, nanoseconds, nodes;  ///< the latter two a ray
};

/// Of rays in bundles and of rays each by itself, in the same scenes.
std::vector<StudyCheck> checks_of_growth(const GrowthSeries& bundles, const GrowthSeries& alone);

}  // namespace trapeze
