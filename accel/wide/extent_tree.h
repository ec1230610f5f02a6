/// A tree over the extents of things that are not in memory: finds those that a ray may meet, nearest first,
/// so that only they have to be made.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "accel/slabs.h"
#include "accel/wide/wide_grids.h"
#include "accel/wide/wide_top.h"

namespace trapeze {

/// Things are known by their numbers, 0 to size - 1. Immutable: threads share it.
class ExtentTree {
  public:
    /// Those whose absolute_max is not finite have no bound: every ray visits them. At most
    /// WideTree::kMaxGrids extents.
    explicit ExtentTree(std::span<const GridExtent> extents);

    /// Calls see(number, depth) for each thing within which there may be a hit in the ray's range, and none
    /// nearer than that depth; it may draw the range in (t_max), and things behind it are left out from then
    /// on.
    template <class See>
    void visit(TraceRay& ray, const See& see) const {
        for (const uint32_t number : unbounded_) see(number, ray.t_min);
        if (!nodes_.empty()) visit_node(0, FrameRay(ray), ray, see);
    }

    size_t bytes() const {
        return sizeof(*this) + nodes_.capacity() * (sizeof(WideChildren) + sizeof(ChildrenLargest)) +
               unbounded_.capacity() * 4;
    }

  private:
    struct Met {
        float depth;
        uint32_t link;
    };
    /// Of all below a child: the largest |coordinate|, which says how much its bounds are grown for a ray,
    /// and the largest extent of a micropolygon, which says how far outside of them hits may be. A sky far
    /// away must not let a ray visit what is near.
    struct Largest {
        float coordinate = 0, extent = 0;
    };
    using ChildrenLargest = std::array<Largest, WideNode::kChildren>;

    /// Children are sorted by depth, for a thing that is seen may have to be made, beside which sorting is
    /// nothing. Each is compared with the range again when its turn comes.
    template <class See>
    void visit_node(uint32_t number, const FrameRay& frame_ray, TraceRay& ray, const See& see) const {
        const WideChildren& node = nodes_[number];
        std::array<Met, WideNode::kChildren> met;
        int count = 0;
        for (int i = 0; i < node.count; ++i) {
            const EndBoxes& box = node.child[i].box;
            const Largest& largest = largest_[number][static_cast<size_t>(i)];
            const float pad = ray.rounding(largest.coordinate);
            float depth;
            if (clip(frame_ray, key_box(box.at[0]), key_box(box.at[1]), ray.axis.time, pad)
                    .meets(ray, largest.extent + pad, depth))
                met[count++] = {depth, node.child[i].link};
        }
        std::sort(met.begin(), met.begin() + count,
                  [](const Met& a, const Met& b) { return a.depth < b.depth; });
        for (int i = 0; i < count && !(met[i].depth > ray.t_max); ++i) {
            if (met[i].link & kGridLink)
                see(met[i].link & ~kGridLink, met[i].depth);
            else
                visit_node(met[i].link, frame_ray, ray, see);
        }
    }

    static KeyBox key_box(const KeyBounds& bounds) {
        KeyBox box;
        for (int k = 0; k < 3; ++k) box.low[k] = bounds.low[k], box.high[k] = bounds.high[k];
        return box;
    }

    std::vector<WideChildren> nodes_;  ///< a node comes before those below it
    std::vector<ChildrenLargest> largest_;
    std::vector<uint32_t> unbounded_;
};

/// The extent of a grid alone, for rays in any direction.
GridExtent extent_of(const Grid& grid);
/// What holds both.
GridExtent united(const GridExtent& a, const GridExtent& b);

}  // namespace trapeze
