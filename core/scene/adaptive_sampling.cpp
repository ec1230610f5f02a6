#include "core/scene/adaptive_sampling.h"

#include <algorithm>
#include <cmath>

namespace trapeze {
namespace {

constexpr int kMostHalvings = 2;
constexpr int kLeastSide = 3;  ///< samples along each axis, at most, below which nothing can be saved
constexpr int kUsualSide = 4;  ///< of the first level, where nobody says

int count_of(float samples) {
    return std::max(1, static_cast<int>(std::lround(samples)));
}

int rounded_up(int value, int step) {
    return (value + step - 1) / step * step;
}

/// How often `most` is halved to come near `least`, by ratio.
int halvings(int most, int least) {
    const double ratio = static_cast<double>(most) / std::max(1, least);
    int times = 1;
    // Between n and n + 1 halvings lies the ratio 2^(n + 1/2).
    while (times < kMostHalvings && ratio * ratio > std::ldexp(1.0, 2 * times + 1)) ++times;
    return times;
}

}  // namespace

AdaptiveSampling adaptive_sampling(const Options& options) {
    AdaptiveSampling result{count_of(options.samples_x), count_of(options.samples_y)};
    if (!(options.pixel_variance > 0) || !options.adaptive) return result;
    const int least = options.least_samples > 0 ? count_of(options.least_samples) : kUsualSide;
    const int times = halvings(std::min(result.samples_x, result.samples_y), least), step = 1 << times;
    const int x = rounded_up(result.samples_x, step), y = rounded_up(result.samples_y, step);
    if (std::min(result.samples_x, result.samples_y) < kLeastSide) return result;
    return {x, y, times + 1, options.pixel_variance};
}

}  // namespace trapeze
