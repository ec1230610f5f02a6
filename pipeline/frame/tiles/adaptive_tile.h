/// Adaptive sampling of a tile: few samples of every pixel, a look at how noisy each is, more where that
/// pays.
#pragma once

#include <cstdint>
#include <vector>

#include "composite/film/film.h"
#include "composite/film/gathered_samples.h"
#include "core/scene/render_context.h"
#include "pipeline/frame/tiles/layer_passes.h"
#include "pipeline/frame/tiles/pixel_noise.h"
#include "sample/visibility.h"

namespace trapeze {

struct HeatMap;

/// Where an adaptive tile's samples come from and go.
struct AdaptiveTask {
    const RenderContext& context;
    const SamplePattern& pattern;  ///< with levels
    const Visibility& visibility;  ///< of a method that takes lists
    const Grids& grids;
    bool all_opaque;
    const LayerLimits& limits;
    Film& film;
};

/// A thread's working memory.
///
/// What a pixel gets depends on samples of its own square of kTileSide pixels alone, so that threads, regions
/// and crops make no difference: a crop samples whole squares (sampled_pixels()).
///
/// The samples that lower the error of the whole picture most for what they cost are shared out in proportion
/// to the root of the noise [Neyman34]: a pixel of noise v is to have n = sqrt(v * most / V) samples, V the
/// picture's variance. With all of its `most` samples it then has the variance V; a noisier one has more, a
/// less noisy one less.
///
/// A pixel goes by what its neighbours have seen, never by its own samples: were it to stop where it has seen
/// nothing, what is rarely seen would be missed in the mean [Kirk91]. And it decides once, by first levels
/// alone, since later samples are only where first ones have asked for them.
class AdaptiveTile {
  public:
    /// Samples a square and adds it to the film; returns how many samples that took.
    uint64_t add(const AdaptiveTask& task, const PixelRect& pixels, LayerPasses& passes,
                 SampleScratch& scratch, SampleStats& stats);

    /// How many samples each pixel of the last square has taken.
    void count_samples(HeatMap& heat) const;

    double pattern_seconds() const { return pattern_seconds_; }
    double composite_seconds() const { return composite_seconds_; }

  private:
    size_t at(int x, int y) const {
        return static_cast<size_t>(y - pixels_.y0) * pixels_.width() + static_cast<size_t>(x - pixels_.x0);
    }
    void list_pixels();
    void take(const AdaptiveTask& task, const std::vector<PixelPlace>& pixels, int from, int to,
              LayerPasses& passes, SampleScratch& scratch, SampleStats& stats);
    void estimate_noise(const AdaptiveTask& task);
    template <class NoiseOf>
    float mean_around(const PixelPlace& pixel, int reach, const NoiseOf& noise_of) const;
    int wanted_level(const AdaptiveTask& task, const PixelPlace& pixel) const;

    PixelRect pixels_;
    std::vector<PixelPlace> all_;                   ///< along a Z-order curve
    std::vector<std::vector<PixelPlace>> refined_;  ///< by the level that they are to have
    std::vector<PixelNoise> noise_;                 ///< of pixels, row by row
    SampleTile samples_;
    GatheredSamples gathered_;
    double pattern_seconds_ = 0, composite_seconds_ = 0;
};

}  // namespace trapeze
