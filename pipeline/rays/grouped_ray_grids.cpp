#include "pipeline/rays/grouped_ray_grids.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include "pipeline/rays/hits_ahead.h"

namespace trapeze {
namespace {

bool sees(RayKind kind, unsigned mask) {
    return (mask >> static_cast<unsigned>(kind) & 1) != 0;
}

/// The ray as it asks grids for hits: behind the last one that it has gone through, where that is of theirs.
RangedRay asking(const RayGrids& grids, const RaySegment& ray, const PlacedRay& placed) {
    RangedRay asked = placed.ranged(ray);
    const RayHitPlace& last = ray.passed.last();
    if (last.grids == &grids && last.instance == placed.place && last.depth >= asked.range.min)
        asked.pass({last.depth, last.id});
    return asked;
}

RaySurfaceHit hit_of(const RayGrids& grids, const RayHits& hits, const RaySegment& ray,
                     const PlacedRay& placed, const RayGridHit& found) {
    RaySurfaceHit hit = hits.hit_of(ray, placed, found);
    hit.place.grids = &grids;
    return hit;
}

std::optional<RaySurfaceHit> closest_in(const RayGrids& grids, const RayHits& hits, const RaySegment& ray,
                                        const PlacedRay& placed) {
    RangedRay asked = asking(grids, ray, placed);
    const RayHitPlace& last = ray.passed.last();
    const bool looks_ahead = ray.ahead && last.grids == &grids && last.instance == placed.place;
    const auto closest = [&] {
        return looks_ahead ? static_cast<HitsAhead*>(ray.ahead)->closest(grids, placed.place, asked)
                           : grids.closest(asked);
    };
    while (const std::optional<RayGridHit> found = closest()) {
        if (hits.counts(ray, placed, *found)) return hit_of(grids, hits, ray, placed, *found);
        asked.pass(found->hit);
    }
    return {};
}

/// Rays whose nearest hit does not count go on behind it, all together.
void closest_in(const RayBricks& bricks, const RayHits& hits, std::span<const RaySegment> rays,
                std::span<const PlacedRay> placed, std::span<std::optional<RaySurfaceHit>> found) {
    std::vector<RangedRay> asked;
    for (size_t i = 0; i < rays.size(); ++i) asked.push_back(asking(bricks, rays[i], placed[i]));
    std::vector<uint32_t> going(rays.size());  // asked[r] is ray going[r]
    std::iota(going.begin(), going.end(), 0u);
    while (!going.empty()) {
        std::vector<bool> counted(going.size(), true);  // the last hit, if there is one
        std::vector<Hit> passed(going.size());
        bricks.closest(asked, [&](size_t r, const RayGridHit& met) {
            const uint32_t i = going[r];
            counted[r] = hits.counts(rays[i], placed[i], met);
            passed[r] = met.hit;
            if (counted[r])
                found[i] = hit_of(bricks, hits, rays[i], placed[i], met);
            else
                found[i].reset();
        });
        size_t left = 0;
        for (size_t r = 0; r < going.size(); ++r) {
            if (counted[r]) continue;
            going[left] = going[r], asked[left] = asked[r];
            asked[left++].pass(passed[r]);
        }
        going.resize(left), asked.resize(left);
    }
}

/// What does not count for a ray that is choosy is not sure to be in its way.
InTheWay for_ray(const RaySegment& ray, InTheWay met) {
    return met == InTheWay::Opaque && ray.only ? InTheWay::Layers : met;
}

}  // namespace

unsigned GroupedRayGrids::mask_of(const RayAttributes& rays) {
    const auto bit = [](RayKind kind) { return 1u << static_cast<unsigned>(kind); };
    return (rays.diffuse ? bit(RayKind::Diffuse) : 0) | (rays.specular ? bit(RayKind::Specular) : 0) |
           (rays.transmission ? bit(RayKind::Transmission) : 0);
}

void GroupedRayGrids::set(unsigned mask, std::unique_ptr<RayBricks> bricks) {
    const RayBricks* const made = bricks.get();
    groups_[mask] = {std::move(bricks), made};
}

bool GroupedRayGrids::has(RayKind kind) const {
    for (unsigned mask = 0; mask < kMasks; ++mask)
        if (sees(kind, mask) && groups_[mask].grids) return true;
    return false;
}

bool GroupedRayGrids::makes_bricks() const {
    return std::ranges::any_of(groups_, [](const Group& group) { return group.bricks != nullptr; });
}

size_t GroupedRayGrids::bytes() const {
    size_t bytes = 0;
    for (const Group& group : groups_) bytes += group.grids ? group.grids->bytes() : 0;
    return bytes;
}

uint64_t GroupedRayGrids::micropolygons_made() const {
    uint64_t count = 0;
    for (const Group& group : groups_) count += group.bricks ? group.bricks->micropolygons_made() : 0;
    return count;
}

std::optional<RaySurfaceHit> GroupedRayGrids::closest(const RayHits& hits, const RaySegment& ray,
                                                      const PlacedRay& placed, RayKind kind) const {
    std::optional<RaySurfaceHit> nearest;
    RaySegment rest = ray;
    for (unsigned mask = 0; mask < kMasks; ++mask) {
        if (!sees(kind, mask) || !groups_[mask].grids) continue;
        const std::optional<RaySurfaceHit> hit = closest_in(*groups_[mask].grids, hits, rest, placed);
        if (!hit || !is_in_front(*hit, nearest)) continue;
        nearest = hit;
        rest.max = std::min(ray.max, beyond(hit->distance));
    }
    return nearest;
}

void GroupedRayGrids::closest(const RayHits& hits, std::span<const RaySegment> rays,
                              std::span<const PlacedRay> placed, RayKind kind,
                              std::span<std::optional<RaySurfaceHit>> found) const {
    std::ranges::fill(found, std::nullopt);
    std::vector<RaySegment> rest(rays.begin(), rays.end());
    std::vector<std::optional<RaySurfaceHit>> of_group(rays.size());
    for (unsigned mask = 0; mask < kMasks; ++mask) {
        const Group& group = groups_[mask];
        if (!sees(kind, mask) || !group.grids) continue;
        std::ranges::fill(of_group, std::nullopt);
        if (group.bricks) closest_in(*group.bricks, hits, rest, placed, of_group);
        for (size_t i = 0; i < rays.size(); ++i) {
            if (!group.bricks) of_group[i] = closest_in(*group.grids, hits, rest[i], placed[i]);
            if (!of_group[i] || !is_in_front(*of_group[i], found[i])) continue;
            found[i] = of_group[i];
            rest[i].max = std::min(rays[i].max, beyond(of_group[i]->distance));
        }
    }
}

void GroupedRayGrids::in_the_way(std::span<const RaySegment> rays, std::span<const PlacedRay> placed,
                                 RayKind kind, std::span<InTheWay> met) const {
    std::vector<RangedRay> asked;
    std::vector<uint32_t> open;
    std::vector<InTheWay> of_group;
    std::ranges::fill(met, InTheWay::Nothing);
    for (unsigned mask = 0; mask < kMasks; ++mask) {
        const Group& group = groups_[mask];
        if (!sees(kind, mask) || !group.grids) continue;
        asked.clear(), open.clear();
        for (uint32_t i = 0; i < rays.size(); ++i)
            if (met[i] != InTheWay::Opaque) asked.push_back(placed[i].ranged(rays[i])), open.push_back(i);
        of_group.resize(asked.size());
        group.grids->in_the_way(asked, of_group);
        for (size_t r = 0; r < asked.size(); ++r)
            met[open[r]] = std::max(met[open[r]], for_ray(rays[open[r]], of_group[r]));
    }
}

}  // namespace trapeze
