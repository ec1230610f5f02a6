/// Rays that go alike, as intervals of what they hold: which grids any of them may meet, found once for all.
/// Interval arithmetic (Boulos et al. 2006); lanes are a node's children. Compiled once a target.
///
/// What a ray's own test of a box (accel/wide/rays/ray_slabs-inl.h) lets through this test lets through, too:
/// its bounds of depths are those of the rays, at worst.
#if defined(TRAPEZE_ACCEL_RAY_BEAM_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRAPEZE_ACCEL_RAY_BEAM_INL_H_
#undef TRAPEZE_ACCEL_RAY_BEAM_INL_H_
#else
#define TRAPEZE_ACCEL_RAY_BEAM_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>

#include "accel/trace_ray.h"
#include "accel/wide/bfloat16-inl.h"
#include "accel/wide/compact_lanes-inl.h"
#include "accel/wide/rays/grid_list.h"
#include "accel/wide/rays/ray_slabs-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// kMotion: something in the tree moves.
template <bool kMotion>
class RayBeam {
  public:
    /// Of rays with one main axis and sense, at least one.
    RayBeam(const WideTree& tree, std::span<const TraceRay> rays) : tree_(tree), axis_(rays[0].planes[2]) {
        for (const TraceRay& ray : rays) {
            for (int k = 0; k < 3; ++k) {
                Axis& axis = axes_[k];
                axis.origin[0] = std::min(axis.origin[0], ray.origin[k]);
                axis.origin[1] = std::max(axis.origin[1], ray.origin[k]);
                axis.slope[0] = std::min(axis.slope[0], ray.direction[k]);
                axis.slope[1] = std::max(axis.slope[1], ray.direction[k]);
            }
            time_[0] = std::min(time_[0], ray.axis.time), time_[1] = std::max(time_[1], ray.axis.time);
            t_min_ = std::min(t_min_, ray.t_min), t_max_ = std::max(t_max_, ray.t_max);
            rounding_scale_ = std::max(rounding_scale_, ray.rounding_scale);
            rounding_base_ = std::max(rounding_base_, ray.rounding_base);
        }
        for (Axis& axis : axes_) axis.begin();
    }

    /// Lists what some ray may meet: grids, and where these are too many, nodes in their place.
    void list(GridList& list) {
        list.count = 0;
        list.moves = kMotion;
        open(0, list);
        // The one that waits longest in turn: all parts of the tree are opened alike.
        while (waiting_ > 0 && list.count + waiting_ + 2 * WideNode::kChildren <= GridList::kMost)
            open(node_at(next_place()), list);
        while (waiting_ > 0) append_node(next_place(), list);
        for (size_t n = list.count; n < list.parts() * GridList::kPart; ++n) list.links[n] = kNoLink;
    }

  private:
    /// What rays hold of one axis of space.
    struct Axis {
        float origin[2] = {HUGE_VALF, -HUGE_VALF};
        float slope[2] = {HUGE_VALF, -HUGE_VALF};  ///< way along it for a depth of 1
        bool is_slab = false;  ///< all rays go along it one way: planes are at bounded depths
        bool backward = false;
        float inverse[2] = {0, 0};  ///< of the steepest and of the flattest |slope|

        void begin() {
            backward = slope[1] < 0;
            const float least = backward ? -slope[1] : slope[0], most = backward ? -slope[0] : slope[1];
            is_slab = least > kLeastDirection;
            if (is_slab) inverse[0] = 1 / most, inverse[1] = 1 / least;
        }
    };

    /// Takes those of a node's children that some ray may meet.
    void open(uint32_t node, GridList& list) {
        const F32 d;
        const hn::RebindToUnsigned<F32> du;
        const ChildRows rows = tree_.children_of(node);
        for (size_t i = 0; i < WideNode::kChildren; i += kLanes) {
            const MF met = meets(rows, i);
            if (hn::AllFalse(d, met)) continue;
            const auto links = hn::Load(du, rows.links + i);
            const MF grids = hn::And(met, hn::RebindMask(d, hn::TestBit(links, hn::Set(du, kGridLink))));
            if (!hn::AllFalse(d, grids)) append(rows, i, grids, list);
            for (uint32_t bits = mask_bits(d, hn::AndNot(grids, met)); bits != 0; bits &= bits - 1)
                waiting_nodes_[(first_ + waiting_++) % GridList::kMost] =
                    node * WideNode::kChildren + static_cast<uint32_t>(i) +
                    static_cast<uint32_t>(std::countr_zero(bits));
        }
    }

    /// Lists some lanes of a node's children, which are grids.
    void append(const ChildRows& rows, size_t first, MF some, GridList& list) {
        const F32 d;
        const hn::RebindToUnsigned<F32> du;
        const auto count = static_cast<size_t>(std::popcount(mask_bits(d, some)));
        begin_part_for(rows.largest, list);
        const CompactLanes compact(some);
        for (size_t k = 0; k < 6; ++k)
            compact.store(hn::Load(d, rows.row(k) + first), list.planes[k] + list.count);
        compact.store(hn::Load(du, rows.links + first), list.links + list.count);
        if constexpr (kMotion) {
            size_t to = list.count;
            for (uint32_t bits = mask_bits(d, some); bits != 0; bits &= bits - 1, ++to)
                copy_motion(rows, first + static_cast<size_t>(std::countr_zero(bits)), list, to);
        }
        tell_parts(rows.largest, count, list);
    }

    /// Lists a node itself, child number place % WideNode::kChildren of another one.
    void append_node(uint32_t place, GridList& list) const {
        const ChildRows rows = tree_.children_of(place / WideNode::kChildren);
        const size_t child = place % WideNode::kChildren, to = list.count;
        for (size_t k = 0; k < 6; ++k) list.planes[k][to] = rows.row(k)[child];
        list.links[to] = rows.links[child];
        if constexpr (kMotion) copy_motion(rows, child, list, to);
        tell_parts(rows.largest, 1, list);
    }

