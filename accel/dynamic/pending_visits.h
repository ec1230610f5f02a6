/// The nodes that a ray has still to visit in a binary tree of boxes that do not move: near ones first, as
/// far as boxes tell.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "accel/dynamic/frame_boxes.h"
#include "accel/slabs.h"

namespace trapeze {

/// A stack of nodes whose boxes the ray meets. It needs no memory of its own until it is deep: nothing bounds
/// how deep a tree is that objects are inserted into.
class PendingVisits {
  public:
    /// A ray through boxes of these objects.
    PendingVisits(const TraceRay& ray, const FrameBoxes& objects)
        : ray_(ray),
          along_axes_(ray),
          rounding_(ray.rounding(objects.absolute_max)),
          slack_(objects.quad_extent) {}

    void push(uint32_t node, const KeyBox& box) {
        Visit visit;
        if (meets(node, box, visit)) push(visit);
    }
    /// Both children of a node; the nearer is visited first.
    void push(uint32_t first, const KeyBox& first_box, uint32_t second, const KeyBox& second_box) {
        Visit a, b;
        const bool meets_a = meets(first, first_box, a), meets_b = meets(second, second_box, b);
        if (meets_a && meets_b) {
            const bool a_is_near = !(b.depth < a.depth);
            push(a_is_near ? b : a);
            push(a_is_near ? a : b);
        } else if (meets_a || meets_b) {
            push(meets_a ? a : b);
        }
    }
    /// Whether a box that is not empty may hold a hit nearer than those found by now.
    bool may_meet(const KeyBox& box) const {
        float depth;
        return meets(box, depth) && !(depth > ray_.t_max);
    }
    /// The next node, none of which is beyond what the ray has found by now; false: there is none.
    bool pop(uint32_t& node) {
        while (size_ > 0) {
            const Visit visit = take();
            if (visit.depth > ray_.t_max) continue;
            node = visit.node;
            return true;
        }
        return false;
    }

  private:
    /// A node whose box the ray meets; nothing in it is hit before `depth`.
    struct Visit {
        float depth;
        uint32_t node;
    };

    /// Empty boxes are met by no ray: without asking, one that a NaN is part of would meet them.
    bool meets(uint32_t node, const KeyBox& box, Visit& visit) const {
        visit.node = node;
        return !is_empty(box) && meets(box, visit.depth);
    }
    bool meets(const KeyBox& box, float& depth) const {
        return clip(along_axes_, box, box, 0, rounding_).meets(ray_, slack_within(box), depth);
    }
    /// A bound of the longest side of any object in a box, which decision 0004 asks for: no object is longer
    /// than its box, nor than the longest of the scene. So what is long does not slow rays far from it.
    float slack_within(const KeyBox& box) const {
        const float x = box.high[0] - box.low[0], y = box.high[1] - box.low[1], z = box.high[2] - box.low[2];
        const float longest = std::max(std::max(x, y), z);
        return longest < slack_ ? longest : slack_;
    }
    void push(const Visit& visit) {
        if (size_ < kShallow)
            shallow_[size_] = visit;
        else
            deep_.push_back(visit);
        ++size_;
    }
    Visit take() {
        if (--size_ < kShallow) return shallow_[size_];
        const Visit visit = deep_.back();
        deep_.pop_back();
        return visit;
    }

    /// Visits that need no allocation: 768 bytes of them in the object itself.
    static constexpr size_t kShallow = 96;

    const TraceRay& ray_;
    RayInAxes along_axes_;
    float rounding_, slack_;
    std::array<Visit, kShallow> shallow_;
    std::vector<Visit> deep_;
    size_t size_ = 0;
};

}  // namespace trapeze
