/// Adaptive sampling: pixels take as many samples as their picture needs.
#pragma once

#include "core/scene/scene.h"

namespace trapeze {

/// What a scene's options ask for.
struct AdaptiveSampling {
    /// Samples of a pixel along each axis, at most, and in how many levels they come: a pixel may stop at the
    /// first, which has samples_x >> (levels - 1) by samples_y >> (levels - 1). 1 level: all pixels have all.
    int samples_x = 1, samples_y = 1, levels = 1;
    float variance = 0;  ///< that pixels are to have, of linear values; where they take all samples, more

    bool is_on() const { return levels > 1; }
};

/// Without adaptive sampling the counts are PixelSamples, rounded to at least 1. With it they are rounded up
/// to what has levels.
AdaptiveSampling adaptive_sampling(const Options& options);

}  // namespace trapeze
