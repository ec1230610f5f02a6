/// Which thing's inside a place along a ray is in, where no surface that the ray has left says so: what is
/// farther on the way tells.
#pragma once

#include <map>
#include <vector>

#include "core/scene/ray_scene.h"
#include "shade/rays/volume_table.h"

namespace trapeze {

/// What is left of a ray behind a surface that it has hit: other surfaces in the same place count, and the
/// same one does not.
void go_behind(const RayScene& scene, const RaySurfaceHit& hit, RaySegment& ray);

/// Many places at once. A ray that leaves a thing with a shader of its inside has been in there, unless it
/// has gone in behind the place.
class InsideSearch {
  public:
    InsideSearch(const RayScene& scene, const VolumeTable& volumes, RayKind kind)
        : scene_(scene), volumes_(volumes), kind_(kind) {}

    /// A place at the distance `from` of a ray; `found` becomes the inside that it is in, or stays. What the
    /// ray wants to meet of sides does not count.
    void add(const RaySegment& ray, float from, RayMedium& found);
    /// A place before something that the ray has hit.
    void add_before(const RaySegment& ray, const RaySurfaceHit& hit, RayMedium& found);
    void run();

  private:
    struct Looking {
        RaySegment ray;
        RayMedium* found;
        int within = 0;  ///< how many things that are behind the place
    };
    bool goes_on(Looking& one, const RaySurfaceHit& hit) const;

    const RayScene& scene_;
    const VolumeTable& volumes_;
    const RayKind kind_;
    std::map<const RayFilter*, RayFilter> filters_;  ///< by the rays' own
    std::vector<Looking> looking_;
};

}  // namespace trapeze
