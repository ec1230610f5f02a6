#include "accel/dynamic/loose_nodes.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "accel/builders/interleaved_bits.h"

namespace trapeze {
namespace {

/// How often an object fits in the scene along the axis where it fits least, as a power of two
/// [DynBvh06 eq. 3]; at most `most`.
int halvings(const KeyBox& object, const KeyBox& scene, int most) {
    int fewest = most;
    for (int k = 0; k < 3; ++k) {
        const float whole = scene.high[k] - scene.low[k], part = object.high[k] - object.low[k];
        if (!(part > 0)) continue;
        const float times = whole / part;
        fewest = std::min(fewest, times >= 1 ? std::min(std::ilogb(times), most) : 0);
    }
    return fewest;
}

/// The voxel that a middle lies in, of 2^halvings along an axis [DynBvh06 eq. 4].
uint64_t voxel_of(float low, float high, float scene_low, float scene_high, int halvings) {
    const float voxels = std::ldexp(1.0f, halvings);
    const float place = (low * 0.5f + high * 0.5f - scene_low) / (scene_high - scene_low) * voxels;
    // What is no number, where the scene has no extent, is in the first.
    return place > 0 ? static_cast<uint64_t>(std::min(place, voxels - 1)) : 0;
}

}  // namespace

void LooseNodes::build(const LooseOptions& options, const FrameBoxes& objects,
                       std::vector<uint32_t> members) {
    members_ = std::move(members);
    if (members_.empty()) {
        boxes_.clear();
        return;
    }
    space_ = empty_box();
    for (const uint32_t member : members_) space_ = joined(space_, objects.boxes[member]);
    const size_t nodes = (size_t{2} << options.levels) - 1;
    boxes_.resize(nodes);
    skip_to_.resize(nodes);
    place(options, objects);
    bound(options.skip, objects);
}

void LooseNodes::place(const LooseOptions& options, const FrameBoxes& objects) {
    // Level 3 n of the tree is a grid of 2^n voxels a side, in the order of their Morton codes; 2^(3 n) - 1
    // nodes come before it.
    const int most = options.levels / 3;
    node_of_.resize(members_.size());
    tbb::parallel_for(size_t{0}, node_of_.size(), [&](size_t i) {
        const KeyBox& box = objects.boxes[members_[i]];
        const int n = options.by_size ? halvings(box, space_, most) : most;
        std::array<uint64_t, 3> voxel;
        for (size_t k = 0; k < 3; ++k)
            voxel[k] = voxel_of(box.low[k], box.high[k], space_.low[k], space_.high[k], n);
        const uint64_t first_of_level = (uint64_t{1} << (3 * n)) - 1;
        node_of_[i] = static_cast<uint32_t>(first_of_level + interleaved(voxel[0], voxel[1], voxel[2]));
    });
    // Sorted by counting: objects of a node keep their order.
    first_in_node_.assign(boxes_.size() + 1, 0);
    for (const uint32_t node : node_of_) ++first_in_node_[node + 1];
    std::partial_sum(first_in_node_.begin(), first_in_node_.end(), first_in_node_.begin());
    in_order_.resize(node_of_.size());
    std::vector<uint32_t> next(first_in_node_.begin(), first_in_node_.end() - 1);
    for (size_t i = 0; i < node_of_.size(); ++i) in_order_[next[node_of_[i]]++] = members_[i];
}

void LooseNodes::bound(bool skip, const FrameBoxes& objects) {
    // Children come after their parents.
    for (auto node = static_cast<uint32_t>(boxes_.size()); node-- > 0;) {
        KeyBox box = empty_box();
        for (uint32_t i = first_in_node_[node]; i < first_in_node_[node + 1]; ++i)
            box = joined(box, objects.boxes[in_order_[i]]);
        skip_to_[node] = node;
        if (!is_lowest(node)) {
            const KeyBox &low = boxes_[2 * node + 1], &high = boxes_[2 * node + 2];
            const bool has_objects = first_in_node_[node] < first_in_node_[node + 1];
            // The child's own skip is known by now: chains of such nodes are passed in one step.
            if (skip && !has_objects && is_empty(low) != is_empty(high))
                skip_to_[node] = skip_to_[2 * node + (is_empty(low) ? 2 : 1)];
            box = joined(box, joined(low, high));
        }
        boxes_[node] = box;
    }
}

size_t LooseNodes::bytes() const {
    return boxes_.capacity() * sizeof(KeyBox) +
           (members_.capacity() + node_of_.capacity() + first_in_node_.capacity() + in_order_.capacity() +
            skip_to_.capacity()) *
               sizeof(uint32_t);
}

}  // namespace trapeze
