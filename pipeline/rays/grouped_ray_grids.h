/// Grids that rays meet, by the kinds of rays that see them: no ray meets what it must not see.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>

#include "core/scene/ray_scene.h"
#include "pipeline/rays/placed_ray.h"
#include "pipeline/rays/ray_bricks.h"
#include "pipeline/rays/ray_grids.h"
#include "pipeline/rays/ray_hits.h"

namespace trapeze {

/// Of one space: camera space, or that of a shared object, in which each ray comes as its PlacedRay.
class GroupedRayGrids {
  public:
    /// Sets of kinds of rays, a bit for each.
    static constexpr unsigned kMasks = 8;
    static unsigned mask_of(const RayAttributes& rays);

    void set(unsigned mask, std::unique_ptr<RayGrids> grids) { groups_[mask] = {std::move(grids), nullptr}; }
    void set(unsigned mask, std::unique_ptr<RayBricks> bricks);

    bool has(RayKind kind) const;
    /// Whether some are made as rays come by.
    bool makes_bricks() const;
    size_t bytes() const;
    /// By bricks.
    uint64_t micropolygons_made() const;

    /// The nearest hit that counts.
    std::optional<RaySurfaceHit> closest(const RayHits& hits, const RaySegment& ray, const PlacedRay& placed,
                                         RayKind kind) const;
    /// Of many rays, and the same one in several places: bricks are made once for all. placed[i] and found[i]
    /// are those of rays[i].
    void closest(const RayHits& hits, std::span<const RaySegment> rays, std::span<const PlacedRay> placed,
                 RayKind kind, std::span<std::optional<RaySurfaceHit>> found) const;
    /// What is in the way: Opaque only where it counts for the ray, whatever it is.
    void in_the_way(std::span<const RaySegment> rays, std::span<const PlacedRay> placed, RayKind kind,
                    std::span<InTheWay> met) const;

  private:
    struct Group {
        std::unique_ptr<RayGrids> grids;    ///< null: none
        const RayBricks* bricks = nullptr;  ///< `grids`, where they are made as rays come by
    };

    std::array<Group, kMasks> groups_;
};

}  // namespace trapeze
