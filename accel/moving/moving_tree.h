/// A binary tree over micropolygons whose nodes have a box at each of some motion keys, interpolated at the
/// time of a ray [Christensen06]: what all papers on moving boxes compare with. With a budget for spatial
/// splits it is the MSBVH [Gruenschloss11]: its topology is that of micropolygons at mid-shutter where planes
/// may cut them [Stich09], and a leaf's boxes are those of the parts that it refers to, wherever they are at
/// the keys. Or it is a linear tree [Lauterbach09], which is built fastest.
///
/// Departs from the papers: micropolygons instead of triangles; the one predicate, which also decides in
/// which order hits are; boxes are grown for rounding, and the depth at which they are entered is taken less
/// by the size of the largest micropolygon in them [decision 0004]. So the tree finds what testing everything
/// finds, bit for bit, but for naive clipping, which is wrong. Parts that the second form of clipping makes
/// hold a micropolygon only all together: a hit outside of its leaf's box counts. Instances, and weights of
/// keys other than linear, are not there: grids have neither.
#pragma once

#include <span>
#include <vector>

#include "accel/grid_block.h"
#include "accel/hit_policies.h"
#include "accel/moving/moving_options.h"
#include "accel/moving/spatial_topology.h"
#include "accel/paper/top_level.h"
#include "accel/traverse.h"
#include "core/grid.h"
#include "core/stats.h"

namespace trapeze {

class MovingTree {
  public:
    /// Builds in parallel. Keeps a reference to the grids. At most 2^30 micropolygons and parts.
    explicit MovingTree(const Grids& grids, const MovingTreeOptions& options = {});

    /// Shows the policy the hits of a ray, near ones first as far as bounds tell; the same hit several times
    /// where it has parts. `part`: see PaperTree::trace().
    template <class Policy>
    void trace(TraceRay& ray, Policy& policy, SampleStats& stats) const {
        trace(top_, ray, policy, stats);
    }
    template <class Policy>
    void trace(const TopLevel& part, TraceRay& ray, Policy& policy, SampleStats& stats) const;

    const TopLevel& top() const { return top_; }
    BuildStats stats() const { return stats_; }
    /// Whether trace() may show a policy the same hit again.
    bool repeats_hits() const { return stats_.tree_duplicates > 0; }

  private:
    struct Sources;

    /// Bounds nodes that are leaves.
    void bound_leaves(const Sources& sources, const SpatialTopology& topology);
    /// Bounds the node of an inner link, and all inner ones below it, by their children.
    void bound_below(const TopTopology& topology, TopLink link, size_t node, int depth);
    /// By id, so that neighbours are tested together.
    std::span<const MicropolygonId> leaf(uint32_t index) const {
        return std::span(micropolygons_)
            .subspan(leaf_first_[index], leaf_first_[index + 1] - leaf_first_[index]);
    }

    const Grids& grids_;
    TopLevel top_;                               ///< leaf links are indices of lists
    std::vector<MicropolygonId> micropolygons_;  ///< list after list
    std::vector<uint32_t> leaf_first_;           ///< list -> its first micropolygon; one more than lists
    BuildStats stats_;
};

template <class Policy>
void MovingTree::trace(const TopLevel& part, TraceRay& ray, Policy& policy, SampleStats& stats) const {
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
