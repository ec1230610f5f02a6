/// What the samples of one pixel see: the one form in which the film sums them, whatever it was made of.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "composite/film/film_rules.h"
#include "composite/film/sample_planes.h"
#include "composite/layers/hit_layers.h"
#include "composite/layers/seen_layers.h"
#include "core/math.h"

namespace trapeze {

struct FilmPart;

/// What one sample sees. Where it has no hits, the colour is 0, and there is nothing else.
struct SeenSample {
    float rgba[4] = {0, 0, 0, 0};       ///< premultiplied by opacity
    float depth = kInfinity;            ///< of the first layer that counts, or that of "midpoint"
    uint32_t primitive = ~uint32_t{0};  ///< whose that layer is; where it is wanted
    bool has_hits = false;
    const float* variables = nullptr;  ///< AovLayout::channel_count numbers
    float variables_depth =
        kInfinity;  ///< of the first layer that shows something, where there are variables
    std::span<const SeenLayer> layers;  ///< where they are wanted
};

/// Serves for one pixel after another, of `count` samples each.
class PixelSamples {
  public:
    PixelSamples(const FilmRules& rules, size_t count);

    size_t count() const { return depths_.size(); }

    /// Finds what samples of a part see, from number `first` on.
    void see(const FilmPart& part, size_t first);
    /// Takes samples of elsewhere instead, one by one in their order: of(0), of(1) and on.
    void begin();
    void set(size_t sample, const SeenSample& seen);

    bool sees_something() const { return sees_something_; }
    SeenSample of(size_t sample) const;
    /// Colours and alphas of all samples, 0 where there are no hits.
    const SamplePlanes& colors() const { return colors_; }
    bool has_hits(size_t sample) const { return has_hits_[sample] != 0; }
    std::span<const float> depths() const { return depths_; }
    uint32_t primitive(size_t sample) const { return primitives_[sample]; }
    const float* variables(size_t sample) const { return variables_.data() + channels_ * sample; }
    float variables_depth(size_t sample) const { return variables_depths_[sample]; }
    std::span<const SeenLayer> layers(size_t sample) const {
        return std::span(layers_).subspan(first_layer_[sample],
                                          first_layer_[sample + 1] - first_layer_[sample]);
    }

  private:
    void set_color(size_t sample, const float* rgba, float depth, uint32_t primitive, bool has_hits);
    void see_covered(const FilmPart& part, size_t first);
    void see_plain_layers(const FilmPart& part, size_t first);
    void see_one_by_one(const FilmPart& part, size_t first);
    void see_extras(const FilmPart& part, size_t first);

    const FilmRules& rules_;
    const size_t channels_;  ///< of variables
    bool sees_something_ = false;
    SamplePlanes colors_;
    std::vector<uint8_t> has_hits_;
    std::vector<float> depths_;
    std::vector<uint32_t> primitives_;
    std::vector<float> variables_, variables_depths_;
    std::vector<SeenLayer> layers_;
    std::vector<size_t> first_layer_;  ///< of each sample, and the end
    HitLayers hit_layers_;
    std::vector<int32_t> nearest_;  ///< of each sample: the first layer that leaves a trace, or -1
};

}  // namespace trapeze
