#include "accel/paper/top_level.h"

#include <algorithm>
#include <optional>

#include "accel/paper/paired_nodes.h"

namespace trapeze {
namespace {

/// A box that holds a node's box at every time from time_min to time_max. Planes move linearly between keys,
/// so that the two ends and the keys between them are enough. `keys`: key_count of them.
KeyBox box_during(const KeyBox* keys, int key_count, float time_min, float time_max) {
    if (key_count == 1) return keys[0];
    KeyBox box;
    const auto extend = [&](const MotionSegment& s, bool first) {
        const KeyBox &from = keys[s.index], &to = keys[s.index + 1];
        for (int k = 0; k < 3; ++k) {
            const float low = position_at(from.low[k], to.low[k] - from.low[k], s.local);
            const float high = position_at(from.high[k], to.high[k] - from.high[k], s.local);
            box.low[k] = first ? low : std::min(box.low[k], low);
            box.high[k] = first ? high : std::max(box.high[k], high);
        }
    };
    const MotionSegment begin = segment_at(time_min, key_count), end = segment_at(time_max, key_count);
    extend(begin, true);
    extend(end, false);
    for (int index = begin.index + 1; index <= end.index; ++index) extend({index, 0}, false);
    return box;
}

/// Copies what a beam may meet of a tree. The beam's one test of a node spares each of its rays the nodes
/// that none of them can meet.
class Pruning {
  public:
    Pruning(const TopLevel& from, const Beam& beam, TopLevel& to) : from_(from), beam_(beam), to_(to) {}

    /// A node that stays: whose bound it has, and what is below it.
    struct Kept {
        size_t source;
        TopLink link;
    };

    /// Decides about a node and all below it. Nodes are written children first, in pairs, as TopLevel has
    /// them; a node itself is written by whoever calls.
    std::optional<Kept> visit(size_t index) {
        ++looked_at;
        const TopLevel::Node& node = from_.nodes[index];
        const KeyBox box = box_during(from_.boxes_of(index), from_.key_count, beam_.time_min, beam_.time_max);
        if (!beam_.meets(from_.axes_of(index), box, node.absolute_max, node.quad_extent)) return {};
        if (node.link.is_leaf()) return Kept{index, node.link};
        const size_t first = 2 * size_t{node.link.index()};
        const std::optional<Kept> low = visit(first), high = visit(first + 1);
        // One child or none: it takes the node's place.
        if (!low || !high) return low ? low : high;
        const auto inner = static_cast<uint32_t>(to_.nodes.size() / 2);
        copy(*low);
        copy(*high);
        return Kept{index, TopLink::inner(inner)};
    }

    /// Appends a node with its axes and boxes as they were; its link is one of the new tree.
    void copy(const Kept& kept) {
        to_.nodes.push_back(from_.nodes[kept.source]);
        to_.nodes.back().link = kept.link;
        const KeyBox* boxes = from_.boxes_of(kept.source);
        to_.boxes.insert(to_.boxes.end(), boxes, boxes + from_.key_count);
    }

    uint64_t looked_at = 0;

  private:
    const TopLevel& from_;
    const Beam& beam_;
    TopLevel& to_;
};

}  // namespace

void TopLevel::within(const Beam& beam, TopLevel& part, uint64_t* looked_at) const {
    part.key_count = key_count;
    part.oriented = oriented;
    part.nodes.clear();
    part.axes_sets = axes_sets;
    part.keeps_turned_rays = keeps_turned_rays;
    part.boxes.clear();
    if (nodes.empty()) return;
    Pruning pruning(*this, beam, part);
    // The root goes last, as in any TopLevel; its own bound is not tested again.
    if (const auto root = pruning.visit(nodes.size() - 1)) pruning.copy(*root);
    *looked_at += pruning.looked_at;
}

inline const RayInAxes& TopLevelView::turned(uint32_t axes, const TraceRay& ray) const {
    Turned& held = turned_[axes % kKept];
    if (held.axes != axes) held = {RayInAxes(axes_sets_[axes], ray), axes};
    return held.ray;
}

/// Whether the ray may hit something in a node; the visit is set in any case, so that nothing branches on it.
inline bool TopLevelView::meet(size_t index, const TraceRay& ray, Visit& visit) const {
    const TopLevel::Node& node = tree_.nodes[index];
    const KeyBox* from = tree_.boxes_of(index) + segment_.index;
    const KeyBox* to = tree_.key_count > 1 ? from + 1 : from;
    const float rounding = ray.rounding(node.absolute_max);
    const DepthInterval inside =
        !tree_.oriented ? clip(along_axes_, *from, *to, segment_.local, rounding)
        : tree_.keeps_turned_rays
            ? clip(turned(node.axes, ray), *from, *to, segment_.local, rounding)
            : clip(RayInAxes(axes_sets_[node.axes], ray), *from, *to, segment_.local, rounding);
    visit.node = node.link.value;
    return inside.meets(ray, node.quad_extent + rounding, visit.depth);
}

Visits TopLevelView::enter(const TraceRay& ray) const {
    return enter_paired(tree_.nodes.size(),
                        [&](size_t node, Visit& visit) { return meet(node, ray, visit); });
}

Visits TopLevelView::step(const Visit& at, const TraceRay& ray) const {
    // A visit names a link, and that of an inner node is its number as it is.
    return step_paired(at.node, [&](size_t node, Visit& visit) { return meet(node, ray, visit); });
}

}  // namespace trapeze
