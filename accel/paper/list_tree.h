/// Binary trees whose leaves are lists of micropolygons of any grids: what they keep, and how rays go
/// through.
#pragma once

#include <span>
#include <vector>

#include "accel/grid_block.h"
#include "accel/paper/top_level.h"
#include "accel/traverse.h"
#include "core/grid.h"
#include "core/memory/large_pages.h"
#include "core/stats.h"

namespace trapeze {

/// Trees derive from it, and fill it in when they are made.
class ListTree {
  public:
    /// Shows the policy the hits of a ray, near ones first as far as bounds tell; `part`: see
    /// PaperTree::trace(). The same hit several times where a micropolygon is in several lists.
    template <class Policy>
    void trace(TraceRay& ray, Policy& policy, SampleStats& stats) const {
        trace(top_, ray, policy, stats);
    }
    template <class Policy>
    void trace(const TopLevel& part, TraceRay& ray, Policy& policy, SampleStats& stats) const;

    const TopLevel& top() const { return top_; }
    BuildStats stats() const { return stats_; }

  protected:
    /// Keeps a reference to the grids.
    explicit ListTree(const Grids& grids) : grids_(&grids) {}

    size_t leaf_count() const { return leaf_first_.size() - 1; }
    /// The micropolygons of a leaf, by id.
    std::span<const MicropolygonId> leaf(uint32_t index) const {
        return std::span(micropolygons_)
            .subspan(leaf_first_[index], leaf_first_[index + 1] - leaf_first_[index]);
    }
    /// Sets bytes, nodes and leaves of what has been built; `bytes_of_tree`: of the object that derives.
    void count_built(size_t bytes_of_tree) {
        stats_.tree_bytes = bytes_of_tree + top_.bytes() +
                            micropolygons_.capacity() * sizeof(MicropolygonId) +
                            leaf_first_.capacity() * sizeof(uint32_t);
        stats_.tree_nodes = top_.nodes.size();
        stats_.tree_leaves = leaf_count();
    }

    const Grids* grids_;
    TopLevel top_;                               ///< leaf links are indices of lists
    UnsetVector<MicropolygonId> micropolygons_;  ///< list after list
    std::vector<uint32_t> leaf_first_;           ///< list -> its first micropolygon; one more than lists
    BuildStats stats_;
};

template <class Policy>
void ListTree::trace(const TopLevel& part, TraceRay& ray, Policy& policy, SampleStats& stats) const {
    TraversalStats traversal;
    traverse(TopLevelView(part, ray), ray, traversal, [&](uint32_t index, TraceRay&) {
        for (const MicropolygonId& id : leaf(index))
            test_micropolygon(grids_->grids[id.grid], id, ray, policy, stats);
    });
    ++stats.rays;
    stats.nodes_visited += traversal.nodes;
    stats.leaves_visited += traversal.leaves;
}

}  // namespace trapeze
