/// What a pixel records of its own samples alone: a depth, and the primitive at its centre.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "composite/image.h"
#include "core/math.h"
#include "core/scene/depth_filter.h"

namespace trapeze {

/// The least or greatest of depths, by `better`; several at a time.
template <class Better>
float best_depth(std::span<const float> depths, float start, const Better& better) {
    constexpr size_t kLanes = 16;
    float best[kLanes];
    std::fill_n(best, kLanes, start);
    const auto take = [&](float depth, float& lane) { lane = better(depth, lane) ? depth : lane; };
    size_t s = 0;
    for (; s + kLanes <= depths.size(); s += kLanes)
        for (size_t i = 0; i < kLanes; ++i) take(depths[s + i], best[i]);
    for (; s < depths.size(); ++s) take(depths[s], best[0]);
    for (size_t i = 1; i < kLanes; ++i) take(best[i], best[0]);
    return best[0];
}

/// A pixel's depth, of those of its samples in their order. Samples that see nothing (infinite depth) do not
/// count; infinite when none sees anything. The depths of "midpoint" are already halfway ones, of which the
/// least is kept.
inline float pixel_depth(DepthFilter filter, std::span<const float> depths) {
    if (filter == DepthFilter::Min || filter == DepthFilter::Midpoint)
        return best_depth(depths, kInfinity, [](float a, float b) { return a < b; });
    if (filter == DepthFilter::Max) {
        const float most =
            best_depth(depths, -kInfinity, [](float a, float b) { return a > b && a < kInfinity; });
        return most > -kInfinity ? most : kInfinity;
    }
    float sum = 0;
    int count = 0;
    for (const float depth : depths)
        if (depth < kInfinity) sum += depth, ++count;
    return count > 0 ? sum / static_cast<float>(count) : kInfinity;
}

/// Keeps the primitive that the sample nearest a pixel's centre sees; of equally near samples the first.
class CentrePrimitive {
  public:
    CentrePrimitive(int px, int py) : x_(static_cast<float>(px) + 0.5f), y_(static_cast<float>(py) + 0.5f) {}

    void add(float x, float y, uint32_t primitive) {
        const float dx = x - x_, dy = y - y_, distance = dx * dx + dy * dy;
        if (distance < nearest_) nearest_ = distance, primitive_ = primitive;
    }
    uint32_t value() const { return primitive_; }

  private:
    float x_, y_;
    float nearest_ = kInfinity;
    uint32_t primitive_ = kNoPrimitive;
};

}  // namespace trapeze
