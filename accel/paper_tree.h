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

#include "accel/builders/top_topology.h"
#include "accel/hit_policies.h"
#include "accel/in_grid_trees.h"
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
    void trace(TraceRay& ray, Policy& policy, SampleStats& stats) const;

    std::optional<Hit> closest(const SpaceRay& ray, DepthRange range) const override;
    bool any(const SpaceRay& ray, DepthRange range) const override;

    BuildStats stats() const { return stats_; }

  private:
    friend class PaperTreeTop;

    /// A node as its parent sees it, with key_count_ boxes in boxes_.
    struct alignas(64) Node {
        FrameColumns frame;
        float absolute_max = 0, quad_extent = 0;  ///< of all grids below
        TopLink link;
    };
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
    int key_count_;                            ///< of the top: the most of any grid
    std::vector<HyperTrapezoid> grid_bounds_;  ///< while building only
    InGridTrees in_grid_;
    std::vector<Node> nodes_;  ///< children of inner node i at 2 i and 2 i + 1; the root last
    std::vector<KeyBox> boxes_;
    BuildStats stats_;
};

/// The levels above grids, prepared for one ray. A RayTree whose leaves are grids.
class PaperTreeTop {
  public:
    static constexpr int kStackSize = kTopDepthLimit + 2;

    PaperTreeTop(const PaperTree& tree, const TraceRay& ray)
        : tree_(tree), segment_(segment_at(ray.axis.time, tree.key_count_)) {}

    Visits enter(const TraceRay& ray) const {
        Visits visits;
        if (!tree_.nodes_.empty()) meet(tree_.nodes_.size() - 1, ray, visits);
        return visits;
    }
    bool is_leaf(uint32_t node) const { return TopLink{node}.is_leaf(); }
    uint32_t leaf(uint32_t node) const { return TopLink{node}.index(); }

    Visits step(const Visit& at, const TraceRay& ray) const {
        Visits visits;
        const size_t first = 2 * size_t{at.node};
        meet(first, ray, visits);
        meet(first + 1, ray, visits);
        if (visits.count == 2 && visits.visit[0].depth < visits.visit[1].depth)
            std::swap(visits.visit[0], visits.visit[1]);
        return visits;
    }

  private:
    void meet(size_t index, const TraceRay& ray, Visits& visits) const {
        const PaperTree::Node& node = tree_.nodes_[index];
        const KeyBox* from = &tree_.boxes_[index * tree_.key_count_ + segment_.index];
        const KeyBox* to = tree_.key_count_ > 1 ? from + 1 : from;
        const float rounding = ray.rounding(node.absolute_max);
        const DepthInterval inside = clip(FrameRay(node.frame, ray), *from, *to, segment_.local, rounding);
        const float slack = node.quad_extent + rounding;
        if (inside.near > inside.far || inside.far + slack < ray.t_min || inside.near - slack > ray.t_max)
            return;
        visits.add({inside.near - slack, node.link.value});
    }

    const PaperTree& tree_;
    MotionSegment segment_;
};

template <class Policy>
void PaperTree::trace(TraceRay& ray, Policy& policy, SampleStats& stats) const {
    TraversalStats in_top, in_grids;
    traverse(PaperTreeTop(*this, ray), ray, in_top, [&](uint32_t grid_index, TraceRay&) {
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
