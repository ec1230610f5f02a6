/// The way of a single ray through a tree, with a stack of what it may meet. Its origin and slopes may be
/// any: boxes grow by the ray's own rounding when they are tested. Compiled once a target; the best one that
/// the machine has is chosen at each call.
#include "accel/wide/single_ray.h"

#include <array>
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
    void block() {}
};
struct CountAll {
    SingleRayCounts& counts;
    void node() { ++counts.nodes; }
    void grid() { ++counts.grids; }
    void block() { ++counts.blocks; }
};

/// What a ray may still meet: a node, a grid, or a box of the grid at hand; not in front of `depth`.
struct Ahead {
    float depth;
    uint32_t link;
};

/// A list of what is ahead, of which the last comes next.
class AheadStack {
  public:
    static constexpr size_t kRoom = 256;

    size_t size() const { return size_; }
    bool has_room() const { return size_ + WideNode::kChildren <= kRoom; }
    Ahead pop() { return at_[--size_]; }
    /// kSorted: what has been pushed since the size was `from` stays in order, the nearest last.
    template <bool kSorted>
    void push(size_t from, Ahead ahead) {
        size_t place = size_++;
        if constexpr (kSorted)
            for (; place > from && at_[place - 1].depth < ahead.depth; --place) at_[place] = at_[place - 1];
        at_[place] = ahead;
    }

  private:
    size_t size_ = 0;
    std::array<Ahead, kRoom> at_;
};

}  // namespace trapeze::single_ray_detail
#endif

#include "accel/wide/bfloat16-inl.h"
#include "accel/wide/whole_block-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using namespace single_ray_detail;

/// A ray against planes of one orientation: it is at the plane p of axis k at depth p * inverse[k] - enter[k]
/// or leave[k], for planes where it comes into boxes grown by `pad`, and where it goes out.
struct SlabRay {
    float inverse[3], enter[3], leave[3];
    bool backward[3];  ///< it comes in through high planes

    SlabRay(const float* origin, const float* direction, float pad) {
        for (int k = 0; k < 3; ++k) {
            const float along = std::abs(direction[k]) < kLeastDirection ? kLeastDirection : direction[k];
            inverse[k] = 1.0f / along;
            backward[k] = along < 0;
            const float at = origin[k] * inverse[k], grown = pad * std::abs(inverse[k]);
            enter[k] = at + grown, leave[k] = at - grown;
        }
    }
};

/// The boxes of a grid at the ray's time, in its frame: a plane of code c is at first + step[0] * c, and
/// where the grid moves, + step[1] times its code at the segment's end.
template <bool kMoves>
struct CodedBoxes {
    const uint8_t* codes[2];
    size_t count;
    float first[3], step[2][3];

    CodedBoxes(const WideTree& tree, const WideGrid& grid, MotionSegment segment)
        : count(static_cast<size_t>(grid.box_count())) {
        const GridKeys keys(grid, tree.keys_of(grid));
        codes[0] = keys.box_codes(segment.index);
        const KeyBounds at = keys.framed(segment.index);
        for (int k = 0; k < 3; ++k) {
            const CodeScale scale(at.low[k], at.high[k]);
            first[k] = scale.low, step[0][k] = scale.step;
        }
        if constexpr (kMoves) {
            codes[1] = keys.box_codes(segment.index + 1);
            const KeyBounds end = keys.framed(segment.index + 1);
            for (int k = 0; k < 3; ++k) {
                const CodeScale scale(end.low[k], end.high[k]);
                first[k] += segment.local * (scale.low - first[k]);
                step[0][k] *= 1 - segment.local, step[1][k] = scale.step * segment.local;
            }
        }
    }
    /// The codes of a row, from box number `box` on, as floats. What is past the last box means nothing.
    HWY_INLINE VF row(int end, size_t number, size_t box) const {
        const F32 d;
        const hn::Rebind<uint8_t, F32> d8;
        return hn::ConvertTo(d, hn::PromoteTo(I32(), hn::LoadU(d8, codes[end] + number * count + box)));
    }
};

/// A ray on its way. kMoves: something in the tree moves.
template <bool kMoves, class Policy, class Counts>
class SingleRay {
  public:
    SingleRay(const Query& query, Policy& policy, Counts counts)
        : tree_(query.tree),
          ray_(query.ray),
          policy_(policy),
          counts_(counts),
          pad_(ray_.rounding(tree_.absolute_max())),
          slack_(tree_.max_extent() + pad_),
          slab_(&ray_.origin.x, &ray_.direction.x, pad_) {
        block_ray_.axis = ray_.axis;
        for (int k = 0; k < 3; ++k) block_ray_.planes[k] = ray_.planes[k];
    }

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
    static constexpr bool kSorted = !std::is_same_v<Policy, AnyHit>;

