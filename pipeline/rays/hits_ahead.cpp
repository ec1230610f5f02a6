#include "pipeline/rays/hits_ahead.h"

#include <algorithm>

namespace trapeze {
namespace {

/// In front of all hits that count.
Hit first_of(const RangedRay& ray) {
    const Hit nearest{ray.range.min, 0};
    return in_front(ray.from, nearest) ? nearest : ray.from;
}

}  // namespace

/// Whether all hits that are asked for, as far as any are known, are among those that have been found.
bool HitsAhead::is_of(const RayGrids& grids, const void* place, const RangedRay& asked) const {
    const SpaceRay &known = asked_.ray, &ray = asked.ray;
    return grids_ == &grids && place_ == place && known.origin == ray.origin &&
           known.direction == ray.direction && known.time == ray.time &&
           !in_front(first_of(asked), first_of(asked_)) &&
           (found_.is_cut || asked.range.max <= asked_.range.max);
}

std::optional<RayGridHit> HitsAhead::closest(const RayGrids& grids, const void* place,
                                             const RangedRay& asked) {
    const auto next = [&]() -> const RayGridHit* {
        const Hit first = first_of(asked);
        const auto at = std::ranges::find_if(
            found_.hits, [&](const RayGridHit& hit) { return !in_front(hit.hit, first); });
        return at == found_.hits.end() ? nullptr : &*at;
    };
    const RayGridHit* hit = is_of(grids, place, asked) ? next() : nullptr;
    const bool knows_none = !hit && is_of(grids, place, asked) && !found_.is_cut;
    if (!hit && !knows_none) {
        grids_ = &grids, place_ = place, asked_ = asked;
        found_ = grids.nearest(asked);
        hit = next();
    }
    if (!hit || !(hit->hit.depth <= asked.range.max)) return {};
    return *hit;
}

}  // namespace trapeze
