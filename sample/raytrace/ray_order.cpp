#include "sample/raytrace/ray_order.h"

#include <algorithm>
#include <array>

#include "sample/raytrace/pixel_order.h"

namespace trapeze {
namespace {

constexpr int kBits = 4;
constexpr uint32_t kLevels = 1 << kBits;

/// Samples pixel by pixel, a pixel's one after another.
void z_order(const SampleTile& samples, std::vector<uint32_t>& order) {
    order.clear();
    order.reserve(samples.size());
    for_each_first_sample(samples, [&](uint32_t first) {
        for (int i = 0; i < samples.samples_per_pixel; ++i) order.push_back(first + static_cast<uint32_t>(i));
    });
}

/// Quantises a value across the range that a tile's samples take. Ranges are the tile's own, so that 4 bits
/// tell its rays apart however narrow the view is.
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

/// Stable counting sort of result.order by result.keys (by sample). Linear in the rays, as keys are small
/// numbers.
void sort_by_keys(RayOrder& result) {
    std::array<uint32_t, (1 << 3 * kBits) + 1> start{};
    for (const uint32_t key : result.keys) ++start[key + 1];
    for (size_t i = 1; i < start.size(); ++i) start[i] += start[i - 1];
    result.sorted.resize(result.order.size());
    for (const uint32_t sample : result.order) result.sorted[start[result.keys[sample]]++] = sample;
    result.order.swap(result.sorted);
}

}  // namespace

/// Keys hold time in the low bits and the direction above: direction is the more significant, as it is sorted
/// by last.
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
