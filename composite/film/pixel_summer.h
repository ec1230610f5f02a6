/// From what a pixel's samples see to what the film keeps of them.
#pragma once

#include <vector>

#include "composite/film/film_rules.h"
#include "composite/film/pixel_samples.h"
#include "composite/film/pixel_sums.h"
#include "composite/film/pixel_variables.h"
#include "composite/film/tile_sums.h"

namespace trapeze {

/// What a film keeps of a pixel beside sums, which is of the pixel's own samples alone.
struct PixelRecord {
    float depth;
    uint32_t primitive;               ///< at its centre
    const PixelVariables* variables;  ///< that are no sums; null: there are none
    LayerSums* layers;                ///< null: they are not wanted
};

/// Serves for one pixel after another, of so many samples each.
class PixelSummer {
  public:
    /// `share`: how many times over each sample counts.
    PixelSummer(const FilterKernel& kernel, const FilmRules& rules, size_t count, float share = 1);

    /// Adds samples at raster positions x, y in a pixel to a tile's sums. The record is that of the last
    /// pixel.
    PixelRecord add(int px, int py, const float* x, const float* y, const PixelSamples& samples,
                    TileSums& sums);

  private:
    void take_variables(const PixelSamples& samples);
    void add_layers(int px, int py, const float* x, const float* y, const PixelSamples& samples,
                    TileSums& sums);

    const FilterKernel& kernel_;
    const FilmRules& rules_;
    const size_t count_, channels_;  ///< channels of variables
    const float share_;
    PixelSums pixel_;
    SamplePlanes variables_;
    std::vector<const float*> planes_;  ///< of colours, then of variables
    std::vector<float> values_;         ///< of variables, of one sample
    const bool all_summed_;             ///< variables, if any
    PixelVariables kept_;
    LayerSums layers_;
};

}  // namespace trapeze
