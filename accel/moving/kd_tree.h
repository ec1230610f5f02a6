/// A k-d tree over micropolygons that move [Yang17]: rays go through it as through any k-d tree, and in a
/// leaf look at those micropolygons that are in its cell at their time.
///
/// Departs from the paper: micropolygons instead of triangles; the one predicate, which also decides in which
/// order hits are; planes are passed with what rays and boxes round, and ends of rays are taken by the size
/// of the largest micropolygon below too far [decision 0004]. So the tree finds what testing everything
/// finds, bit for bit. Planes are tried between slabs, not at all sides of boxes. Guests that outnumber
/// residents vote for planes: a cell that is empty at the plane time, and through which everything flies at
/// another, would be one leaf.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "accel/builders/grid_summary.h"
#include "accel/grid_block.h"
#include "accel/moving/kd_topology.h"
#include "accel/slabs.h"
#include "core/grid.h"
#include "core/stats.h"

namespace trapeze {

/// What rays change on the way is theirs (stack and mailbox), so that threads may trace at once.
class KdTree {
  public:
    /// Builds in parallel. Keeps a reference to the grids.
    explicit KdTree(const Grids& grids, const KdTreeOptions& options = {});

    /// Shows the policy the hits of a ray, near ones first as far as cells tell; the same hit several times,
    /// for a micropolygon is in several leaves.
    template <class Policy>
    void trace(TraceRay& ray, Policy& policy, SampleStats& stats) const;

    BuildStats stats() const { return stats_; }

  private:
    /// A micropolygon in a leaf, and when it is there, in 65535ths of the shutter.
    struct Reference {
        MicropolygonId id;
        uint16_t from, to;
    };

    /// The last micropolygons that a ray tested: what a leaf has in common with those before it. Each has one
    /// place, by bits of its id, where the next one to come takes over: forgetting costs a test, never a hit.
    class Mailbox {
      public:
        explicit Mailbox(bool is_used) : mask_(is_used ? kPlaces - 1 : 0), is_used_(is_used) {
            if (is_used) tested_.fill(MicropolygonId::kNone);
        }
        /// Whether a micropolygon was tested lately; if not, it is now.
        bool knows(const MicropolygonId& id) {
            if (!is_used_) return false;
            const uint64_t packed = id.packed();
            uint64_t& place = tested_[(packed ^ packed >> 4 ^ packed >> 8) & mask_];
            if (place == packed) return true;
            place = packed;
            return false;
        }

      private:
        static constexpr size_t kPlaces = 64;
        std::array<uint64_t, kPlaces> tested_;
        size_t mask_;
        bool is_used_;
    };

    /// A subtree that the ray has still to look into, and its way through the cell.
    struct Cell {
        uint32_t node;
        float near, far;  ///< depths between which the ray is in it
    };

    static constexpr float kTimeSteps = 65535;

    /// Of each node: children come after their parents.
    std::vector<float> extents_below(const std::vector<GridSummary>& summaries) const;

    /// `time`: the ray's, in steps of kTimeSteps as references have it.
    template <class Policy>
    void test_leaf(uint32_t number, float time, Mailbox& mailbox, TraceRay& ray, Policy& policy,
                   SampleStats& stats) const {
        for (uint32_t i = leaf_first_[number]; i < leaf_first_[number + 1]; ++i) {
            const Reference& r = references_[i];
            if (!(static_cast<float>(r.from) <= time && time <= static_cast<float>(r.to))) continue;
            if (mailbox.knows(r.id)) continue;
            test_micropolygon(grids_.grids[r.id.grid], r.id, ray, policy, stats);
        }
    }

    const Grids& grids_;
    bool mailbox_;
    KeyBox box_;              ///< of everything that can be bounded, at all times
    float absolute_max_ = 0;  ///< its largest coordinate
    std::vector<KdNode> nodes_;
    std::vector<float> extents_;  ///< a node: the longest side of any micropolygon's box below it, at any key
    std::vector<uint32_t> leaf_first_;
    std::vector<Reference> references_;
    std::vector<MicropolygonId> unbounded_;  ///< what any ray may meet
    BuildStats stats_;
};

template <class Policy>
void KdTree::trace(TraceRay& ray, Policy& policy, SampleStats& stats) const {
    ++stats.rays;
    for (const MicropolygonId& id : unbounded_)
        test_micropolygon(grids_.grids[id.grid], id, ray, policy, stats);
    if (nodes_.empty()) return;
    const RayInAxes along_axes(ray);
    const float rounding = ray.rounding(absolute_max_);
    const DepthInterval whole = clip(along_axes, box_, box_, 0, rounding);
    float depth;
    if (!whole.meets(ray, extents_[0], depth)) return;
    std::array<float, 3> pad;
    for (size_t k = 0; k < 3; ++k) pad[k] = rounding * std::abs(along_axes.inverse_direction[k]);
    const float time = ray.axis.time * kTimeSteps;
    Mailbox mailbox(mailbox_);
    // A step down leaves at most one cell waiting: their number is bounded by the depth.
    std::array<Cell, kKdDepthLimit + 1> todo;
    size_t waiting = 0;
    todo[waiting++] = {0, whole.near, whole.far};
    while (waiting > 0) {
        Cell cell = todo[--waiting];
        // Negated, so that a NaN, which is no bound, goes on.
        if (cell.near - extents_[cell.node] > ray.t_max) continue;
        const KdNode* node = &nodes_[cell.node];
        while (!node->is_leaf()) {
            ++stats.nodes_visited;
            const auto axis = static_cast<size_t>(node->axis());
            const float inverse = along_axes.inverse_direction[axis];
            const float crossing = (node->plane - along_axes.origin[axis]) * inverse;
            // Rounding may move the crossing anywhere between these: a side is left out where both say so.
            const float before = crossing - pad[axis], after = crossing + pad[axis];
            const uint32_t near_child = node->index() + (inverse < 0),
                           far_child = node->index() + !(inverse < 0);
            if (after < cell.near || after + extents_[near_child] < ray.t_min) {
                cell.node = far_child;
            } else if (before > cell.far || before - extents_[far_child] > ray.t_max) {
                cell.node = near_child;
            } else {
                todo[waiting++] = {far_child, before > cell.near ? before : cell.near, cell.far};
                cell = {near_child, cell.near, after < cell.far ? after : cell.far};
            }
            node = &nodes_[cell.node];
        }
        ++stats.leaves_visited;
        test_leaf(node->index(), time, mailbox, ray, policy, stats);
    }
}

}  // namespace trapeze
