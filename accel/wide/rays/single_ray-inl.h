/// The way of a single ray through a tree, with a stack of what it may meet. Its origin and slopes may be
/// any: boxes grow by the ray's own rounding when they are tested. Compiled once a target.
#if defined(TRAPEZE_ACCEL_SINGLE_RAY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRAPEZE_ACCEL_SINGLE_RAY_INL_H_
#undef TRAPEZE_ACCEL_SINGLE_RAY_INL_H_
#else
#define TRAPEZE_ACCEL_SINGLE_RAY_INL_H_
#endif

#include <hwy/highway.h>

#include <bit>
#include <cmath>
#include <type_traits>

#include "accel/grid_block.h"
#include "accel/hit_policies.h"
#include "accel/trace_ray.h"
#include "accel/wide/compact_lanes-inl.h"
#include "accel/wide/rays/grid_list.h"
#include "accel/wide/rays/ray_slabs-inl.h"
#include "accel/wide/whole_block-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Where numbers of blocks are divided by blocks along u: up to 16 by up to 4, as n * kSixtyFourths >> 6.
inline constexpr int kSixtyFourths[] = {0, 64, 32, 22, 16};

/// What a ray may still meet, of which the last comes next: links, or numbers of boxes, and where kDepths,
/// the depths before which nothing in them is hit.
template <bool kDepths, size_t kRoom>
class AheadStack {
  public:
    size_t size() const { return size_; }
    /// For all children of one more node.
    bool has_room() const { return size_ + WideNode::kChildren <= kRoom; }
    uint32_t link() const { return links_[size_ - 1]; }
    float depth() const { return depths_[size_ - 1]; }
    void pop() { --size_; }
    /// Pushes some lanes.
    HWY_INLINE void push(MF some, VF depths, CompactLanes::VU links) {
        const CompactLanes compact(some);
        compact.store(links, links_ + size_);
        if constexpr (kDepths) compact.store(depths, depths_ + size_);
        size_ += static_cast<size_t>(std::popcount(mask_bits(F32(), some)));
    }
    /// Puts what has been pushed since the size was `from` in order, the nearest last. By insertion: there
    /// are 16 at most.
    HWY_INLINE void sort(size_t from) {
        for (size_t i = from + 1; i < size_; ++i) {
            const float depth = depths_[i];
            const uint32_t link = links_[i];
            size_t place = i;
            for (; place > from && depths_[place - 1] < depth; --place)
                depths_[place] = depths_[place - 1], links_[place] = links_[place - 1];
            depths_[place] = depth, links_[place] = link;
        }
    }

  private:
    size_t size_ = 0;
    // Whole vectors are written.
    alignas(64) float depths_[kRoom + kLanes];
    alignas(64) uint32_t links_[kRoom + kLanes];
};

/// For rays that nobody counts.
struct CountNothing {
    void node() {}
    void grid() {}
    void block(int) {}
};

/// A ray on its way. kMotion: something in the tree moves.
template <bool kMotion, class Policy, class Counts>
class SingleRay {
  public:
    SingleRay(const WideTree& tree, TraceRay& ray, Policy& policy, Counts counts)
        : tree_(tree), ray_(ray), policy_(policy), counts_(counts), slabs_(ray_) {
        block_ray_.axis = ray_.axis;
        for (int k = 0; k < 3; ++k) block_ray_.planes[k] = ray_.planes[k];
    }

    /// What has no bounds comes first: a hit there shortens the way through the tree.
    void run() {
        visit_unbounded();
        if (tree_.node_count() > 0 && !ended()) descend(0);
    }

    /// The policy wants no more.
    bool ended() const { return ray_.t_max == -HUGE_VALF; }

    void visit_unbounded() {
        for (const uint32_t index : tree_.unbounded_grids()) {
            const WideGrid& grid = tree_.grid(index);
            const int segment = start_grid(grid).index;
            for (int b = 0; b < grid.block_count() && !ended(); ++b) visit_block(index, grid, segment, b);
        }
    }

    /// A node and all below it.
    void descend(uint32_t link) {
        Stack stack;
        while (link != kNoLink) {
            if (link & kGridLink) {
                visit_grid(link & ~kGridLink);
                if (ended()) return;
                link = next_of(stack);
            } else if (stack.has_room()) {
                link = visit_node(link, stack);
            } else {  // trees are not so deep, but where grids are of very different sizes
                descend(link);
                if (ended()) return;
                link = next_of(stack);
            }
        }
    }

    /// Which children the ray may meet, a bit each.
    HWY_INLINE uint32_t met_children(const ChildRows& rows) const {
        uint32_t bits = 0;
        for (size_t i = 0; i < WideNode::kChildren; i += kLanes)
            bits |= mask_bits(F32(), meet(rows, i).some) << i;
        return bits;
    }

