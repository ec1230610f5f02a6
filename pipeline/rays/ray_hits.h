/// What it means that a ray meets a micropolygon: whether it counts, and what shading is to know of it.
#pragma once

#include <optional>
#include <tuple>

#include "core/scene/level_of_detail.h"
#include "core/scene/ray_scene.h"
#include "pipeline/rays/placed_ray.h"
#include "pipeline/rays/ray_dicer.h"
#include "pipeline/rays/ray_grids.h"

namespace trapeze {

/// The nearer hit; of equally near ones that of the primitive that comes first.
inline bool is_in_front(const RaySurfaceHit& hit, const std::optional<RaySurfaceHit>& nearest) {
    return !nearest ||
           std::tuple(hit.distance, hit.primitive) < std::tuple(nearest->distance, nearest->primitive);
}

/// What no hit that is as near as `distance` is said to lie behind: depths round, and in another space they
/// round differently.
inline float beyond(float distance) {
    return distance * (1 + 0x1p-20f);
}

/// Of a level of the geometry.
class RayHits {
  public:
    RayHits(const RayDicer& dicer, uint8_t level);

    /// Whether a hit counts: not where it may be the surface that the ray leaves or ends on, nor where the
    /// ray wants other groups or sides.
    bool counts(const RaySegment& ray, const PlacedRay& placed, const RayGridHit& found) const;
    RaySurfaceHit hit_of(const RaySegment& ray, const PlacedRay& placed, const RayGridHit& found) const;

  private:
    uint32_t primitive(const PlacedRay& placed, const Grid& grid) const;
    bool from_outside(const PlacedRay& placed, const V3f& direction, const RayGridHit& found) const;
    RayFacet facet(const RaySegment& ray, const PlacedRay& placed, const RayGridHit& found) const;
    bool shows(const RaySegment& ray, const PlacedRay& placed, const RayGridHit& found) const;
    bool is_left(const RaySegment& ray, const PlacedRay& placed, const RayGridHit& found) const;
    bool is_reached(const RaySegment& ray, const PlacedRay& placed, const RayGridHit& found) const;
    bool is_displaced(const PlacedRay& placed, const RayGridHit& found) const;

    const RayDicer& dicer_;
    const uint8_t level_;
    std::vector<SeenNumbers> seen_;  ///< by primitive; empty: all rays see all of them
};

}  // namespace trapeze
