/// A pixel of a deep picture: what is seen at which depth.
#pragma once

#include <span>
#include <vector>

#include "composite/deep_sample.h"
#include "composite/layers/seen_layers.h"

namespace trapeze {

/// Gathers the samples of one pixel after another, which all weigh the same: a box filter of a pixel's width.
///
/// The samples of a deep pixel are such that, put over each other, they are the mean of the pixel's samples:
/// each has the colour and alpha of its layers, divided by what the ones before it let through.
class DeepPixel {
  public:
    void begin();
    /// The layers that a sample of the pixel sees; none are a sample, too.
    void add(std::span<const SeenLayer> layers);
    /// The pixel, front to back.
    std::vector<DeepSample> samples(float tolerance);

  private:
    size_t count_ = 0;
    std::vector<SeenLayer> layers_;
};

}  // namespace trapeze
