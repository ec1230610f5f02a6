/// How much a frame blurs: the sizes, in pixels, of circles of confusion and of ways through the picture.
#pragma once

#include <vector>

#include "core/grid.h"
#include "core/scene/camera.h"

namespace trapeze {

/// Sizes of one kind of blur over a whole frame.
struct BlurSize {
    float largest = 0, median = 0;  ///< pixels; the median is over micropolygons
};

/// Both kinds of a frame's blur.
struct FrameBlur {
    BlurSize motion;   ///< length of the way in raster space while the shutter is open
    BlurSize defocus;  ///< diameter of the circle of confusion
};

/// Measures blur at a few vertices of each grid. What is nearer than the near clipping plane does not count.
FrameBlur measure_blur(const Camera& camera, const Grids& grids);

/// The value that half of the weight lies at or below; 0 of none.
float weighted_median(std::vector<std::pair<float, uint64_t>> values);

}  // namespace trapeze