    /// The policy wants no more.
    bool ended() const { return ray_.t_max == -HUGE_VALF; }
    /// No box entered beyond this depth matters, nor one left before the other.
    float farthest() const { return ray_.t_max + slack_; }
    float nearest() const { return ray_.t_min - slack_; }

    /// A node and all below it.
    void descend(uint32_t node) {
        AheadStack stack;
        stack.push<false>(0, {nearest(), node});
        while (stack.size() > 0) {
            const Ahead at = stack.pop();
            if (at.depth > farthest()) continue;
            if (at.link & kGridLink)
                visit_grid(at.link & ~kGridLink, stack);
            else if (stack.has_room())
                visit_node(at.link, stack);
            else
                descend(at.link);  // trees are not so deep, but where grids are of very different sizes
            if (ended()) return;
        }
    }

    /// Pushes `count` things, those of a vector of boxes that the ray meets: `near` and `far` are the depths
    /// between which it is inside. link(lane) says what they are.
    template <class Link>
    HWY_INLINE void push_met(AheadStack& stack, size_t from, VF near, VF far, uint32_t some,
                             const Link& link) const {
        const F32 d;
        // Not `near <= far`: what is no number makes no bound.
        uint32_t met = mask_bits(d, hn::Not(hn::Gt(near, far))) & some;
        if (met == 0) return;
        HWY_ALIGN float depths[kLanes];
        hn::Store(near, d, depths);
        for (; met != 0; met &= met - 1) {
            const auto lane = static_cast<size_t>(std::countr_zero(met));
            stack.push<kSorted>(from, {depths[lane], link(lane)});
        }
    }

    HWY_INLINE void visit_node(uint32_t index, AheadStack& stack) {
        const F32 d;
        counts_.node();
        const WideNode& node = tree_.nodes()[index];
        const size_t from = stack.size();
        for (size_t i = 0; i < WideNode::kChildren; i += kLanes) {
            VF near = hn::Set(d, nearest()), far = hn::Set(d, farthest());
            for (size_t k = 0; k < 3; ++k) {
                const bool back = slab_.backward[k];
                VF in = hn::Load(d, (back ? node.high : node.low)[k] + i),
                   out = hn::Load(d, (back ? node.low : node.high)[k] + i);
                if constexpr (kMoves) {
                    const WideNodeMotion& motion = tree_.node_motions()[index];
                    const VF time = hn::Set(d, ray_.axis.time);
                    in = hn::MulAdd(time, from_bfloat16(d, (back ? motion.high : motion.low)[k] + i), in);
                    out = hn::MulAdd(time, from_bfloat16(d, (back ? motion.low : motion.high)[k] + i), out);
                }
                const VF inverse = hn::Set(d, slab_.inverse[k]);
                near = hn::Max(near, hn::MulSub(in, inverse, hn::Set(d, slab_.enter[k])));
                far = hn::Min(far, hn::MulSub(out, inverse, hn::Set(d, slab_.leave[k])));
            }
            const hn::RebindToUnsigned<F32> du;
            const uint32_t there = mask_bits(du, hn::Ne(hn::Load(du, node.child + i), hn::Set(du, kNoLink)));
            push_met(stack, from, near, far, there, [&](size_t lane) { return node.child[i + lane]; });
        }
    }

    void visit_grid(uint32_t index, AheadStack& stack) {
        const WideGrid& grid = tree_.grid(index);
        if (kMoves && grid.moves())
            visit_boxes<true>(index, grid, stack);
        else
            visit_boxes<false>(index, grid, stack);
    }

