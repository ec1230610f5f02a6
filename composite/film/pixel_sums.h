/// Filtered sums of a pixel's samples, many at a time.
#pragma once

#include <cstddef>
#include <vector>

#include "composite/filters/filters.h"

namespace trapeze {

/// What the samples of one pixel at a time add to the pixels around it: sums of weights, and of weighted
/// colours and alphas. Sample s is added in lane s % 16, and the lanes' sums in a fixed order, so that all
/// instruction sets give the same bits. One a thread.
class PixelSums {
  public:
    /// Of these filters, for pixels of so many samples: else a sample at a time is as fast.
    static bool suits(const FilterKernel& kernel, int samples_per_pixel) {
        return kernel.is_separable() && kernel.taps_x() <= kMostTaps && kernel.taps_y() <= kMostTaps &&
               samples_per_pixel >= kLeastSamples;
    }
    PixelSums(const FilterKernel& kernel, int samples_per_pixel);

    /// Sets what a sample of the pixel sees, premultiplied; which is to be finite.
    void set_color(size_t sample, const float* rgba) {
        for (size_t c = 0; c < 4; ++c) plane(c)[sample] = rgba[c];
    }
    /// Sums up samples at raster positions x, y in a pixel, `colored` or weights alone.
    void sum(const float* x, const float* y, int pixel_x, int pixel_y, bool colored);

    int columns() const { return columns_; }
    int rows() const { return rows_; }
    /// Of column i and row j, counted from reach_x() and reach_y() left of and above the pixel: weight, then
    /// four channels, which are there where the last sum() was of colours.
    const float* at(int i, int j) const { return sums_ + kChannels * (j * columns_ + i); }

  private:
    static constexpr int kMostTaps = 4, kLeastSamples = 8;
    static constexpr int kMostColumns = kMostTaps + 1;  ///< a sample's taps begin at one of two columns
    static constexpr int kChannels = 5;

    float* plane(size_t n) { return planes_.data() + aligned_ + n * padded_; }

    const FilterKernel& kernel_;
    const size_t count_, padded_;  ///< samples, and these to whole groups of 16
    const int columns_, rows_;
    std::vector<float> planes_;  ///< colours and alpha, then weights by column, then by row
    size_t aligned_ = 0;         ///< where in planes_ the first plane begins, so that all begin cache lines
    alignas(64) float sums_[kChannels * kMostColumns * kMostColumns] = {};
};

}  // namespace trapeze
