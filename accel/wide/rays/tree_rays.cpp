// What a WideTree says to rays in any direction.
#include "accel/wide/rays/single_ray.h"
#include "accel/wide/wide_tree.h"

namespace trapeze {

std::optional<Hit> WideTree::closest(const SpaceRay& ray, DepthRange range) const {
    return closest_hit(*this, ray, range);
}

std::optional<Hit> WideTree::closest_from(const SpaceRay& ray, DepthRange range, const Hit& from) const {
    return closest_hit_from(*this, ray, range, from);
}

void WideTree::nearest(const SpaceRay& ray, DepthRange range, NearestHits& hits) const {
    nearest_hits(*this, ray, range, hits);
}

bool WideTree::any(const SpaceRay& ray, DepthRange range) const {
    return any_hit(*this, ray, range);
}

void WideTree::in_the_way(std::span<const RangedRay> rays, std::span<InTheWay> met) const {
    opaque_hits(*this, rays, met);
}

InTheWay WideTree::in_the_way(const SpaceRay& ray, DepthRange range, DepthRange sure) const {
    return opaque_hit(*this, ray, range, sure);
}

}  // namespace trapeze
