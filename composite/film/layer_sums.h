/// From the layers that samples see to mattes and deep pixels.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "composite/film/deep_pixel.h"
#include "composite/film/matte_sums.h"
#include "composite/filters/filters.h"
#include "composite/layers/seen_layers.h"
#include "composite/mattes/matte_layers.h"

namespace trapeze {

/// What of samples' layers is wanted.
struct LayerRules {
    const MatteKeys* keys = nullptr;       ///< null: no mattes
    const FilterKernel* kernel = nullptr;  ///< of mattes
    std::optional<float> deep_tolerance;   ///< nothing: no deep pixels

    bool want_layers() const { return keys || deep_tolerance; }
};

/// Serves for one pixel after another, whose samples come in their order.
class LayerSums {
  public:
    explicit LayerSums(const LayerRules& rules);

    void begin(int px, int py);
    /// Adds a sample at raster position x, y. `share`: how many times over it counts in mattes.
    void add(std::span<const SeenLayer> layers, float x, float y, float share, MatteSums* mattes);
    /// The pixel's deep samples, where they are wanted.
    std::vector<DeepSample> deep_samples();

  private:
    const LayerRules& rules_;
    int px_ = 0, py_ = 0;
    std::vector<float> weights_;
    std::vector<MatteCoverage> coverages_;
    DeepPixel deep_;
};

}  // namespace trapeze
