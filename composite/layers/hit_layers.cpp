#include "composite/layers/hit_layers.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace trapeze {

namespace {

/// From the first corner on, so that what is the same at all of them is that to the last bit, whatever the
/// rounding of the weights.
V3f blend_corners(const QuadWeights& weights, const V3f (&corners)[4]) {
    V3f sum = corners[0];
    for (int k = 1; k < 4; ++k) sum += weights.w[k] * (corners[k] - corners[0]);
    return sum;
}

}  // namespace

Layer layer_at(const AxisRay& ray, const Grid& grid, const MicropolygonId& id) {
    if (!grid.smooth) return {grid.color(id.u, id.v), grid.opacity(id.u, id.v)};
    const QuadWeights weights = hit_weights(ray, grid.quad(id.u, id.v, ray.time));
    const auto blended = [&](const auto& at_corner) {
        V3f corners[4];
        for (int k = 0; k < 4; ++k) corners[k] = at_corner(id.u + (k & 1), id.v + (k >> 1));
        return blend_corners(weights, corners);
    };
    return {blended([&](int i, int j) { return grid.color(i, j); }),
            grid.opaque ? V3f(1) : blended([&](int i, int j) { return grid.opacity(i, j); })};
}

/// Places for the hits of samples: sample s has hits[first_hits[s]] up to hits[first_hits[s + 1]]. Of many
/// layers hits are read here first, and fetched ahead.
void HitLayers::order_by_layer(const Hit* hits, std::span<const uint32_t> first_hits) {
    const size_t samples = first_hits.size() - 1, count = first_hits[samples] - first_hits[0];
    constexpr uint32_t kHitsPerLine = 64 / sizeof(Hit), kAhead = 64;
    const uint32_t last = first_hits[samples];
    id_at_.resize(count), place_of_.resize(count), sample_at_.resize(count);
    next_of_.assign(1, 0);
    for (size_t s = 0; s < samples; ++s) {
        const size_t layers = first_hits[s + 1] - first_hits[s];
        if (layers >= next_of_.size()) next_of_.resize(layers + 1);
        ++next_of_[layers];
    }
    // From how many samples have so many layers to how many have more, and where these then begin.
    uint32_t have_more = 0;
    for (size_t layer = next_of_.size(); layer-- > 0;) have_more += std::exchange(next_of_[layer], have_more);
    uint32_t begin = 0;
    for (uint32_t& places : next_of_) begin += std::exchange(places, begin);
    for (uint32_t s = 0, hit = first_hits[0], n = 0; s < samples; ++s)
        for (size_t layer = 0; hit < first_hits[s + 1]; ++hit, ++layer, ++n) {
            if (hit % kHitsPerLine == 0) __builtin_prefetch(hits + std::min(hit + kAhead, last));
            const uint32_t place = next_of_[layer]++;
            id_at_[place] = hits[hit].id, sample_at_[place] = s, place_of_[n] = place;
        }
}

void HitLayers::interpolate(const SampleTile& samples, const HitBuffer& hits, size_t begin, size_t end,
                            const Grids& grids) {
    first_ = hits.first[begin];
    const size_t count = hits.first[end] - first_;
    float* planes[kLayerPlanes];
    for (size_t k = 0; k < kLayerPlanes; ++k) {
        planes_[k].resize(std::max(planes_[k].size(), count + kLayerPadding));
        planes[k] = planes_[k].data();
    }
    // Mostly each sample has one hit. Both loops are then ones that compilers make vectors of.
    one_each_ = true;
    for (size_t sample = begin; sample < end; ++sample)
        one_each_ &= hits.first[sample + 1] == hits.first[sample] + 1;
    if (one_each_) {
        sample_at_.resize(count);
        std::iota(sample_at_.begin(), sample_at_.end(), 0u);
    } else {
        order_by_layer(hits.hits.data(), {hits.first.data() + begin, end - begin + 1});
    }
    rays_.begin({samples.rays.data() + begin, end - begin});
    kinds_ = interpolate_hits({hits.hits.data() + first_, one_each_ ? nullptr : id_at_.data(),
                               sample_at_.data(), count, rays_, grids, planes},
                              corners_);
    kinds_.all_cover &= one_each_;
}

}  // namespace trapeze