    /// Which places of each part of a list the ray may meet, a bit each; adds them to those that `any` has.
    HWY_INLINE void meet_list(const GridList& list, uint16_t* met, uint16_t* any) const {
        const size_t parts = list.parts();
        for (size_t n = 0; n < parts; ++n) {
            const uint32_t bits = met_children(list.part(n));
            met[n] = static_cast<uint16_t>(bits);
            any[n] |= static_cast<uint16_t>(bits);
        }
    }

    /// Which boxes of a grid the ray may meet, a bit each, and where it is in the grid's motion then.
    HWY_INLINE uint32_t met_boxes(const WideGrid& grid, MotionSegment& segment) {
        return kMotion && grid.moves() ? met_boxes_of<true>(grid, segment)
                                       : met_boxes_of<false>(grid, segment);
    }
    /// The micropolygons of some boxes.
    HWY_INLINE void visit_boxes(uint32_t index, const WideGrid& grid, const MotionSegment& segment,
                                uint32_t boxes) {
        block_ray_.local = segment.local;
        for (; boxes != 0 && !ended(); boxes &= boxes - 1)
            for_blocks(grid, std::countr_zero(boxes),
                       [&](int block) HWY_ATTR { visit_block(index, grid, segment.index, block); });
    }
    /// Fetches the vertices of some boxes.
    HWY_INLINE static void fetch_boxes(uint32_t index, const WideGrid& grid, const MotionSegment& segment,
                                       uint32_t boxes) {
        for (; boxes != 0; boxes &= boxes - 1)
            for_blocks(grid, std::countr_zero(boxes), [&](int number) HWY_ATTR {
                const int v = number * kSixtyFourths[grid.blocks_u()] >> 6;
                fetch_block(block_of(grid, segment.index, number - v * grid.blocks_u(), v, index),
                            kMotion && grid.moves() ? 6 : 3);
            });
    }

  private:
    /// Closest hits are sooner found from near to far; any hit is as good as another.
    static constexpr bool kSorted = std::is_same_v<Policy, ClosestHit> || std::is_same_v<Policy, NearestHits>;
    using Stack = AheadStack<kSorted, 256>;
    using BoxStack = AheadStack<kSorted, BoxPlanes::kMost>;
    using VU = CompactLanes::VU;

    /// Takes what comes next from the stack; kNoLink where nothing is left.
    HWY_INLINE uint32_t next_of(Stack& stack) const {
        while (stack.size() > 0) {
            const uint32_t link = stack.link();
            const bool passed = kSorted && stack.depth() > ray_.t_max;
            stack.pop();
            if (!passed) return link;
        }
        return kNoLink;
    }

    /// Lanes of a node's children that the ray may meet, and of the depths at which it comes into their
    /// boxes.
    struct MetLanes {
        MF some;
        VF near;
    };
    HWY_INLINE MetLanes meet(const ChildRows& rows, size_t first) const {
        const F32 d;
        const hn::RebindToUnsigned<F32> du;
        const float pad = ray_.rounding(rows.largest.coordinate),
                    slack = rows.largest.extent[ray_.planes[2]] + pad;
        Inside inside(ray_.t_min - slack, ray_.t_max + slack);
        slabs_.cut<kMotion>(rows, first, ray_.axis.time, pad, inside);
        const MF there = hn::RebindMask(d, hn::Ne(hn::Load(du, rows.links + first), hn::Set(du, kNoLink)));
        return {hn::AndNot(inside.missed(), there), hn::Sub(inside.near, hn::Set(d, slack))};
    }

    /// Tests a node's children, pushes those that the ray may meet but the one that comes next, and tells
    /// that or what else comes next.
    HWY_INLINE uint32_t visit_node(uint32_t index, Stack& stack) {
        const hn::RebindToUnsigned<F32> du;
        counts_.node();
        const ChildRows rows = tree_.children_of(index);
        const size_t from = stack.size();
        // To the next step by the shortest way: the child is read where it is, not where it is pushed.
        uint32_t last = kNoLink;
        for (size_t i = 0; i < WideNode::kChildren; i += kLanes) {
            const MetLanes met = meet(rows, i);
            stack.push(met.some, met.near, hn::Load(du, rows.links + i));
            if (const uint32_t bits = mask_bits(F32(), met.some))
                last = rows.links[i + 31 - static_cast<size_t>(std::countl_zero(bits))];
        }
        const size_t count = stack.size() - from;
        if (count == 0) return next_of(stack);
        if (kSorted && count > 1) {
            stack.sort(from);
            return next_of(stack);
        }
        stack.pop();
        return last;
    }

    HWY_INLINE void visit_grid(uint32_t index) {
        const WideGrid& grid = tree_.grid(index);
        if (kMotion && grid.moves())
            visit_boxes<true>(index, grid);
        else
            visit_boxes<false>(index, grid);
    }

