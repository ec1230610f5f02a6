/// What the writers of file formats are given.
#pragma once

#include <span>

#include "composite/displays/display_plan.h"
#include "composite/displays/write_displays.h"

namespace trapeze {

/// One file to be written: the picture, and how.
struct PictureToWrite {
    const Image& image;  ///< its window is not empty
    const RenderContext& context;
    const DisplayPlan& plan;  ///< of the file's first display, which says how the file is made
    const OutputInfo& info;
    std::span<const DisplayPlan> further = {};  ///< of other displays of the file: layers of an OpenEXR
};

/// Whether a plan is for an output variable that the picture does not have; the error is kNoVariables.
inline bool lacks_variable(const Image& image, const DisplayPlan& plan) {
    return plan.aov && image.aov_channels < plan.aov->offset + plan.aov->channels;
}
inline constexpr const char* kNoVariables = "no output variables were recorded";

}  // namespace trapeze
