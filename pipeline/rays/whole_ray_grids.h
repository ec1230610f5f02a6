/// Grids that are in memory as a whole, with one tree over them.
#pragma once

#include <algorithm>
#include <vector>

#include "accel/wide/wide_tree.h"
#include "pipeline/rays/ray_grids.h"

namespace trapeze {

/// The id of a hit in a tree over some grids, with the grid's ordinal in place of its number.
inline Hit with_ordinal(const Hit& hit, const Grids& grids) {
    MicropolygonId id = MicropolygonId::unpack(hit.id);
    id.grid = static_cast<uint32_t>(grids.grids[id.grid].ordinal);
    return {hit.depth, id.packed()};
}

/// A hit of another ordinal's grid, or of the next one that is there, by its place in the tree.
inline Hit of_tree(const Hit& hit, const Grids& grids) {
    MicropolygonId id = MicropolygonId::unpack(hit.id);
    const auto at = std::ranges::lower_bound(grids.grids, uint64_t{id.grid}, {}, &Grid::ordinal);
    const bool is_there = at != grids.grids.end() && at->ordinal == id.grid;
    if (!is_there) id.u = id.v = 0;
    id.grid = static_cast<uint32_t>(at - grids.grids.begin());
    return {hit.depth, id.packed()};
}

/// The nearest hit of a tree over some grids, in the order of their ordinals.
inline std::optional<Hit> closest_in(const WideTree& tree, const Grids& grids, const RangedRay& ray) {
    if (ray.from == kFirstHit) return tree.closest(ray.ray, ray.range);
    return tree.closest_from(ray.ray, ray.range, of_tree(ray.from, grids));
}

class WholeRayGrids final : public RayGrids {
  public:
    /// In the order of their ordinals; at least one, at most WideTree::kMaxGrids.
    explicit WholeRayGrids(Grids grids) : grids_(std::move(grids)), tree_(grids_, RayReach()) {}

    std::optional<RayGridHit> closest(const RangedRay& ray) const override {
        const std::optional<Hit> hit = closest_in(tree_, grids_, ray);
        if (!hit) return {};
        return of_grid(*hit);
    }
    NearestGridHits nearest(const RangedRay& ray) const override {
        NearestHits nearest;
        if (ray.from != kFirstHit) nearest.from = of_tree(ray.from, grids_);
        tree_.nearest(ray.ray, ray.range, nearest);
        NearestGridHits found;
        for (size_t i = 0; i < nearest.count; ++i) found.hits.push_back(of_grid(nearest.hits[i]));
        found.is_cut = nearest.is_cut;
        return found;
    }
    void in_the_way(std::span<const RangedRay> rays, std::span<InTheWay> met) const override {
        tree_.in_the_way(rays, met);
    }
    size_t bytes() const override { return grids_.bytes() + tree_.stats().tree_bytes; }

  private:
    RayGridHit of_grid(const Hit& hit) const {
        return {with_ordinal(hit, grids_), &grids_.grids[MicropolygonId::unpack(hit.id).grid], nullptr};
    }

    Grids grids_;
    WideTree tree_;
};

}  // namespace trapeze
