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

    /// Calls see(number) for each thing within which there may be a hit in the ray's range; it may draw the
    /// range in (t_max), and things behind it are left out from then on.
    template <class See>
    void visit(TraceRay& ray, const See& see) const {
        for (const uint32_t number : unbounded_) see(number);
        if (nodes_.empty()) return;
        const float pad = ray.rounding(absolute_max_);
        visit_node(0, {FrameRay(ray), pad, extent_ + pad}, ray, see);
    }

    size_t bytes() const {
        return sizeof(*this) + nodes_.capacity() * sizeof(WideChildren) + unbounded_.capacity() * 4;
    }

  private:
    struct Met {
        float depth;
        uint32_t link;
    };
    /// What bounds are grown by for a ray, and how far outside of them hits may be.
    struct Reach {
        FrameRay ray;
        float pad, slack;
    };

    template <class See>
    void visit_node(uint32_t number, const Reach& reach, TraceRay& ray, const See& see) const {
        const WideChildren& node = nodes_[number];
        std::array<Met, WideNode::kChildren> met;
        int count = 0;
        for (int i = 0; i < node.count; ++i) {
            const EndBoxes& box = node.child[i].box;
            float depth;
            if (clip(reach.ray, key_box(box.at[0]), key_box(box.at[1]), ray.axis.time, reach.pad)
                    .meets(ray, reach.slack, depth))
                met[count++] = {depth, node.child[i].link};
        }
        std::sort(met.begin(), met.begin() + count,
                  [](const Met& a, const Met& b) { return a.depth < b.depth; });
        for (int i = 0; i < count && !(met[i].depth > ray.t_max); ++i) {
            if (met[i].link & kGridLink)
                see(met[i].link & ~kGridLink);
            else
                visit_node(met[i].link, reach, ray, see);
        }
    }

    static KeyBox key_box(const KeyBounds& bounds) {
        KeyBox box;
        for (int k = 0; k < 3; ++k) box.low[k] = bounds.low[k], box.high[k] = bounds.high[k];
        return box;
    }

    std::vector<WideChildren> nodes_;
    std::vector<uint32_t> unbounded_;
    float absolute_max_ = 0, extent_ = 0;
};

/// The extent of a grid alone, for rays in any direction.
GridExtent extent_of(const Grid& grid);
/// What holds both.
GridExtent united(const GridExtent& a, const GridExtent& b);

}  // namespace trapeze
