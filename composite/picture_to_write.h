/// What the writers of file formats are given.
#pragma once

#include "composite/display_plan.h"
#include "composite/write_displays.h"

namespace trapeze {

struct PictureToWrite {
    const Image& image;  ///< its window is not empty
    const RenderContext& context;
    const DisplayPlan& plan;
    const OutputInfo& info;
};

}  // namespace trapeze
