/// What shaders and tests may ask of whatever holds the grids: rays that do not come through the lens.
#pragma once

#include <optional>

#include "core/hit_buffer.h"
#include "core/rays.h"

namespace trapeze {

/// Depths, in DepthRange and in hits, are along the direction's largest axis and grow away from the origin:
/// parameter * |that component|.
class RayQuery {
  public:
    virtual ~RayQuery() = default;
    /// The nearest hit within the range, ends included; nothing for rays that hit nothing or have components
    /// that are NaN.
    virtual std::optional<Hit> closest(const SpaceRay& ray, DepthRange range) const = 0;
    /// Whether there is a hit within the range.
    virtual bool any(const SpaceRay& ray, DepthRange range) const = 0;
};

}  // namespace trapeze
