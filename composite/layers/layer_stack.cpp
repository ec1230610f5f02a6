#include "composite/layers/layer_stack.h"

namespace trapeze {
namespace {

/// Layers are interpolated of so many hits at a time, or of one sample's.
constexpr size_t kHitsAtOnce = 1024;

}  // namespace

void LayerStack::begin(size_t sample_count, const AovLayout& aovs, const DepthRule& rule, bool keeps_layers) {
    aovs_ = &aovs;
    layers_.forget();
    rule_ = rule;
    sums_.assign(sample_count, {});
    has_hits_.assign(sample_count, 0);
    const auto channels = static_cast<size_t>(aovs.channel_count);
    progress_.assign(channels == 0 ? 0 : sample_count, {});
    values_.assign(channels * sample_count, 0.0f);
    layers_of_.assign(keeps_layers ? sample_count : 0, {});
    transmissions_.assign(layers_of_.size(), V3f(1));
}

void LayerStack::add(const SampleTile& samples, const HitBuffer& hits, const Grids& grids,
                     std::span<const uint32_t> which) {
    size_t interpolated = 0;  // samples before this have their layers
    for (const uint32_t sample : which) {
        const std::span<const Hit> of_sample = hits.of(sample);
        if (of_sample.empty()) continue;
        if (sample >= interpolated) {
            interpolated = sample + 1;
            while (interpolated < hits.size() &&
                   hits.first[interpolated + 1] - hits.first[sample] <= kHitsAtOnce)
                ++interpolated;
            layers_.interpolate(samples, hits, sample, interpolated, grids);
        }
        has_hits_[sample] = 1;
        add_layers(of_sample, layers_, hits.first[sample], grids, rule_, sums_[sample]);
        if (!layers_of_.empty())
            see_layers(samples.rays[sample], of_sample, grids, transmissions_[sample], layers_of_[sample]);
        if (!progress_.empty())
            add_aovs(samples.rays[sample], of_sample, grids, *aovs_, progress_[sample],
                     values_.data() + sample * static_cast<size_t>(aovs_->channel_count));
    }
}

}  // namespace trapeze
