/// What a pixel records of its own samples alone: a depth, and the primitive at its centre.
#pragma once

#include <algorithm>
#include <cstdint>

#include "composite/image.h"
#include "core/math.h"
#include "core/scene/depth_filter.h"

namespace trapeze {

/// Combines the depths of a pixel's samples, which come in their order; infinite when none sees anything.
class PixelDepth {
  public:
    explicit PixelDepth(DepthFilter filter) : filter_(filter) {}

    /// A sample that sees nothing (infinite depth) does not count. The depths of "midpoint" are already
    /// halfway ones, of which the least is kept.
    void add(float depth) {
        if (depth >= kInfinity) return;
        if (count_ == 0)
            value_ = depth;
        else if (filter_ == DepthFilter::Min || filter_ == DepthFilter::Midpoint)
            value_ = std::min(value_, depth);
        else if (filter_ == DepthFilter::Max)
            value_ = std::max(value_, depth);
        else
            value_ += depth;
        ++count_;
    }
    float value() const {
        if (count_ == 0) return kInfinity;
        return filter_ == DepthFilter::Average ? value_ / static_cast<float>(count_) : value_;
    }

  private:
    DepthFilter filter_;
    float value_ = 0;
    int count_ = 0;
};

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
