#include "composite/layers/hit_layers.h"

#include <algorithm>
#include <numeric>

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

void HitLayers::interpolate(const SampleTile& samples, const HitBuffer& hits, size_t begin, size_t end,
                            const Grids& grids) {
    first_ = hits.first[begin];
    const size_t count = hits.first[end] - first_;
    float* planes[kLayerPlanes];
    for (size_t k = 0; k < kLayerPlanes; ++k) {
        planes_[k].resize(std::max(planes_[k].size(), count));
        planes[k] = planes_[k].data();
    }
    // Mostly each sample has one hit. Both loops are then ones that compilers make vectors of.
    bool one_each = true;
    for (size_t sample = begin; sample < end; ++sample)
        one_each &= hits.first[sample + 1] == hits.first[sample] + 1;
    sample_of_.resize(std::max(sample_of_.size(), count));
    if (one_each)
        std::iota(sample_of_.begin(), sample_of_.begin() + static_cast<std::ptrdiff_t>(count),
                  static_cast<uint32_t>(begin));
    else
        for (size_t sample = begin; sample < end; ++sample)
            std::fill(sample_of_.begin() + (hits.first[sample] - first_),
                      sample_of_.begin() + (hits.first[sample + 1] - first_), static_cast<uint32_t>(sample));
    kinds_ = interpolate_hits(
        {{hits.hits.data() + first_, count}, sample_of_.data(), samples.rays.data(), grids, planes},
        corners_);
    kinds_.all_cover &= one_each;
}

}  // namespace trapeze
