/// Plots as inline SVG, coloured by the report's style sheet.
#pragma once

#include <string>

#include "pipeline/study/study_result.h"

namespace trapeze {

/// Series as lines. Axes are linear; that of y begins at 0. The first three series have colours of their own.
std::string line_plot(const LinePlot& plot);

/// Bars of counts by bin, with a line at 0 where the bins span it.
std::string histogram_plot(const HistogramPlot& plot);

}  // namespace trapeze
