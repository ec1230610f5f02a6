/// A binary tree by the surface area heuristic over some objects of a frame, an object a leaf, that stays as
/// long as they do not move.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "accel/builders/sah_topology.h"
#include "accel/dynamic/frame_boxes.h"
#include "accel/dynamic/pending_visits.h"

namespace trapeze {

/// Of objects, by number: who is whose child in a binary tree that has one in each leaf. `members`, at least
/// one, are brought into the order of the leaves. Deterministic, whatever the number of threads.
TopTopology topology_over(const FrameBoxes& objects, std::vector<uint32_t>& members);

class BoxTree {
  public:
    /// Of some objects, by number. Without any there are no nodes.
    void build(const FrameBoxes& objects, std::vector<uint32_t> members);
    /// Takes out the objects that `leave` has a 1 for, by number: their leaves are empty, and nodes are
    /// bounded anew. The tree is the worse for it, by steps through nodes that have one side, but not built.
    void take_out(const FrameBoxes& objects, const std::vector<uint8_t>& leave);

    /// Shows the policy the hits of a ray, near ones first as far as boxes tell; `objects` are those of the
    /// build.
    template <class Policy>
    void trace(const FrameBoxes& objects, TraceRay& ray, Policy& policy, SampleStats& stats) const;

    size_t size() const { return nodes_.size(); }
    size_t bytes() const { return nodes_.capacity() * sizeof(Node) + members_.capacity() * sizeof(uint32_t); }

  private:
    struct alignas(16) Node {
        KeyBox box;
        std::array<TopLink, 2> child;
    };

    static constexpr uint32_t kNone = ~uint32_t{0};

    KeyBox box_of(const FrameBoxes& objects, TopLink link) const {
        if (!link.is_leaf()) return nodes_[link.index()].box;
        const uint32_t member = members_[link.index()];
        return member == kNone ? empty_box() : objects.boxes[member];
    }
    void bound(const FrameBoxes& objects);

    std::vector<uint32_t> members_;  ///< leaf -> object, or kNone
    std::vector<Node> nodes_;        ///< those with children, parents first
    TopLink root_;
};

template <class Policy>
void BoxTree::trace(const FrameBoxes& objects, TraceRay& ray, Policy& policy, SampleStats& stats) const {
    if (members_.empty()) return;
    PendingVisits visits(ray, objects);
    visits.push(root_.value, box_of(objects, root_));
    for (uint32_t at; visits.pop(at);) {
        const TopLink link{at};
        if (link.is_leaf()) {
            ++stats.leaves_visited;
            objects.test_object(members_[link.index()], ray, policy, stats);
            continue;
        }
        ++stats.nodes_visited;
        const auto& [first, second] = nodes_[link.index()].child;
        visits.push(first.value, box_of(objects, first), second.value, box_of(objects, second));
    }
}

}  // namespace trapeze
