/// A pixel of a deep picture: what is seen at which depth.
#pragma once

#include <span>
#include <vector>

#include "composite/film/seen_layers.h"

namespace trapeze {

/// A surface at a depth, with its own premultiplied colour and alpha: over what is behind it, as compositing
/// programs put samples of a deep picture together.
struct DeepSample {
    float depth = 0;
    float rgba[4] = {0, 0, 0, 0};

    bool operator==(const DeepSample&) const = default;
};

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
