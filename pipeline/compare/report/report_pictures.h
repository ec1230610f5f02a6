/// The report's sections of pictures: whole ones, and the worst places close up.
#pragma once

#include <string>

#include "pipeline/compare/comparison.h"

namespace trapeze {

std::string report_pictures(const Comparison& comparison);

}  // namespace trapeze
