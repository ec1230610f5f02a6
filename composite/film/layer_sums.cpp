#include "composite/film/layer_sums.h"

namespace trapeze {

LayerSums::LayerSums(const LayerRules& rules)
    : rules_(rules), weights_(rules.kernel ? static_cast<size_t>(rules.kernel->tap_count()) : 0) {}

void LayerSums::begin(int px, int py) {
    px_ = px, py_ = py;
    deep_.begin();
}

void LayerSums::add(std::span<const SeenLayer> layers, float x, float y, float share, MatteSums* mattes) {
    if (rules_.deep_tolerance) deep_.add(layers);
    if (!rules_.keys || !mattes) return;
    coverages_.clear();
    for (const SeenLayer& layer : layers)
        coverages_.push_back({rules_.keys->key_of(layer.primitive), layer.rgba[3]});
    const FilterTaps taps = rules_.kernel->weigh(x, y, px_, py_, weights_.data());
    mattes->add(taps, *rules_.kernel, weights_.data(), share, coverages_);
}

std::vector<DeepSample> LayerSums::deep_samples() {
    return rules_.deep_tolerance ? deep_.samples(*rules_.deep_tolerance) : std::vector<DeepSample>();
}

}  // namespace trapeze
