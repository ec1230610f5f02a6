/// The report's sections of pictures: whole ones, and the worst places close up.
#pragma once

#include <string>

#include "pipeline/compare/comparison.h"

namespace trapeze {

/// HTML of both sections; pictures are inside it, as data: URLs.
std::string report_pictures(const Comparison& comparison);

}  // namespace trapeze
