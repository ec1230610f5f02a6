/// Linear axes of plots.
#pragma once

#include <vector>

namespace trapeze {

/// A linear axis: from values to places.
struct PlotAxis {
    double low = 0, high = 1;   ///< values
    double begin = 0, end = 1;  ///< their places, in the picture's units; end may lie before begin

    double place(double value) const { return begin + (value - low) / (high - low) * (end - begin); }
    /// Round numbers between the ends, for labels: about `count`.
    std::vector<double> ticks(int count) const;
};

/// An axis on which everything from `low` to `high` has room; a range of nothing becomes one around it.
PlotAxis plot_axis(double low, double high, double begin, double end);

}  // namespace trapeze
