#include "sample/raytrace/ray_order.h"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>

namespace trapeze {
namespace {

constexpr int kBits = 4;
constexpr uint32_t kLevels = 1 << kBits;

uint32_t even_bits(uint32_t code) {
    uint32_t value = 0;
    for (int bit = 0; bit < 16; ++bit) value |= (code >> (2 * bit) & 1) << bit;
    return value;
}

/// Samples pixel by pixel along the Z-order curve over the tile's rectangle, of whatever size; those of a
/// list as it has them.
void z_order(const SampleTile& samples, std::vector<uint32_t>& order) {
    if (samples.is_list()) {
        order.resize(samples.size());
        std::iota(order.begin(), order.end(), 0u);
        return;
    }
    const int width = samples.pixels.width(), height = samples.pixels.height();
    order.clear();
    order.reserve(samples.size());
    const uint32_t side = std::bit_ceil(static_cast<uint32_t>(std::max({width, height, 1})));
    for (uint64_t code = 0; code < uint64_t{side} * side; ++code) {
        const auto x = static_cast<int>(even_bits(static_cast<uint32_t>(code)));
        const auto y = static_cast<int>(even_bits(static_cast<uint32_t>(code >> 1)));
        if (x >= width || y >= height) continue;
        const auto first =
            static_cast<uint32_t>(samples.first_of_pixel(samples.pixels.x0 + x, samples.pixels.y0 + y));
        for (int i = 0; i < samples.samples_per_pixel; ++i) order.push_back(first + static_cast<uint32_t>(i));
    }
}

/// Quantises a value across the range that a tile's samples take.
struct Quantiser {
    float from = 0, scale = 0;

    template <class Value>
    Quantiser(const SampleTile& samples, Value&& value) {
        float low = value(samples.rays[0]), high = low;
        for (const AxisRay& ray : samples.rays)
            low = std::min(low, value(ray)), high = std::max(high, value(ray));
        from = low, scale = high > low ? static_cast<float>(kLevels) / (high - low) : 0.0f;
    }
    uint32_t operator()(float value) const {
        const float at = (value - from) * scale;
        return at > 0 ? std::min(static_cast<uint32_t>(at), kLevels - 1) : 0u;
    }
};

/// Stable counting sort of result.order by result.keys (by sample).
void sort_by_keys(RayOrder& result) {
    std::array<uint32_t, (1 << 3 * kBits) + 1> start{};
    for (const uint32_t key : result.keys) ++start[key + 1];
    for (size_t i = 1; i < start.size(); ++i) start[i] += start[i - 1];
    result.sorted.resize(result.order.size());
    for (const uint32_t sample : result.order) result.sorted[start[result.keys[sample]]++] = sample;
    result.order.swap(result.sorted);
}

}  // namespace

void order_rays(const SampleTile& samples, RayBlur blur, RayOrder& result) {
    z_order(samples, result.order);
    if ((!blur.motion && !blur.lens) || samples.size() == 0) return;
    // The stable sorts one after another are one by the joined key, the last sort's most significant.
    result.keys.assign(samples.size(), 0);
    if (blur.motion)
        for (size_t i = 0; i < samples.size(); ++i)
            result.keys[i] = std::min(static_cast<uint32_t>(samples.time[i] * kLevels), kLevels - 1);
    if (blur.lens) {
        const Quantiser x(samples, [](const AxisRay& ray) { return ray.ux; });
        const Quantiser y(samples, [](const AxisRay& ray) { return ray.uy; });
        for (size_t i = 0; i < samples.size(); ++i) {
            const AxisRay& ray = samples.rays[i];
            result.keys[i] |= (y(ray.uy) << kBits | x(ray.ux)) << kBits;
        }
    }
    sort_by_keys(result);
}

}  // namespace trapeze
