/// What the writers of file formats are given.
#pragma once

#include "composite/displays/display_plan.h"
#include "composite/displays/write_displays.h"

namespace trapeze {

/// One file to be written: the picture, and how.
struct PictureToWrite {
    const Image& image;  ///< its window is not empty
    const RenderContext& context;
    const DisplayPlan& plan;
    const OutputInfo& info;
};

/// Whether the plan is for an output variable that the picture does not have; the error is kNoVariables.
inline bool lacks_variable(const PictureToWrite& picture) {
    return picture.plan.aov &&
           picture.image.aov_channels < picture.plan.aov->offset + picture.plan.aov->channels;
}
inline constexpr const char* kNoVariables = "no output variables were recorded";

}  // namespace trapeze
