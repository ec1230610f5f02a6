/// The grids that some kinds of rays meet, wherever they are kept.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "accel/hit_policies.h"
#include "accel/wide/wide_tree.h"
#include "core/grid.h"
#include "core/hit_buffer.h"
#include "core/rays.h"

namespace trapeze {

/// Where a ray meets a grid.
struct RayGridHit {
    Hit hit;  ///< its id's grid is the subpatch: Grid::ordinal
    const Grid* grid = nullptr;
    std::shared_ptr<const void> keeps;  ///< the grid is there as long as this
};

/// The nearest hits of a ray in their order: some, of which there may be more behind the last where it is
/// cut, or all.
struct NearestGridHits {
    std::vector<RayGridHit> hits;
    bool is_cut = false;
};

/// Finds what testing all grids finds, bit for bit; equal depths are settled by subpatch. Immutable for those
/// who ask: threads share it.
class RayGrids {
  public:
    virtual ~RayGrids() = default;
    /// As WideTree::closest_from(); the grid of RangedRay::from is a subpatch.
    virtual std::optional<RayGridHit> closest(const RangedRay& ray) const = 0;
    /// What closest() finds first, and perhaps some of what it would find behind.
    virtual NearestGridHits nearest(const RangedRay& ray) const {
        NearestGridHits found;
        if (const std::optional<RayGridHit> hit = closest(ray))
            found.hits.push_back(*hit), found.is_cut = true;
        return found;
    }
    /// As WideTree's, of many rays.
    virtual void in_the_way(std::span<const RangedRay> rays, std::span<InTheWay> met) const = 0;
    /// Memory that is held now.
    virtual size_t bytes() const = 0;
};

}  // namespace trapeze
