/// Horizontal bars as inline SVG, coloured by the report's style sheet.
#pragma once

#include <string>
#include <vector>

namespace trapeze {

/// A bar, its words and its colour.
struct Bar {
    std::string label, text;  ///< to the left of the bar, and behind it
    std::string kind;         ///< class of the style sheet: tracer, raster or other
    double value = 0;
    double first_part = 0;  ///< the part of `value` that is drawn in another tone (on linear axes)
};

/// The chart as SVG. Values are not negative. The axis is logarithmic where the largest value is more than 25
/// times the smallest that is not 0; its title says so. `description` is for readers who cannot see it.
std::string bar_chart(const std::vector<Bar>& bars, const std::string& axis, const std::string& description);

}  // namespace trapeze
