/// The samples of Pixar's method as [Hou10 sec. 5] describes it: time and lens are split into as many regions
/// as a pixel has samples, and sample s of every pixel has the same region of both. Whatever moves while it
/// is out of focus shows that correlation; in exchange one bound of a micropolygon holds for all samples s.
#pragma once

#include "sample/patterns/sample_pattern.h"
#include "sample/patterns/strata.h"

namespace trapeze {

/// nx * ny samples a pixel, sample s being the one of time region s.
class IntervalPattern final : public SamplePattern {
  public:
    explicit IntervalPattern(const RenderContext& context);

    /// Sample s of a pixel is jittered in time region s, in the lens region that goes with it, and in a
    /// subpixel region that differs from pixel to pixel.
    void make_tile(const PixelRect& pixels, SampleTile& tile) const override;

    /// Bounds that hold for sample `sample` of every pixel, bit for bit.
    TimeSpan time_bounds(int sample) const;
    LensBox lens_bounds(int sample) const;

  private:
    void make_pixel(int px, int py, std::vector<uint32_t>& subpixels, size_t first, SampleTile& tile) const;

    std::vector<uint32_t> lens_of_;  ///< sample, which is its time region -> lens region
};

}  // namespace trapeze
