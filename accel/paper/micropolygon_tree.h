/// The paper's tree without its parametric splits [Hou10 table 4]: a greedy SAH build over single
/// micropolygons at mid-shutter, bounded as in PaperTree. A leaf takes that orientation which makes it
/// smallest: from the averaged edges of its own micropolygons, or that of one of their grids.
#pragma once

#include <vector>

#include "accel/builders/grid_summary.h"
#include "accel/builders/paper_options.h"
#include "accel/grid_block.h"
#include "accel/hit_policies.h"
#include "accel/paper/top_bounds.h"
#include "accel/paper/top_level.h"
#include "accel/traverse.h"
#include "core/grid.h"
#include "core/stats.h"

namespace trapeze {

/// Leaves are lists of at most options.leaf - 1 micropolygons of any grids. Finds what testing everything
/// finds, bit for bit.
class MicropolygonTree {
  public:
    /// Keeps a reference to the grids.
    explicit MicropolygonTree(const Grids& grids, const PaperTreeOptions& options = {});

    /// Shows the policy the hits of a ray, near ones first as far as bounds tell; `part`: see
    /// PaperTree::trace().
    template <class Policy>
    void trace(TraceRay& ray, Policy& policy, SampleStats& stats) const {
        trace(top_, ray, policy, stats);
    }
    template <class Policy>
    void trace(const TopLevel& part, TraceRay& ray, Policy& policy, SampleStats& stats) const;

    const TopLevel& top() const { return top_; }
    BuildStats stats() const { return stats_; }

  private:
    /// Sorts micropolygons into leaves and bounds the nodes above them.
    void build_topology(const std::vector<GridSummary>& summaries, const PaperTreeOptions& options);
    /// The micropolygons of a leaf, by id.
    std::span<const MicropolygonId> leaf(uint32_t index) const {
        return std::span(micropolygons_)
            .subspan(leaf_first_[index], leaf_first_[index + 1] - leaf_first_[index]);
    }
    /// Bound of a leaf in a given frame, at as many keys as its grids have at most.
    HyperTrapezoid leaf_bound_in(const Frame& frame, uint32_t index,
                                 const std::vector<GridSummary>& summaries,
                                 const PaperTreeOptions& options) const;
    /// Bound of a leaf in that orientation which makes its expected area least.
    NodeBound leaf_bound(uint32_t index, const std::vector<GridSummary>& summaries,
                         const PaperTreeOptions& options) const;

    const Grids& grids_;
    TopLevel top_;                               ///< leaf links are indices of lists
    std::vector<MicropolygonId> micropolygons_;  ///< list after list
    std::vector<uint32_t> leaf_first_;           ///< list -> its first micropolygon; one more than lists
    BuildStats stats_;
};

template <class Policy>
void MicropolygonTree::trace(const TopLevel& part, TraceRay& ray, Policy& policy, SampleStats& stats) const {
    TraversalStats traversal;
    traverse(TopLevelView(part, ray), ray, traversal, [&](uint32_t index, TraceRay&) {
        for (const MicropolygonId& id : leaf(index))
            test_micropolygon(grids_.grids[id.grid], id, ray, policy, stats);
    });
    ++stats.rays;
    stats.nodes_visited += traversal.nodes;
    stats.leaves_visited += traversal.leaves;
}

}  // namespace trapeze
