#include "composite/film/deep_pixel.h"

#include <algorithm>

namespace trapeze {
namespace {

/// Layers behind which less than this is let through are not seen.
constexpr float kHidden = 1e-6f;

/// Samples of a surface that become one: sums of what they add, and of depths by alpha.
class Merged {
  public:
    explicit Merged(const SeenLayer& first) : first_(first) {}

    bool takes(const SeenLayer& layer, float tolerance) const {
        return layer.primitive == first_.primitive &&
               layer.depth - first_.depth <= tolerance * std::max(first_.depth, 0.0f);
    }
    void add(const SeenLayer& layer) {
        for (int c = 0; c < 4; ++c) rgba_[c] += layer.rgba[c];
        depths_ += layer.depth, alpha_depths_ += layer.depth * layer.rgba[3], ++count_;
    }
    /// `share`: of a sample in its pixel; `before`: the alpha of what is in front.
    DeepSample result(float share, float before) const {
        DeepSample sample;
        const float let_through = 1 - before;
        for (int c = 0; c < 4; ++c) sample.rgba[c] = rgba_[c] * share / let_through;
        sample.rgba[3] = std::min(sample.rgba[3], 1.0f);
        sample.depth = rgba_[3] > 0 ? alpha_depths_ / rgba_[3] : depths_ / static_cast<float>(count_);
        return sample;
    }
    float alpha() const { return rgba_[3]; }

  private:
    SeenLayer first_;
    float rgba_[4] = {0, 0, 0, 0};
    float depths_ = 0, alpha_depths_ = 0;
    size_t count_ = 0;
};

}  // namespace

void DeepPixel::begin() {
    count_ = 0;
    layers_.clear();
}

void DeepPixel::add(std::span<const SeenLayer> layers) {
    ++count_;
    layers_.insert(layers_.end(), layers.begin(), layers.end());
}

std::vector<DeepSample> DeepPixel::samples(float tolerance) {
    std::ranges::stable_sort(layers_, [](const SeenLayer& a, const SeenLayer& b) {
        return a.depth != b.depth ? a.depth < b.depth : a.primitive < b.primitive;
    });
    const float share = 1 / static_cast<float>(std::max<size_t>(count_, 1));
    std::vector<DeepSample> samples;
    float alpha = 0;
    for (size_t i = 0; i < layers_.size() && 1 - alpha > kHidden;) {
        Merged merged(layers_[i]);
        for (; i < layers_.size() && merged.takes(layers_[i], tolerance); ++i) merged.add(layers_[i]);
        samples.push_back(merged.result(share, alpha));
        alpha += merged.alpha() * share;
    }
    return samples;
}

}  // namespace trapeze
