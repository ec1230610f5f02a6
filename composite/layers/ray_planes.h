/// Rays of samples in planes of numbers, for lanes of neighbours.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/rays.h"

namespace trapeze {

/// Planes are made when they are asked for: constant micropolygons want none. Used again and again, it keeps
/// its memory.
class RayPlanes {
  public:
    /// What AxisRay has but for its time.
    enum Plane : size_t { kOx, kOy, kOz, kUx, kUy, kPlanes };

    /// The rays stay where they are until the next call.
    void begin(std::span<const AxisRay> rays) { rays_ = rays, are_made_ = false; }
    const AxisRay& operator[](size_t ray) const { return rays_[ray]; }

    /// By Plane; a number for each ray.
    const std::array<const float*, kPlanes>& planes() {
        if (!are_made_) make();
        return planes_;
    }

  private:
    void make() {
        numbers_.resize(std::max(numbers_.size(), kPlanes * rays_.size()));
        float* to[kPlanes];
        for (size_t k = 0; k < kPlanes; ++k) planes_[k] = to[k] = numbers_.data() + k * rays_.size();
        for (size_t i = 0; i < rays_.size(); ++i) {
            const AxisRay& ray = rays_[i];
            to[kOx][i] = ray.ox, to[kOy][i] = ray.oy, to[kOz][i] = ray.oz;
            to[kUx][i] = ray.ux, to[kUy][i] = ray.uy;
        }
        are_made_ = true;
    }

    std::span<const AxisRay> rays_;
    bool are_made_ = false;
    std::vector<float> numbers_;
    std::array<const float*, kPlanes> planes_{};
};

}  // namespace trapeze
