/// What it means that a ray meets a micropolygon: whether it counts, and what shading is to know of it.
#pragma once

#include "core/scene/ray_scene.h"
#include "pipeline/rays/placed_ray.h"
#include "pipeline/rays/ray_dicer.h"
#include "pipeline/rays/ray_grids.h"

namespace trapeze {

/// Of a level of the geometry.
class RayHits {
  public:
    RayHits(const RayDicer& dicer, uint8_t level) : dicer_(dicer), level_(level) {}

    /// Whether a hit counts: not where it may be the surface that the ray leaves, nor where the ray wants
    /// other groups or sides.
    bool counts(const RaySegment& ray, const PlacedRay& placed, const RayGridHit& found) const;
    RaySurfaceHit hit_of(const RaySegment& ray, const PlacedRay& placed, const RayGridHit& found) const;

  private:
    uint32_t primitive(const PlacedRay& placed, const Grid& grid) const;
    bool from_outside(const PlacedRay& placed, const V3f& direction, const RayGridHit& found) const;
    bool shows(const RaySegment& ray, const PlacedRay& placed, const RayGridHit& found) const;

    const RayDicer& dicer_;
    const uint8_t level_;
};

}  // namespace trapeze
