/// The way of a single ray through a tree, with a stack of what it may meet. Its origin and slopes may be
/// any: boxes grow by the ray's own rounding when they are tested. Compiled once a target; the best one that
/// the machine has is chosen at each call.
#include "accel/wide/single_ray.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "accel/grid_block.h"
#include "accel/hit_policies.h"
#include "accel/trace_ray.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "accel/wide/single_ray.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target

#ifndef TRAPEZE_ACCEL_SINGLE_RAY_ONCE
#define TRAPEZE_ACCEL_SINGLE_RAY_ONCE
namespace trapeze::single_ray_detail {

/// A ray that asks, and counting policies: nothing, or into SingleRayCounts.
struct Query {
    const WideTree& tree;
    TraceRay& ray;
};
struct CountNothing {
    void node() {}
    void grid() {}
    void block(int) {}
};
struct CountAll {
    SingleRayCounts& counts;
    void node() { ++counts.nodes; }
    void grid() { ++counts.grids; }
    void block(int tests) { ++counts.blocks, counts.tests += static_cast<uint64_t>(tests); }
};

/// Where numbers of blocks are divided by blocks along u: up to 16 by up to 4, as n * kSixtyFourths >> 6.
constexpr int kSixtyFourths[] = {0, 64, 32, 22, 16};

}  // namespace trapeze::single_ray_detail
#endif

#include "accel/wide/compact_lanes-inl.h"
#include "accel/wide/ray_slabs-inl.h"
#include "accel/wide/whole_block-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using namespace single_ray_detail;

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

/// A ray on its way. kMotion: something in the tree moves.
template <bool kMotion, class Policy, class Counts>
class SingleRay {
  public:
    SingleRay(const Query& query, Policy& policy, Counts counts)
        : tree_(query.tree), ray_(query.ray), policy_(policy), counts_(counts), slabs_(ray_) {
        block_ray_.axis = ray_.axis;
        for (int k = 0; k < 3; ++k) block_ray_.planes[k] = ray_.planes[k];
    }

    /// What has no bounds comes first: a hit there shortens the way through the tree.
    void run() {
        for (const uint32_t index : tree_.unbounded_grids()) {
            const WideGrid& grid = tree_.grid(index);
            const int segment = start_grid(grid).index;
            for (int b = 0; b < grid.block_count() && !ended(); ++b) visit_block(index, grid, segment, b);
        }
        if (tree_.node_count() > 0 && !ended()) descend(0);
    }

  private:
    /// Closest hits are sooner found from near to far; any hit is as good as another.
    static constexpr bool kSorted = std::is_same_v<Policy, ClosestHit>;
    using Stack = AheadStack<kSorted, 256>;
    using BoxStack = AheadStack<kSorted, BoxPlanes::kMost>;
    using VU = CompactLanes::VU;

    /// The policy wants no more.
    bool ended() const { return ray_.t_max == -HUGE_VALF; }

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

