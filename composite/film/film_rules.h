/// What the film wants of samples, besides colours.
#pragma once

#include "composite/film/layer_sums.h"
#include "core/scene/aov.h"
#include "core/scene/depth_filter.h"

namespace trapeze {

struct FilmRules {
    const AovLayout* aovs = nullptr;
    DepthFilter depth_filter = DepthFilter::Min;
    DepthRule depth_rule = {};
    LayerRules layers = {};
    bool wants_primitives = false;  ///< which is seen at a pixel's centre
};

}  // namespace trapeze
