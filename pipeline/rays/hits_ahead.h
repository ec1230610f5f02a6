/// Hits that a ray will come to when it goes on behind the next one: a ray through many layers that asked for
/// one after the other would go through the tree from its root for each.
#pragma once

#include <optional>
#include <vector>

#include "core/scene/ray_ahead.h"
#include "pipeline/rays/placed_ray.h"
#include "pipeline/rays/ray_grids.h"

namespace trapeze {

/// Of the grids that the ray has gone through last.
class HitsAhead final : public RayAhead {
  public:
    /// What grids.closest(asked) says, of what has been found before or after looking for some more.
    std::optional<RayGridHit> closest(const RayGrids& grids, const void* place, const RangedRay& asked);

  private:
    bool is_of(const RayGrids& grids, const void* place, const RangedRay& asked) const;

    const RayGrids* grids_ = nullptr;
    const void* place_ = nullptr;
    RangedRay asked_;  ///< for these hits
    NearestGridHits found_;
};

}  // namespace trapeze
