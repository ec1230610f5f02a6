#include "composite/film/pixel_summer.h"

#include <algorithm>

#include "composite/film/pixel_depth.h"

namespace trapeze {

PixelSummer::PixelSummer(const FilterKernel& kernel, const FilmRules& rules, size_t count, float share)
    : kernel_(kernel),
      rules_(rules),
      count_(count),
      channels_(static_cast<size_t>(rules.aovs->channel_count)),
      share_(share),
      pixel_(kernel, count, 4 + channels_),
      variables_(channels_, count),
      values_(channels_),
      all_summed_(rules.aovs->all_summed()),
      kept_(*rules.aovs),
      layers_(rules.layers) {}

PixelRecord PixelSummer::add(int px, int py, const float* x, const float* y, const PixelSamples& samples,
                             TileSums& sums) {
    planes_.clear();
    if (samples.sees_something()) {
        for (size_t c = 0; c < 4; ++c) planes_.push_back(samples.colors()[c]);
        for (size_t c = 0; c < channels_; ++c) planes_.push_back(variables_[c]);
    }
    if (channels_ > 0) take_variables(samples);
    pixel_.sum(x, y, px, py, planes_);
    sums.add(px - kernel_.reach_x(), py - kernel_.reach_y(), pixel_, samples.sees_something(), share_);
    if (rules_.layers.want_layers()) add_layers(px, py, x, y, samples, sums);

    const float depth =
        samples.sees_something() ? pixel_depth(rules_.depth_filter, samples.depths()) : kInfinity;
    CentrePrimitive primitive(px, py);
    if (rules_.wants_primitives)
        for (size_t s = 0; s < count_; ++s) primitive.add(x[s], y[s], samples.primitive(s));
    return {depth, primitive.value(), all_summed_ ? nullptr : &kept_,
            rules_.layers.want_layers() ? &layers_ : nullptr};
}

/// Puts the variables that are summed into planes, keeps the others.
void PixelSummer::take_variables(const PixelSamples& samples) {
    kept_.begin();
    for (size_t s = 0; s < count_; ++s) {
        const bool has_hits = samples.has_hits(s);
        if (has_hits) {
            std::copy_n(samples.variables(s), channels_, values_.data());
            if (!all_summed_) kept_.take(values_.data(), samples.variables_depth(s));
        }
        for (size_t c = 0; c < channels_; ++c) variables_[c][s] = has_hits ? values_[c] : 0;
    }
}

/// Adds what the layers of samples make: mattes and deep pixels.
void PixelSummer::add_layers(int px, int py, const float* x, const float* y, const PixelSamples& samples,
                             TileSums& sums) {
    layers_.begin(px, py);
    for (size_t s = 0; s < count_; ++s)
        layers_.add(samples.layers(s), x[s], y[s], share_, sums.mattes ? &*sums.mattes : nullptr);
}

}  // namespace trapeze
