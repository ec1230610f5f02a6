/// The report's sections of pictures: whole ones, and the worst places close up.
#pragma once

#include <string>

#include "pipeline/compare/comparison.h"
#include "pipeline/compare/report/screen_pictures.h"

namespace trapeze {

/// HTML of both sections; pictures are inside it, as data: URLs.
std::string report_pictures(const Comparison& comparison);

/// HTML of a close-up and its name, every pixel `magnified` times as large; `attributes` of the element, each
/// after a space.
std::string close_up_figure(const LinearPicture& picture, const std::string& name, int magnified,
                            const std::string& attributes = {});

}  // namespace trapeze
