/// The acceleration structure of [Hou10 sec. 3.2 to 3.5]: a binary tree of OBB hyper-trapezoids. At the top
/// one grid a leaf, by the centroid SAH at mid-shutter with the orientation-aware fallback; inside grids
/// parametric midpoint splits. A grid's orientation holds for all nodes in it; a node above takes the
/// orientation of that child which makes it smaller.
///
/// Departs from the paper: boxes inside grids are 16-bit numbers; any number of motion keys; bounds are grown
/// for rounding, and the depth at which a box is entered is taken less by the size of its largest
/// micropolygon, because the predicate's depth is only known to lie within the micropolygon's own (a needle's
/// weights round to anything). So the tree finds what testing everything finds, bit for bit.
#pragma once

#include <vector>

#include "accel/hit_policies.h"
#include "accel/in_grid_trees.h"
#include "accel/top_level.h"
#include "accel/traverse.h"
#include "core/grid.h"
#include "core/ray_query.h"
#include "core/stats.h"

namespace trapeze {

class PaperTree final : public RayQuery {
  public:
    /// Keeps a reference to the grids.
    explicit PaperTree(const Grids& grids) : PaperTree(grids, summaries_of(grids)) {}

    /// Shows the policy the hits of a ray, near ones first as far as bounds tell.
    template <class Policy>
    void trace(TraceRay& ray, Policy& policy, SampleStats& stats) const {
        trace(top_, ray, policy, stats);
    }

    /// The same through a part of the levels above grids that holds all that the ray may meet.
    template <class Policy>
    void trace(const TopLevel& part, TraceRay& ray, Policy& policy, SampleStats& stats) const;

    const TopLevel& top() const { return top_; }

    std::optional<Hit> closest(const SpaceRay& ray, DepthRange range) const override;
    bool any(const SpaceRay& ray, DepthRange range) const override;

    BuildStats stats() const { return stats_; }

  private:
    struct NodeBound {
        HyperTrapezoid box;
        float absolute_max = 0, quad_extent = 0;
    };

    static std::vector<GridSummary> summaries_of(const Grids& grids);
    PaperTree(const Grids& grids, const std::vector<GridSummary>& summaries);
    NodeBound build_bounds(const TopTopology& topology, const std::vector<GridSummary>& summaries,
                           TopLink link, int depth);
    void set_node(size_t index, TopLink link, const NodeBound& bound);

    const Grids& grids_;
    std::vector<HyperTrapezoid> grid_bounds_;  ///< while building only
    InGridTrees in_grid_;
    TopLevel top_;  ///< with as many keys as any grid has
    BuildStats stats_;
};

template <class Policy>
void PaperTree::trace(const TopLevel& part, TraceRay& ray, Policy& policy, SampleStats& stats) const {
    TraversalStats in_top, in_grids;
    traverse(TopLevelView(part, ray), ray, in_top, [&](uint32_t grid_index, TraceRay&) {
        const Grid& grid = grids_.grids[grid_index];
        traverse(InGridTree(in_grid_, grid, grid_index, ray), ray, in_grids,
                 [&](const GridBlock& block, TraceRay&) {
                     test_block(grid, grid_index, block, ray, policy, stats);
                 });
    });
    ++stats.rays;
    stats.nodes_visited += in_top.nodes + in_grids.nodes;
    stats.leaves_visited += in_grids.leaves;
}

}  // namespace trapeze