    /// The ray in the grid's axes against all of its boxes at the ray's time, then against the
    /// micropolygons of those that it meets.
    template <bool kGridMoves>
    HWY_INLINE void visit_boxes(uint32_t index, const WideGrid& grid) {
        const F32 d;
        counts_.grid();
        const float pad = ray_.rounding(grid.largest_coordinate()),
                    slack = grid.largest_extent(ray_.planes[2]) + pad;
        const MotionSegment segment = kGridMoves ? start_grid(grid) : MotionSegment{};
        const GridSlabs<kGridMoves> slabs(tree_, grid, segment, ray_, pad);
        BoxStack boxes;
        for (size_t b = 0; b < slabs.count(); b += kLanes) {
            Inside inside(ray_.t_min - slack, ray_.t_max + slack);
            slabs.cut(b, inside);
            const hn::RebindToUnsigned<F32> du;
            boxes.push(hn::AndNot(inside.missed(), hn::FirstN(d, slabs.count() - b)),
                       hn::Sub(inside.near, hn::Set(d, slack)), lane_numbers(du, static_cast<uint32_t>(b)));
        }
        if constexpr (kSorted) boxes.sort(0);
        for (; boxes.size() > 0 && !ended(); boxes.pop()) {
            if (kSorted && boxes.depth() > ray_.t_max) return;
            for_blocks(grid, static_cast<int>(boxes.link()), [&](int block) HWY_ATTR {
                visit_block<kGridMoves>(index, grid, segment.index, block);
            });
        }
    }

    template <bool kGridMoves>
    HWY_INLINE uint32_t met_boxes_of(const WideGrid& grid, MotionSegment& segment) {
        counts_.grid();
        const float pad = ray_.rounding(grid.largest_coordinate()),
                    slack = grid.largest_extent(ray_.planes[2]) + pad;
        segment = kGridMoves ? start_grid(grid) : MotionSegment{};
        const GridSlabs<kGridMoves> slabs(tree_, grid, segment, ray_, pad);
        uint32_t bits = 0;
        for (size_t b = 0; b < slabs.count(); b += kLanes) {
            Inside inside(ray_.t_min - slack, ray_.t_max + slack);
            slabs.cut(b, inside);
            const MF there = hn::FirstN(F32(), slabs.count() - b);
            bits |= mask_bits(F32(), hn::AndNot(inside.missed(), there)) << b;
        }
        return bits;
    }

    /// Calls visit(number) for the blocks of a box.
    template <class Visit>
    static HWY_INLINE void for_blocks(const WideGrid& grid, int box, const Visit& visit) {
        const int first = box * grid.blocks_per_box(),
                  last = std::min(first + grid.blocks_per_box(), grid.block_count());
        for (int block = first; block < last; ++block) visit(block);
    }

    /// Where the ray is in a grid's motion. Not by segment_at(): to call code for any machine from AVX-512
    /// code takes as long as the test of a grid.
    HWY_INLINE MotionSegment start_grid(const WideGrid& grid) {
        const hn::CappedTag<float, 1> d;
        const auto lane = segments_at(d, hn::Set(d, ray_.axis.time), grid.key_count);
        block_ray_.local = hn::GetLane(lane.local);
        return {hn::GetLane(lane.index), block_ray_.local};
    }

    HWY_INLINE void visit_block(uint32_t index, const WideGrid& grid, int segment, int number) {
        if (kMotion && grid.moves())
            visit_block<true>(index, grid, segment, number);
        else
            visit_block<false>(index, grid, segment, number);
    }

    /// Block `number` of a grid, counted row by row of blocks: its micropolygons, as many at once as there
    /// are lanes.
    template <bool kGridMoves>
    HWY_INLINE void visit_block(uint32_t index, const WideGrid& grid, int segment, int number) {
        const F32 d;
        const int blocks_u = grid.blocks_u(), v = number * kSixtyFourths[blocks_u] >> 6;
        const SegmentBlock block = block_of(grid, segment, number - v * blocks_u, v, index);
        counts_.block(block.view.rows * block.columns);
        const Facing facing = facing_along(block.facing, ray_.sign);
        for (int m = 0; m < 4 * block.view.rows; m += static_cast<int>(kLanes)) {
            VF z = hn::Zero(d);
            uint32_t hits =
                hit_micropolygons<kGridMoves>(block.view, block.columns, facing, m, block_ray_, z);
            if (hits == 0) continue;
            HWY_ALIGN float depths[kLanes];
            hn::Store(z, d, depths);
            for (; hits != 0; hits &= hits - 1) {
                const int lane = std::countr_zero(hits), micropolygon = m + lane;
                const float depth = ray_.depth_of(depths[lane]);
                if (!(depth >= ray_.t_min && depth <= ray_.t_max)) continue;
                // u and v within the block, four bits each as in MicropolygonId::packed().
                const auto uv = static_cast<uint32_t>((micropolygon & 3) | micropolygon >> 2 << 4);
                policy_.consider({depth, block.id + uv}, block.opaque, ray_);
            }
        }
    }

    const WideTree& tree_;
    TraceRay& ray_;
    Policy& policy_;
    Counts counts_;
    NodeSlabs slabs_;
    BlockRay block_ray_;
};

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
