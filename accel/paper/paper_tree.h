/// The acceleration structure of [Hou10 sec. 3.2 to 3.5]: a binary tree of OBB hyper-trapezoids. At the top
/// one grid a leaf, by the centroid SAH at mid-shutter with the orientation-aware fallback; inside grids
/// parametric midpoint splits. A grid's orientation holds for all nodes in it; a node above takes the
/// orientation of that child which makes it smaller. Of axis-aligned bounds the topology is the same.
///
/// Departs from the paper: a node above grids is bounded from the vertices or the grids below it, where these
/// are few enough, and not by merging its children's boxes [decision 0008]; boxes inside grids are 16-bit
/// numbers; any number of motion keys; bounds are grown for rounding, and the depth at which a box is entered
/// is taken less by the size of its largest micropolygon, because the predicate's depth is only known to lie
/// within the micropolygon's own [decision 0004] (a needle's weights round to anything). So the tree finds
/// what testing everything finds, bit for bit.
#pragma once

#include <vector>

#include "accel/builders/paper_options.h"
#include "accel/hit_policies.h"
#include "accel/paper/in_grid_trees.h"
#include "accel/paper/top_level.h"
#include "accel/traverse.h"
#include "core/grid.h"
#include "core/ray_query.h"
#include "core/stats.h"

namespace trapeze {

/// The reference among trees: the paper's method, one ray at a time. Answers for rays in any direction.
class PaperTree final : public RayQuery {
  public:
    /// Builds the tree in parallel. Keeps a reference to the grids, which must not change while the tree is
    /// in use.
    explicit PaperTree(const Grids& grids, const PaperTreeOptions& options = {})
        : PaperTree(grids, options, oriented_summaries(grids, options)) {}

    /// Shows the policy (accel/hit_policies.h) the hits of a ray, near ones first as far as bounds tell.
    /// Counts nodes, leaves and tests into `stats`. Safe from many threads at once.
    template <class Policy>
    void trace(TraceRay& ray, Policy& policy, SampleStats& stats) const {
        trace(top_, ray, policy, stats);
    }

    /// Traces through a part of the levels above grids (TopLevel::within()) that holds all that the ray may
    /// meet.
    template <class Policy>
    void trace(const TopLevel& part, TraceRay& ray, Policy& policy, SampleStats& stats) const;

    const TopLevel& top() const { return top_; }

    std::optional<Hit> closest(const SpaceRay& ray, DepthRange range) const override;
    bool any(const SpaceRay& ray, DepthRange range) const override;

    BuildStats stats() const { return stats_; }

  private:
    PaperTree(const Grids& grids, const PaperTreeOptions& options, const std::vector<GridSummary>& summaries);

    const Grids& grids_;
    std::vector<HyperTrapezoid> grid_bounds_;  ///< while building only
    InGridTrees in_grid_;
    TopLevel top_;  ///< with as many keys as any grid has
    BuildStats stats_;
};

template <class Policy>
void PaperTree::trace(const TopLevel& part, TraceRay& ray, Policy& policy, SampleStats& stats) const {
    TraversalStats in_top, in_grids;
    const TopLevelView view(part, ray);
    traverse(view, ray, in_top, [&](uint32_t grid_index, TraceRay&) {
        const Grid& grid = grids_.grids[grid_index];
        traverse(InGridTree(in_grid_, grid, grid_index, ray, view.along_axes()), ray, in_grids,
                 [&](const GridBlock& block, TraceRay&) {
                     test_block(grid, grid_index, block, ray, policy, stats);
                 });
    });
    ++stats.rays;
    stats.nodes_visited += in_top.nodes + in_grids.nodes;
    stats.leaves_visited += in_grids.leaves;
}

}  // namespace trapeze
