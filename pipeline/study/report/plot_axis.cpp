#include "pipeline/study/report/plot_axis.h"

#include <cmath>

namespace trapeze {

std::vector<double> PlotAxis::ticks(int count) const {
    const double rough = (high - low) / count, power = std::pow(10, std::floor(std::log10(rough)));
    const double step = power * (rough <= power ? 1 : rough <= 2 * power ? 2 : rough <= 5 * power ? 5 : 10);
    std::vector<double> values;
    // By index, so that sums of steps do not drift; and no "-0".
    for (double i = std::ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i)
        values.push_back(i * step + 0.0);
    return values;
}

PlotAxis plot_axis(double low, double high, double begin, double end) {
    if (!(high > low)) low -= .5, high += .5;
    return {low, high, begin, end};
}

}  // namespace trapeze
