/// How much of pixels each name covers: sums that only names have that are there.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "composite/filters/filters.h"
#include "composite/mattes/matte_layers.h"
#include "core/pixel_rect.h"

namespace trapeze {

/// How much of something a key of MatteKeys covers.
struct MatteCoverage {
    uint32_t key = 0;
    float weight = 0;
};

/// A pixel's coverage, in the order in which keys came.
struct MattePixel {
    float weight = 0;  ///< of all samples, whether they see anything or not
    std::vector<MatteCoverage> coverages;

    void add(uint32_t key, float covered) {
        for (MatteCoverage& known : coverages)
            if (known.key == key) {
                known.weight += covered;
                return;
            }
        coverages.push_back({key, covered});
    }
    void add(const MattePixel& other) {
        weight += other.weight;
        for (const MatteCoverage& coverage : other.coverages) add(coverage.key, coverage.weight);
    }
};

/// A tile's sums, over its footprint as of FilterKernel::footprint().
class MatteSums {
  public:
    explicit MatteSums(const PixelRect& footprint)
        : pixels_(footprint),
          sums_(static_cast<size_t>(footprint.width()) * static_cast<size_t>(footprint.height())) {}

    /// Adds a sample to the pixels of its taps, by the kernel's weights and so many times over.
    void add(const FilterTaps& taps, const FilterKernel& kernel, const float* weights, float times,
             std::span<const MatteCoverage> sample);

    const PixelRect& pixels() const { return pixels_; }
    const MattePixel& at(int x, int y) const { return sums_[index(x, y)]; }
    size_t bytes() const;

  private:
    size_t index(int x, int y) const {
        return static_cast<size_t>(y - pixels_.y0) * static_cast<size_t>(pixels_.width()) +
               static_cast<size_t>(x - pixels_.x0);
    }

    PixelRect pixels_;
    std::vector<MattePixel> sums_;
};

/// Writes the ranks of a pixel in each layer: kMatteFloats numbers a layer, ids and coverages by turns, the
/// greatest coverage first, of equal ones the lesser bits of the id; 0 behind the last. Returns the greatest
/// coverage that a layer has left out.
float rank_mattes(const MattePixel& pixel, const MatteKeys& keys, float* ranks);

}  // namespace trapeze
