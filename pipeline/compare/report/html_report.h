/// A comparison as one HTML file that needs no network: pictures, crops, differences, heat maps, charts, the
/// table, the machine, and every figure as JSON.
#pragma once

#include <string>

#include "pipeline/compare/comparison.h"

namespace trapeze {

/// The whole file's text.
std::string html_report(const Comparison& comparison);

}  // namespace trapeze
