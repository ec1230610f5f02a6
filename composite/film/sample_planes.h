/// Numbers of a pixel's samples, plane by plane, as sums in vectors read them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace trapeze {

/// Planes of as many floats as a pixel has samples, each with zeros up to a whole group. All begin cache
/// lines where groups are vectors.
class SamplePlanes {
  public:
    /// So many samples are added side by side; with fewer than half of them in a pixel they are added one by
    /// one, as is faster.
    static constexpr size_t kVectorGroup = 16;
    static size_t group_of(size_t samples) { return samples < kVectorGroup / 2 ? 1 : kVectorGroup; }

    SamplePlanes(size_t planes, size_t samples)
        : stride_((samples + group_of(samples) - 1) / group_of(samples) * group_of(samples)),
          values_(planes * stride_ + kVectorGroup),
          aligned_((64 - reinterpret_cast<uintptr_t>(values_.data()) % 64) % 64 / sizeof(float)) {}
    SamplePlanes(const SamplePlanes&) = delete;  // the copy would lie elsewhere

    /// Floats from plane to plane.
    size_t stride() const { return stride_; }
    float* operator[](size_t plane) { return values_.data() + aligned_ + plane * stride_; }
    const float* operator[](size_t plane) const { return values_.data() + aligned_ + plane * stride_; }

  private:
    size_t stride_;
    std::vector<float> values_;
    size_t aligned_;  ///< where in values_ the first plane begins
};

}  // namespace trapeze
