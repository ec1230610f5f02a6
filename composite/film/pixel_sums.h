/// Filtered sums of a pixel's samples, many at a time.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "composite/film/sample_planes.h"
#include "composite/filters/filters.h"

namespace trapeze {

/// Sums of pixels, one after another.
struct SumsOfPixels {
    SumsOfPixels(size_t of_each, size_t pixels)
        : per_pixel(of_each),
          count(of_each * pixels),
          sums((count + 15) / 16 * 16),
          quarters(4 * sums.size()) {}

    size_t per_pixel, count;
    std::vector<float> sums;      ///< and room for a whole vector
    std::vector<float> quarters;  ///< four numbers that become each
};

/// What the samples of one pixel at a time add to the pixels around it: sums of weights, and of weighted
/// numbers. Sample s is added in lane s % 16, and the lanes' sums in a fixed order, so that all instruction
/// sets give the same bits; few samples are added one by one (SamplePlanes::group_of()). One a thread.
class PixelSums {
  public:
    /// `channels`: numbers of each sample.
    PixelSums(const FilterKernel& kernel, size_t samples_per_pixel, size_t channels);

    /// Sums up samples at raster positions x, y in a pixel: the weights, and so many of the channels, whose
    /// planes are of SamplePlanes for as many samples. A number that is not finite goes where its sample has
    /// a weight, and nowhere else.
    void sum(const float* x, const float* y, int pixel_x, int pixel_y, std::span<const float* const> planes);

    int columns() const { return columns_; }
    int rows() const { return rows_; }
    /// Of column i and row j, counted from reach_x() and reach_y() left of and above the pixel: weight, then
    /// the channels of the last sum().
    const float* at(int i, int j) const {
        return sums_.sums.data() + sums_.per_pixel * static_cast<size_t>(j * columns_ + i);
    }

  private:
    void weigh_one_by_one(const float* x, const float* y, int pixel_x, int pixel_y);

    const FilterKernel& kernel_;
    const size_t count_;
    const int columns_, rows_;
    /// Of a separable filter by column, then by row; else of each pixel around, row by row, then a plane
    /// of 1.
    SamplePlanes weights_;
    SumsOfPixels sums_;
    std::vector<float> taps_;  ///< of a sample
};

}  // namespace trapeze
