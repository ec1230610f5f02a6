/// Linear axes of plots.
#pragma once

#include <vector>

namespace trapeze {

struct PlotAxis {
    double low = 0, high = 1;   ///< values
    double begin = 0, end = 1;  ///< their places, in the picture's units; end may lie before begin

    double place(double value) const { return begin + (value - low) / (high - low) * (end - begin); }
    /// Round numbers: about `count`.
    std::vector<double> ticks(int count) const;
};

/// With room for everything between the two; a range of nothing becomes one around it.
PlotAxis plot_axis(double low, double high, double begin, double end);

}  // namespace trapeze
