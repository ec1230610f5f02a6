/// A tree over the extents of things that are not in memory: finds those that a ray may meet, nearest first,
/// so that only they have to be made.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <span>
#include <vector>

#include "accel/slabs.h"
#include "accel/wide/wide_grids.h"
#include "accel/wide/wide_top.h"

namespace trapeze {

/// 16 children, lane by lane; those that are there come first.
struct alignas(64) ExtentNode {
    static constexpr int kChildren = WideNode::kChildren;
    float low[3][kChildren] = {}, high[3][kChildren] = {};              ///< at shutter open
    float low_delta[3][kChildren] = {}, high_delta[3][kChildren] = {};  ///< to shutter close
    /// Of all below a child: the largest |coordinate|, which says how much its bounds are grown for a ray,
    /// and the largest extent of a micropolygon, which says how far outside of them hits may be. A sky far
    /// away must not let a ray visit what is near.
    float coordinate[kChildren] = {}, extent[kChildren] = {};
    uint32_t link[kChildren] = {};
    uint32_t count = 0;
};

/// Which children a ray may meet, a bit for each, and lower bounds of the depths of hits within them; `moves`
/// false: deltas are 0. As clip() and DepthInterval::meets() for each.
uint32_t children_met(const ExtentNode& node, bool moves, const RayInAxes& ray_in_axes, const TraceRay& ray,
                      float* depths);

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
        if (!nodes_.empty()) visit_node(0, RayInAxes(ray), ray, see);
    }

    size_t bytes() const {
        return sizeof(*this) + nodes_.capacity() * sizeof(ExtentNode) + unbounded_.capacity() * 4;
    }

  private:
    struct Met {
        float depth;
        uint32_t link;
    };

    /// Children are sorted by depth, for a thing that is seen may have to be made, beside which sorting is
    /// nothing. Each is compared with the range again when its turn comes.
    template <class See>
    void visit_node(uint32_t number, const RayInAxes& ray_in_axes, TraceRay& ray, const See& see) const {
        const ExtentNode& node = nodes_[number];
        alignas(64) float depths[ExtentNode::kChildren];
        std::array<Met, ExtentNode::kChildren> met;
        int count = 0;
        for (uint32_t bits = children_met(node, moves_, ray_in_axes, ray, depths); bits != 0;
             bits &= bits - 1) {
            const int i = std::countr_zero(bits);
            met[count++] = {depths[i], node.link[i]};
        }
        std::sort(met.begin(), met.begin() + count,
                  [](const Met& a, const Met& b) { return a.depth < b.depth; });
        for (int i = 0; i < count && !(met[i].depth > ray.t_max); ++i) {
            if (met[i].link & kGridLink)
                see(met[i].link & ~kGridLink, met[i].depth);
            else
                visit_node(met[i].link, ray_in_axes, ray, see);
        }
    }

    std::vector<ExtentNode> nodes_;  ///< a node comes before those below it
    std::vector<uint32_t> unbounded_;
    bool moves_ = false;
};

/// The extent of a grid alone, for rays in any direction.
GridExtent extent_of(const Grid& grid);
/// What holds both.
GridExtent united(const GridExtent& a, const GridExtent& b);

}  // namespace trapeze