    static void copy_motion(const ChildRows& rows, size_t child, GridList& list, size_t to) {
        for (size_t k = 0; k < 6; ++k) list.motions[k][to] = rows.motion(k)[child];
    }

    /// Leaves the rest of a part empty before what lies much farther out or in than what it has: tests of
    /// boxes round as much as the farthest of a part asks for.
    static void begin_part_for(const WideNodeLargest& largest, GridList& list) {
        constexpr float kMuch = 4;
        if (list.count % GridList::kPart == 0) return;
        const float here = list.largest[list.count / GridList::kPart].coordinate;
        if (largest.coordinate <= kMuch * here && here <= kMuch * largest.coordinate) return;
        while (list.count % GridList::kPart != 0) list.links[list.count++] = kNoLink;
    }

    /// Takes `count` places more, and tells their parts what is there.
    static void tell_parts(const WideNodeLargest& largest, size_t count, GridList& list) {
        for (size_t end = list.count + count; list.count < end;) {
            const size_t part = list.count / GridList::kPart;
            WideNodeLargest& all = list.largest[part];
            if (list.count % GridList::kPart == 0) all = {};
            all.coordinate = std::max(all.coordinate, largest.coordinate);
            for (int k = 0; k < 3; ++k) all.extent[k] = std::max(all.extent[k], largest.extent[k]);
            list.count = std::min(end, (part + 1) * GridList::kPart);
        }
    }

    uint32_t node_at(uint32_t place) const {
        return tree_.nodes()[place / WideNode::kChildren].child[place % WideNode::kChildren];
    }

    uint32_t next_place() {
        const uint32_t place = waiting_nodes_[first_];
        first_ = (first_ + 1) % GridList::kMost, --waiting_;
        return place;
    }

    /// Lanes of children from number `first` on that some ray may meet.
    HWY_INLINE MF meets(const ChildRows& rows, size_t first) const {
        const F32 d;
        const hn::RebindToUnsigned<F32> du;
        const float pad = rounding_scale_ * rows.largest.coordinate + rounding_base_,
                    slack = rows.largest.extent[axis_] + pad;
        VF near = hn::Set(d, t_min_ - slack), far = hn::Set(d, t_max_ + slack);
        VF low[3], high[3];
        const VF grown = hn::Set(d, pad);
        for (size_t k = 0; k < 3; ++k) {
            VF l = hn::Load(d, rows.row(k) + first), h = hn::Load(d, rows.row(k + 3) + first);
            if constexpr (kMotion) {
                const VF dl = from_bfloat16(d, rows.motion(k) + first),
                         dh = from_bfloat16(d, rows.motion(k + 3) + first);
                const VF t0 = hn::Set(d, time_[0]), t1 = hn::Set(d, time_[1]);
                l = hn::Min(hn::MulAdd(t0, dl, l), hn::MulAdd(t1, dl, l));
                h = hn::Max(hn::MulAdd(t0, dh, h), hn::MulAdd(t1, dh, h));
            }
            low[k] = hn::Sub(l, grown), high[k] = hn::Add(h, grown);
            const Axis& axis = axes_[k];
            if (!axis.is_slab) continue;
            // From the last origin to the first plane, and from the first to the last.
            const VF origin0 = hn::Set(d, axis.origin[0]), origin1 = hn::Set(d, axis.origin[1]);
            const VF in = axis.backward ? hn::Sub(origin0, high[k]) : hn::Sub(low[k], origin1);
            const VF out = axis.backward ? hn::Sub(origin1, low[k]) : hn::Sub(high[k], origin0);
            const VF steep = hn::Set(d, axis.inverse[0]), flat = hn::Set(d, axis.inverse[1]);
            near = hn::Max(near, hn::Min(hn::Mul(in, steep), hn::Mul(in, flat)));
            far = hn::Min(far, hn::Max(hn::Mul(out, steep), hn::Mul(out, flat)));
        }
        MF met = hn::Le(near, far);
        for (size_t k = 0; k < 3; ++k) {
            const Axis& axis = axes_[k];
            if (axis.is_slab) continue;
            const VF s0 = hn::Set(d, axis.slope[0]), s1 = hn::Set(d, axis.slope[1]);
            const VF least = hn::Min(hn::Min(hn::Mul(s0, near), hn::Mul(s0, far)),
                                     hn::Min(hn::Mul(s1, near), hn::Mul(s1, far))),
                     most = hn::Max(hn::Max(hn::Mul(s0, near), hn::Mul(s0, far)),
                                    hn::Max(hn::Mul(s1, near), hn::Mul(s1, far)));
            met = hn::And(met, hn::Le(hn::Add(hn::Set(d, axis.origin[0]), least), high[k]));
            met = hn::And(met, hn::Ge(hn::Add(hn::Set(d, axis.origin[1]), most), low[k]));
        }
        const MF there = hn::RebindMask(d, hn::Ne(hn::Load(du, rows.links + first), hn::Set(du, kNoLink)));
        return hn::And(met, there);
    }

    const WideTree& tree_;
    const int axis_;
    Axis axes_[3];
    float time_[2] = {1, 0};
    float t_min_ = HUGE_VALF, t_max_ = -HUGE_VALF;
    float rounding_scale_ = 0, rounding_base_ = 0;
    /// A ring of nodes that wait to be opened: node * WideNode::kChildren + child.
    size_t first_ = 0, waiting_ = 0;
    uint32_t waiting_nodes_[GridList::kMost];
};

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