    /// Tests a node's children, pushes those that the ray may meet but the one that comes next, and tells
    /// that or what else comes next.
    HWY_INLINE uint32_t visit_node(uint32_t index, Stack& stack) {
        const F32 d;
        const hn::RebindToUnsigned<F32> du;
        counts_.node();
        const WideNode& node = tree_.nodes()[index];
        const WideNodeLargest& largest = tree_.node_largest(index);
        const float pad = ray_.rounding(largest.coordinate), slack = largest.extent[ray_.planes[2]] + pad;
        const size_t from = stack.size();
        // To the next step by the shortest way: the child is read where it is, not where it is pushed.
        uint32_t last = kNoLink;
        for (size_t i = 0; i < WideNode::kChildren; i += kLanes) {
            Inside inside(ray_.t_min - slack, ray_.t_max + slack);
            slabs_.cut<kMotion>(tree_, index, i, ray_.axis.time, pad, inside);
            const VU links = hn::Load(du, node.child + i);
            const MF there = hn::RebindMask(d, hn::Ne(links, hn::Set(du, kNoLink)));
            const MF met = hn::AndNot(inside.missed(), there);
            stack.push(met, hn::Sub(inside.near, hn::Set(d, slack)), links);
            if (const uint32_t bits = mask_bits(d, met))
                last = node.child[i + 31 - static_cast<size_t>(std::countl_zero(bits))];
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

    /// The ray in the grid's frame against all of its boxes at the ray's time, then against the
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
            const int first = static_cast<int>(boxes.link()) * grid.blocks_per_box(),
                      last = std::min(first + grid.blocks_per_box(), grid.block_count());
            for (int block = first; block < last; ++block)
                visit_block<kGridMoves>(index, grid, segment.index, block);
        }
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

template <class Policy, class Counts>
HWY_INLINE Policy traced(const Query& query, Counts counts, Policy policy = {}) {
    if (query.tree.moves())
        SingleRay<true, Policy, Counts>(query, policy, counts).run();
    else
        SingleRay<false, Policy, Counts>(query, policy, counts).run();
    return policy;
}

ClosestHit trace_closest(const Query& query, const Hit& from, SingleRayCounts* counts) {
    const ClosestHit policy{.from = from};
    return counts ? traced(query, CountAll{*counts}, policy) : traced(query, CountNothing(), policy);
}
FirstOpaque trace_opaque(const Query& query, float near) {
    return traced(query, CountNothing(), FirstOpaque{.near = near});
}
AnyHit trace_any(const Query& query, SingleRayCounts* counts) {
    return counts ? traced<AnyHit>(query, CountAll{*counts}) : traced<AnyHit>(query, CountNothing());
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trapeze {
namespace {

HWY_EXPORT(trace_closest);
HWY_EXPORT(trace_any);
HWY_EXPORT(trace_opaque);

/// A ray with a part that is no number has no bounds, and hits nothing.
bool has_numbers(const TraceRay& ray) {
    const AxisRay& a = ray.axis;
    return !std::isnan(a.ux) && !std::isnan(a.uy) && !std::isnan(a.ox) && !std::isnan(a.oy) &&
           !std::isnan(a.oz) && !std::isnan(a.time);
}

std::optional<Hit> closest(const WideTree& tree, const SpaceRay& ray, DepthRange range, const Hit& from,
                           SingleRayCounts* counts) {
    TraceRay trace_ray = TraceRay::turned(axis_ray(ray), range);
    if (!has_numbers(trace_ray)) return {};
    const ClosestHit hit = HWY_DYNAMIC_DISPATCH(trace_closest)({tree, trace_ray}, from, counts);
    if (!hit.found()) return {};
    return hit.best;
}

}  // namespace

std::optional<Hit> closest_hit(const WideTree& tree, const SpaceRay& ray, DepthRange range,
                               SingleRayCounts* counts) {
    return closest(tree, ray, range, kFirstHit, counts);
}

std::optional<Hit> closest_hit_from(const WideTree& tree, const SpaceRay& ray, DepthRange range,
                                    const Hit& from) {
    return closest(tree, ray, range, from, nullptr);
}

bool any_hit(const WideTree& tree, const SpaceRay& ray, DepthRange range, SingleRayCounts* counts) {
    TraceRay trace_ray = TraceRay::turned(axis_ray(ray), range);
    if (!has_numbers(trace_ray)) return false;
    return HWY_DYNAMIC_DISPATCH(trace_any)({tree, trace_ray}, counts).found;
}

InTheWay opaque_hit(const WideTree& tree, const SpaceRay& ray, DepthRange range, float near) {
    TraceRay trace_ray = TraceRay::turned(axis_ray(ray), range);
    if (!has_numbers(trace_ray)) return InTheWay::Nothing;
    const FirstOpaque met = HWY_DYNAMIC_DISPATCH(trace_opaque)({tree, trace_ray}, near);
    return met.opaque ? InTheWay::Opaque : met.layers ? InTheWay::Layers : InTheWay::Nothing;
}

}  // namespace trapeze
#endif  // HWY_ONCE
