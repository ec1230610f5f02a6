/// The loose hierarchy: a binary tree of a fixed number of levels, whose nodes are halves of halves of the
/// scene and so a grid of voxels at every third level, and into which objects are put by their middles and
/// sizes alone [DynBvh06 sec. 3.2]. A frame is emptied, filled and bounded anew, in time linear in its
/// objects and nodes; nothing is compared with anything.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "accel/dynamic/frame_boxes.h"

namespace trapeze {

struct LooseOptions {
    /// A multiple of three, at most 3 * kMostTriples: the lowest level is a grid of 2^(levels / 3) voxels a
    /// side.
    int levels = 18;
    /// Large objects stay at higher levels (the report's advanced form); else all are at the lowest.
    bool by_size = true;
    /// A node with one child and no objects gives way to it.
    bool skip = true;

    static constexpr int kMostTriples = 8;
};

class LooseTree {
  public:
    explicit LooseTree(const LooseOptions& options = {}) : options_(options) {}

    /// Keeps a reference to the grids. Algorithm 2; objects are read and placed in parallel.
    void build(const Grids& grids);
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
    const FrameRay along_axes(ray);
    const float rounding = ray.rounding(objects_.absolute_max);
    struct Waiting {
        float depth;
        uint32_t node;
    };
    const auto met = [&](uint32_t child, Waiting& visit) {
        visit.node = child;
        const KeyBox& box = boxes_[child];
        // An empty box is met by rays that a NaN is part of.
        return !is_empty(box) &&
               clip(along_axes, box, box, 0, rounding).meets(ray, objects_.quad_extent, visit.depth);
    };
    std::array<Waiting, 3 * LooseOptions::kMostTriples + 2> todo;
    size_t waiting = 0;
    Waiting first, second;
    if (met(0, first)) todo[waiting++] = first;
    while (waiting > 0) {
        const Waiting at = todo[--waiting];
        if (at.depth > ray.t_max) continue;
        const uint32_t node = skip_to_[at.node];
        ++stats.nodes_visited;
        for (uint32_t i = first_in_node_[node]; i < first_in_node_[node + 1]; ++i)
            objects_.test_object(in_order_[i], ray, policy, stats);
        if (is_lowest(node)) {
            ++stats.leaves_visited;
            continue;
        }
        const bool meets_first = met(2 * node + 1, first), meets_second = met(2 * node + 2, second);
        if (meets_first && meets_second) {
            const bool first_is_near = !(second.depth < first.depth);
            todo[waiting++] = first_is_near ? second : first;
            todo[waiting++] = first_is_near ? first : second;
        } else if (meets_first || meets_second) {
            todo[waiting++] = meets_first ? first : second;
        }
    }
}

}  // namespace trapeze
