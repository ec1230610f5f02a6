#include "accel/dynamic/box_tree.h"

#include <utility>

namespace trapeze {

TopTopology topology_over(const FrameBoxes& objects, std::vector<uint32_t>& members) {
    std::vector<SahItem> items;
    items.reserve(members.size());
    for (const uint32_t member : members) {
        const KeyBox& box = objects.boxes[member];
        items.push_back(
            {Box3f(V3f(box.low[0], box.low[1], box.low[2]), V3f(box.high[0], box.high[1], box.high[2])), 1,
             member});
    }
    SahOptions options;
    options.split_anyway = true;
    options.fallback_order = [](std::span<SahItem>) {};  // as they come
    SahTopology topology = build_sah_topology(items, options);
    for (size_t i = 0; i < members.size(); ++i) members[i] = items[i].id;
    return std::move(topology.tree);
}

void BoxTree::build(const FrameBoxes& objects, std::vector<uint32_t> members) {
    members_ = std::move(members);
    nodes_.clear();
    if (members_.empty()) return;
    const TopTopology topology = topology_over(objects, members_);
    root_ = topology.root;
    nodes_.resize(topology.inner.size());
    for (size_t i = 0; i < nodes_.size(); ++i) nodes_[i].child = topology.inner[i];
    bound(objects);
}

void BoxTree::take_out(const FrameBoxes& objects, const std::vector<uint8_t>& leave) {
    size_t left = 0;
    for (uint32_t& member : members_) {
        if (member != kNone && leave[member]) member = kNone;
        left += member != kNone;
    }
    if (left == 0) members_.clear(), nodes_.clear();
    bound(objects);
}

/// Children come after their parents.
void BoxTree::bound(const FrameBoxes& objects) {
    for (size_t i = nodes_.size(); i-- > 0;) {
        const auto& [first, second] = nodes_[i].child;
        nodes_[i].box = joined(box_of(objects, first), box_of(objects, second));
    }
}

}  // namespace trapeze
