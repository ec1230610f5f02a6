/// Single rays in any direction through a WideTree, as shaders send them: lanes are the children of a node,
/// the boxes of a grid, the micropolygons of a block.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "accel/wide/wide_tree.h"

namespace trapeze {

/// What rays looked at: nodes above grids, grids' boxes (all of a grid at once), blocks of 4 x 4
/// micropolygons, of which those that are there are tested.
struct SingleRayCounts {
    uint64_t nodes = 0, grids = 0, blocks = 0, tests = 0;
};

/// What RayQuery::closest() and any() say. `counts`, unless null, is added to.
std::optional<Hit> closest_hit(const WideTree& tree, const SpaceRay& ray, DepthRange range,
                               SingleRayCounts* counts = nullptr);
/// WideTree::closest_from().
std::optional<Hit> closest_hit_from(const WideTree& tree, const SpaceRay& ray, DepthRange range,
                                    const Hit& from);
/// WideTree::nearest().
void nearest_hits(const WideTree& tree, const SpaceRay& ray, DepthRange range, NearestHits& hits);
bool any_hit(const WideTree& tree, const SpaceRay& ray, DepthRange range, SingleRayCounts* counts = nullptr);
/// WideTree::in_the_way().
InTheWay opaque_hit(const WideTree& tree, const SpaceRay& ray, DepthRange range, DepthRange sure);

/// The same of many rays, in any order: met[i] is that of rays[i]. Those that go alike go together
/// (accel/wide/rays/ray_groups.h).
void opaque_hits(const WideTree& tree, std::span<const RangedRay> rays, std::span<InTheWay> met);

}  // namespace trapeze
