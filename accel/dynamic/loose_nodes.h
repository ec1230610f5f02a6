/// The nodes of a loose hierarchy over objects: halves of halves of the space that they are in, and so a grid
/// of voxels at every third level, into which objects are put by their middles and sizes alone [DynBvh06
/// sec. 3.2].
#pragma once

#include <cstdint>
#include <vector>

#include "accel/dynamic/frame_boxes.h"
#include "accel/dynamic/pending_visits.h"

namespace trapeze {

/// How fine a loose hierarchy is, and which of its nodes rays pass over.
struct LooseOptions {
    /// A multiple of three, at most 24: the lowest level is a grid of 2^(levels / 3) voxels a side.
    int levels = 18;
    /// Large objects stay at higher levels (the report's advanced form); else all are at the lowest.
    bool by_size = true;
    /// A node with one child and no objects gives way to it.
    bool skip = true;
};

/// A complete binary tree in an array, level by level: a node's number tells its children and its voxels, and
/// no links are kept. Its 2^(levels + 1) - 1 nodes take memory however few objects there are.
class LooseNodes {
  public:
    /// Algorithm 2: puts some objects of a frame, by number, into nodes, in parallel, and bounds these.
    /// Without any there are no nodes.
    void build(const LooseOptions& options, const FrameBoxes& objects, std::vector<uint32_t> members);

    /// Shows the policy the hits of a ray, near ones first as far as boxes tell; `objects` are those of the
    /// build.
    template <class Policy>
    void trace(const FrameBoxes& objects, TraceRay& ray, Policy& policy, SampleStats& stats) const;

    bool empty() const { return boxes_.empty(); }
    size_t size() const { return boxes_.size(); }
    size_t bytes() const;
    /// The node that a member is in: the root is 0, the children of node i are 2 i + 1 and 2 i + 2.
    uint32_t node_of(size_t member) const { return node_of_[member]; }
    const KeyBox& box_of(uint32_t node) const { return boxes_[node]; }

  private:
    void place(const LooseOptions& options, const FrameBoxes& objects);
    void bound(bool skip, const FrameBoxes& objects);
    bool is_lowest(uint32_t node) const { return 2 * size_t{node} + 2 >= boxes_.size(); }

    KeyBox space_;                         ///< of all members
    std::vector<uint32_t> members_;        ///< objects
    std::vector<uint32_t> node_of_;        ///< of members
    std::vector<uint32_t> first_in_node_;  ///< node -> its first place in in_order_; one more than nodes
    std::vector<uint32_t> in_order_;       ///< objects, node after node
    std::vector<KeyBox> boxes_;            ///< of nodes; empty where there is nothing
    std::vector<uint32_t> skip_to_;        ///< the node to visit instead of one
};

template <class Policy>
void LooseNodes::trace(const FrameBoxes& objects, TraceRay& ray, Policy& policy, SampleStats& stats) const {
    if (boxes_.empty()) return;
    PendingVisits visits(ray, objects);
    visits.push(0, boxes_[0]);
    for (uint32_t at; visits.pop(at);) {
        const uint32_t node = skip_to_[at];
        ++stats.nodes_visited;
        for (uint32_t i = first_in_node_[node]; i < first_in_node_[node + 1]; ++i)
            // To read four corners at the ray's time takes far longer than to ask their box.
            if (visits.may_meet(objects.boxes[in_order_[i]]))
                objects.test_object(in_order_[i], ray, policy, stats);
        if (is_lowest(node)) {
            ++stats.leaves_visited;
            continue;
        }
        const uint32_t low = 2 * node + 1, high = low + 1;
        visits.push(low, boxes_[low], high, boxes_[high]);
    }
}

}  // namespace trapeze
