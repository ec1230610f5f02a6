/// A binary tree over micropolygons whose nodes are bounded by planes of fixed directions: what the moving
/// Kay-Kajiya tree of PRMan's ray tracer is [Kay86; Christensen06], or 4D polyhedra of space-time
/// [Glassner88]; the two that [Hou10 sec. 2] sets itself apart from. The topology is that of `interpolated`
/// (MovingTree), so that bounds alone differ.
///
/// Departs from the papers: micropolygons, and the one predicate; bounds are grown for rounding, and the
/// depth at which they are entered is taken less by the size of the largest micropolygon in them [decision
/// 0004]. So the tree finds what testing everything finds, bit for bit. Planes of space-time lean by the root
/// mean square of the speeds along each axis; [Glassner88] leaves the choice open.
#pragma once

#include <span>
#include <vector>

#include "accel/builders/sah_topology.h"
#include "accel/grid_block.h"
#include "accel/moving/plane_sets.h"
#include "accel/slabs.h"
#include "accel/traverse.h"
#include "core/grid.h"
#include "core/memory/large_pages.h"
#include "core/stats.h"

namespace trapeze {

struct SlabTreeOptions {
    enum class Planes {
        Moving,    ///< seven pairs in space, at every key
        SpaceTime  ///< six pairs in space-time, for all times
    };
    Planes planes = Planes::Moving;
    int leaf = 8;  ///< leaves have fewer micropolygons
};

/// Threads may trace at once.
class SlabTree {
  public:
    /// Builds in parallel. Keeps a reference to the grids. At most 2^30 micropolygons.
    explicit SlabTree(const Grids& grids, const SlabTreeOptions& options = {});

    /// Shows the policy the hits of a ray, near ones first as far as bounds tell.
    template <class Policy>
    void trace(TraceRay& ray, Policy& policy, SampleStats& stats) const;

    BuildStats stats() const { return stats_; }

  private:
    friend class SlabTreeView;

    struct Node {
        float absolute_max = 0;  ///< the largest number that a micropolygon below has along axes and sets
        float quad_extent = 0;   ///< size of the largest micropolygon below
        TopLink link;
    };

    size_t leaf_count() const { return leaf_first_.size() - 1; }
    std::span<const MicropolygonId> leaf(uint32_t index) const {
        return std::span(micropolygons_)
            .subspan(leaf_first_[index], leaf_first_[index + 1] - leaf_first_[index]);
    }
    PlaneExtents* extents_of(size_t node) { return extents_.data() + node * key_count_; }
    const PlaneExtents* extents_of(size_t node) const { return extents_.data() + node * key_count_; }
    void bound_leaf(size_t node);
    void bound_micropolygon(const Grid& grid, const MicropolygonId& id, Node& node,
                            PlaneExtents* extents) const;
    void join(size_t node, size_t first_child);

    const Grids& grids_;
    PlaneSets sets_;
    size_t key_count_ = 1;            ///< of extents; one for all times where planes are those of space-time
    std::vector<uint8_t> unbounded_;  ///< by grid
    UnsetVector<MicropolygonId> micropolygons_;
    std::vector<uint32_t> leaf_first_;  ///< one more than leaves
    std::vector<Node, LargePages<Node>>
        nodes_;  ///< the sides of inner node i are 2 i and 2 i + 1, the root is the last
    UnsetVector<PlaneExtents> extents_;
    BuildStats stats_;
};

/// A SlabTree prepared for one ray, which is turned to the directions of all planes once.
class SlabTreeView {
  public:
    static constexpr int kStackSize = kTopDepthLimit + 2;

    SlabTreeView(const SlabTree& tree, const TraceRay& ray);

    Visits enter(const TraceRay& ray) const;
    Visits step(const Visit& at, const TraceRay& ray) const;
    bool is_leaf(uint32_t node) const { return TopLink{node}.is_leaf(); }
    uint32_t leaf(uint32_t node) const { return TopLink{node}.index(); }

  private:
    bool meet(size_t index, const TraceRay& ray, Visit& visit) const;

    const SlabTree& tree_;
    MotionSegment segment_;
    alignas(32) float origin_[PlaneSets::kLanes], inverse_[PlaneSets::kLanes];
};

template <class Policy>
void SlabTree::trace(TraceRay& ray, Policy& policy, SampleStats& stats) const {
    TraversalStats traversal;
    traverse(SlabTreeView(*this, ray), ray, traversal, [&](uint32_t index, TraceRay&) {
        for (const MicropolygonId& id : leaf(index))
            test_micropolygon(grids_.grids[id.grid], id, ray, policy, stats);
    });
    ++stats.rays;
    stats.nodes_visited += traversal.nodes;
    stats.leaves_visited += traversal.leaves;
}

}  // namespace trapeze
