/// The loose hierarchy: a binary tree of a fixed number of levels, whose nodes are halves of halves of the
/// scene and so a grid of voxels at every third level, and into which objects are put by their middles and
/// sizes alone [DynBvh06 sec. 3.2]. A frame is emptied, filled and bounded anew, in time linear in its
/// objects and nodes; nothing is compared with anything.
#pragma once

#include <cstdint>
#include <vector>

#include "accel/dynamic/frame_boxes.h"
#include "accel/dynamic/pending_visits.h"

namespace trapeze {

/// How fine a LooseTree is, and which of its nodes rays pass over.
struct LooseOptions {
    /// A multiple of three, at most 24: the lowest level is a grid of 2^(levels / 3) voxels a side.
    int levels = 18;
    /// Large objects stay at higher levels (the report's advanced form); else all are at the lowest.
    bool by_size = true;
    /// A node with one child and no objects gives way to it.
    bool skip = true;
};

/// Nodes are a complete binary tree in an array, level by level: a node's number tells its children and its
/// voxels, and no links are kept. Its 2^(levels + 1) - 1 nodes take memory however few objects there are.
class LooseTree {
  public:
    explicit LooseTree(const LooseOptions& options = {}) : options_(options) {}

    /// Keeps a reference to the grids. Algorithm 2; objects are read and placed in parallel.
    void build(const Grids& grids);
    /// Nothing of the frame before is of use: what moves costs no more than what stands still.
    void update(const Grids& grids) { build(grids); }

    /// Shows the policy the hits of a ray, near ones first as far as boxes tell.
    template <class Policy>
    void trace(TraceRay& ray, Policy& policy, SampleStats& stats) const;

    BuildStats stats() const;

    /// Objects in the node that has most of them.
    size_t most_in_a_node() const;
    /// The node that an object is in: the root is 0, the children of node i are 2 i + 1 and 2 i + 2.
    uint32_t node_of(size_t object) const { return node_of_[object]; }
    const KeyBox& box_of(uint32_t node) const { return boxes_[node]; }

  private:
    void place_objects();
    void bound_nodes();
    bool is_lowest(uint32_t node) const { return 2 * size_t{node} + 2 >= boxes_.size(); }

    LooseOptions options_;
    FrameBoxes objects_;
    KeyBox scene_;
    std::vector<uint32_t> node_of_;        ///< of objects
    std::vector<uint32_t> first_in_node_;  ///< node -> its first place in in_order_; one more than nodes
    std::vector<uint32_t> in_order_;       ///< objects, node after node
    std::vector<KeyBox> boxes_;            ///< of nodes; empty where there is nothing
    std::vector<uint32_t> skip_to_;        ///< the node to visit instead of one
};

template <class Policy>
void LooseTree::trace(TraceRay& ray, Policy& policy, SampleStats& stats) const {
    ++stats.rays;
    objects_.test_unbounded(ray, policy, stats);
    if (boxes_.empty()) return;
    PendingVisits visits(ray, objects_);
    visits.push(0, boxes_[0]);
    for (uint32_t at; visits.pop(at);) {
        const uint32_t node = skip_to_[at];
        ++stats.nodes_visited;
        for (uint32_t i = first_in_node_[node]; i < first_in_node_[node + 1]; ++i)
            // To read four corners at the ray's time takes far longer than to ask their box.
            if (visits.may_meet(objects_.boxes[in_order_[i]]))
                objects_.test_object(in_order_[i], ray, policy, stats);
        if (is_lowest(node)) {
            ++stats.leaves_visited;
            continue;
        }
        const uint32_t low = 2 * node + 1, high = low + 1;
        visits.push(low, boxes_[low], high, boxes_[high]);
    }
}

}  // namespace trapeze