    /// The ray in the grid's frame against all of its boxes at the ray's time, then against the
    /// micropolygons of those that it meets.
    template <bool kGridMoves>
    HWY_INLINE void visit_boxes(uint32_t index, const WideGrid& grid, AheadStack& stack) {
        const F32 d;
        counts_.grid();
        const MotionSegment segment = start_grid(grid);
        const CodedBoxes<kGridMoves> boxes(tree_, grid, segment);
        const FrameAxes axes = grid.axes.unpacked();
        float origin[3], direction[3];
        for (int k = 0; k < 3; ++k) {
            const float* a = axes.axis[k];
            // From the corner that codes count from: `first` then is at no distance.
            origin[k] = (a[0] * ray_.origin.x + a[1] * ray_.origin.y + a[2] * ray_.origin.z) - boxes.first[k];
            direction[k] = a[0] * ray_.direction.x + a[1] * ray_.direction.y + a[2] * ray_.direction.z;
        }
        const SlabRay slab(origin, direction, pad_);
        float per_code[2][3];
        for (int k = 0; k < 3; ++k)
            for (int end = 0; end < (kGridMoves ? 2 : 1); ++end)
                per_code[end][k] = boxes.step[end][k] * slab.inverse[k];
        const size_t from = stack.size();
        for (size_t b = 0; b < boxes.count; b += kLanes) {
            VF near = hn::Set(d, nearest()), far = hn::Set(d, farthest());
            for (size_t k = 0; k < 3; ++k) {
                const size_t in_row = slab.backward[k] ? k + 3 : k, out_row = slab.backward[k] ? k : k + 3;
                const VF step = hn::Set(d, per_code[0][k]);
                VF in = hn::MulSub(boxes.row(0, in_row, b), step, hn::Set(d, slab.enter[k])),
                   out = hn::MulSub(boxes.row(0, out_row, b), step, hn::Set(d, slab.leave[k]));
                if constexpr (kGridMoves) {
                    const VF end_step = hn::Set(d, per_code[1][k]);
                    in = hn::MulAdd(boxes.row(1, in_row, b), end_step, in);
                    out = hn::MulAdd(boxes.row(1, out_row, b), end_step, out);
                }
                near = hn::Max(near, in), far = hn::Min(far, out);
            }
            const size_t left = boxes.count - b;
            push_met(stack, from, near, far, left < kLanes ? (1u << left) - 1 : ~0u,
                     [&](size_t lane) { return static_cast<uint32_t>(b + lane); });
        }
        while (stack.size() > from) {
            const Ahead at = stack.pop();
            if (at.depth > farthest()) continue;
            const int first = static_cast<int>(at.link) * grid.blocks_per_box(),
                      last = std::min(first + grid.blocks_per_box(), grid.block_count());
            for (int block = first; block < last; ++block) visit_block(index, grid, segment.index, block);
        }
    }

    /// Where the ray is in the grid's motion.
    MotionSegment start_grid(const WideGrid& grid) {
        const MotionSegment segment = segment_at(ray_.axis.time, grid.key_count);
        block_ray_.local = segment.local;
        return segment;
    }

    HWY_INLINE void visit_block(uint32_t index, const WideGrid& grid, int segment, int number) {
        const Block block =
            block_of(grid, segment, number % grid.blocks_u(), number / grid.blocks_u(), index);
        if (kMoves && grid.moves())
            test_block<true>(block);
        else
            test_block<false>(block);
    }

    template <bool kGridMoves>
    HWY_INLINE void test_block(const Block& block) {
        const F32 d;
        counts_.block();
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
                const auto uv = static_cast<uint32_t>((micropolygon & 3) | micropolygon >> 2 << 4);
                policy_.consider({depth, block.id + uv}, block.opaque, ray_);
            }
        }
    }

    const WideTree& tree_;
    TraceRay& ray_;
    Policy& policy_;
    Counts counts_;
    float pad_, slack_;
    SlabRay slab_;
    BlockRay block_ray_;
};

template <class Policy, class Counts>
HWY_INLINE Policy traced(const Query& query, Counts counts) {
    Policy policy;
    if (query.tree.moves())
        SingleRay<true, Policy, Counts>(query, policy, counts).run();
    else
        SingleRay<false, Policy, Counts>(query, policy, counts).run();
    return policy;
}

ClosestHit trace_closest(const Query& query, SingleRayCounts* counts) {
    return counts ? traced<ClosestHit>(query, CountAll{*counts}) : traced<ClosestHit>(query, CountNothing());
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

/// A ray with a part that is no number has no bounds, and hits nothing.
bool has_numbers(const TraceRay& ray) {
    const AxisRay& a = ray.axis;
    return !std::isnan(a.ux) && !std::isnan(a.uy) && !std::isnan(a.ox) && !std::isnan(a.oy) &&
           !std::isnan(a.oz) && !std::isnan(a.time);
}

}  // namespace

std::optional<Hit> closest_hit(const WideTree& tree, const SpaceRay& ray, DepthRange range,
                               SingleRayCounts* counts) {
    TraceRay trace_ray = TraceRay::turned(axis_ray(ray), range);
    if (!has_numbers(trace_ray)) return {};
    const ClosestHit hit = HWY_DYNAMIC_DISPATCH(trace_closest)({tree, trace_ray}, counts);
    if (!hit.found()) return {};
    return hit.best;
}

bool any_hit(const WideTree& tree, const SpaceRay& ray, DepthRange range, SingleRayCounts* counts) {
    TraceRay trace_ray = TraceRay::turned(axis_ray(ray), range);
    if (!has_numbers(trace_ray)) return false;
    return HWY_DYNAMIC_DISPATCH(trace_any)({tree, trace_ray}, counts).found;
}

}  // namespace trapeze
#endif  // HWY_ONCE
