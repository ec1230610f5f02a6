/// A tile's samples whose hits come in parts, front to back: what each has gathered so far. Where hits of a
/// tile take too much memory, the film gets this instead of them [decision 0032].
#pragma once

#include <span>
#include <vector>

#include "composite/layers/hit_layers.h"
#include "composite/layers/resolve_layers.h"
#include "composite/layers/seen_layers.h"
#include "core/scene/aov.h"

namespace trapeze {

/// One a thread, used again from tile to tile.
class LayerStack {
  public:
    /// All samples have gathered nothing. The layout outlives the stack. `keeps_layers`: layers() will be
    /// asked.
    void begin(size_t sample_count, const AovLayout& aovs, const DepthRule& rule, bool keeps_layers = false);

    /// Adds the next hits of some samples, which are in ascending order.
    void add(const SampleTile& samples, const HitBuffer& hits, const Grids& grids,
             std::span<const uint32_t> which);

    /// Whether a sample's further hits change nothing.
    bool is_hidden(size_t sample) const { return sums_[sample].is_hidden; }
    /// Whether it has had any.
    bool has_hits(size_t sample) const { return has_hits_[sample] != 0; }
    SampleColor color(size_t sample) const { return sums_[sample].result(rule_); }
    const float* aovs(size_t sample) const {
        return values_.data() + sample * static_cast<size_t>(aovs_->channel_count);
    }
    const std::vector<SeenLayer>& layers(size_t sample) const { return layers_of_[sample]; }
    /// Of the first layer that shows something, where there are output variables.
    float aov_depth(size_t sample) const { return progress_[sample].depth; }

  private:
    const AovLayout* aovs_ = nullptr;
    DepthRule rule_;
    std::vector<LayerSum> sums_;
    std::vector<uint8_t> has_hits_;
    std::vector<AovProgress> progress_;  ///< of output variables; where there are some
    std::vector<float> values_;          ///< of output variables, sample after sample
    HitLayers layers_;
    std::vector<std::vector<SeenLayer>> layers_of_;  ///< by sample, where they are kept
    std::vector<V3f> transmissions_;                 ///< behind these
};

}  // namespace trapeze
