/// The rays of a bundle that may meet a grid (ActiveRays). Compiled once a target.
#if defined(TRAPEZE_ACCEL_GRID_RAYS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRAPEZE_ACCEL_GRID_RAYS_INL_H_
#undef TRAPEZE_ACCEL_GRID_RAYS_INL_H_
#else
#define TRAPEZE_ACCEL_GRID_RAYS_INL_H_
#endif

#include <hwy/highway.h>

#include <bit>

#include "accel/bundle_state-inl.h"
#include "accel/compact_lanes-inl.h"
#include "accel/ray_intervals-inl.h"
#include "core/lane_numbers-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// segment_at() in lanes: whether a time is in a segment, and where.
HWY_INLINE MF in_segment(VF time, int key_count, int segment, VF& local) {
    const F32 d;
    const I32 di;
    const VF scaled = hn::Mul(time, hn::Set(d, static_cast<float>(key_count - 1)));
    const VI index = hn::Min(hn::Max(hn::ConvertTo(di, scaled), hn::Zero(di)), hn::Set(di, key_count - 2));
    local = hn::Sub(scaled, hn::ConvertTo(d, index));
    return hn::RebindMask(d, hn::Eq(index, hn::Set(di, segment)));
}

/// From times of the shutter to local ones; false where none is in the segment.
HWY_INLINE MF to_segment(int key_count, int segment, Interval& time) {
    const F32 d;
    const VF scale = hn::Set(d, static_cast<float>(key_count - 1)),
             start = hn::Set(d, static_cast<float>(segment));
    const VF low = hn::MulSub(time.low, scale, start), high = hn::MulSub(time.high, scale, start);
    const VF zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    time = {hn::Max(low, zero), hn::Min(high, one)};
    // A little more than the segment, for times round.
    return hn::And(hn::Le(low, hn::Set(d, 1.0f + 0x1p-12f)), hn::Ge(high, hn::Set(d, -0x1p-12f)));
}

/// Those rays that pass through a grid's axis-aligned box no farther than their limits: a third of the work
/// that the oriented box is, and of a packet that is wider than a grid most often no ray is left.
template <bool kMoves, bool kLens>
HWY_INLINE MF in_aligned_box(const MovingBox& box, const RayLanes& r, VF limit) {
    const F32 d;
    const auto plane = [&](const float* at, const float* delta, int k) HWY_ATTR {
        const VF value = hn::Set(d, at[k]);
        return kMoves ? hn::MulAdd(r.local, hn::Set(d, delta[k]), value) : value;
    };
    const VF z0 = plane(box.low, box.low_delta, 2), z1 = hn::Min(plane(box.high, box.high_delta, 2), limit);
    const auto passes = [&](VF o, VF u, int k) HWY_ATTR {
        const VF from = kLens ? hn::MulAdd(u, z0, o) : hn::Mul(u, z0),
                 to = kLens ? hn::MulAdd(u, z1, o) : hn::Mul(u, z1);
        return hn::And(hn::Le(hn::Min(from, to), plane(box.high, box.high_delta, k)),
                       hn::Ge(hn::Max(from, to), plane(box.low, box.low_delta, k)));
    };
    return hn::And(hn::Le(z0, z1), hn::And(passes(r.ox, r.ux, 0), passes(r.oy, r.uy, 1)));
}

/// They are needed once all packets of the bundle have been looked at.
template <bool kMoves>
HWY_INLINE void prefetch_boxes(const BundleState& t, const WideGrid& grid, int segment) {
    constexpr size_t kLine = 64;
    const size_t bytes = grid.key_bytes() * (kMoves ? 2 : 1);
    const uint8_t* keys = GridKeys(grid, t.tree.keys_of(grid)).of_key(segment);
    for (size_t i = 0; i < bytes; i += kLine) __builtin_prefetch(keys + i);
    __builtin_prefetch(keys + bytes - 1);
}

template <bool kMoves, bool kLens>
void collect_packet(BundleState& t, const WideGrid& grid, const MovingBox& box, size_t packet, int segment,
                    float depth) {
    const F32 d;
    const size_t i = packet * kLanes;
    const VF ox = kLens ? hn::Load(d, t.rays.ox + i) : hn::Zero(d),
             oy = kLens ? hn::Load(d, t.rays.oy + i) : hn::Zero(d);
    const VF ux = hn::Load(d, t.rays.ux + i), uy = hn::Load(d, t.rays.uy + i);
    VF local = kMoves ? hn::Load(d, t.rays.time + i) : hn::Zero(d);
    MF met = hn::FirstN(d, kLanes);
    if constexpr (kMoves) {
        if (grid.has_segments()) met = in_segment(local, grid.key_count, segment, local);
    }
    const VF limit = hn::Add(hn::Load(d, t.rays.depth + i), hn::Set(d, grid.slack));
    t.stats.nodes_visited += kLanes;
    if (t.rays.nodes) count_packet(t.rays.nodes, i, 1);
    met = hn::And(met, in_aligned_box<kMoves, kLens>(box, {ox, oy, ux, uy, local}, limit));
    if (hn::AllFalse(d, met)) return;
    const SegmentFrame& frame = t.scratch.frame;
    const MovingBox& framed = frame.box;
    if (!t.scratch.has_frame) {
        t.tree.read_frame(grid, segment, t.scratch.frame);
        t.scratch.has_frame = true;
        prefetch_boxes<kMoves>(t, grid, segment);
    }
    VF inverse[3], offset[3], near = hn::Set(d, depth), far = limit;
    for (int k = 0; k < 3; ++k) {
        const float* axis = frame.axes.axis[k];
        const VF x = hn::Set(d, axis[0]), y = hn::Set(d, axis[1]);
        inverse[k] = reciprocal(hn::MulAdd(x, ux, hn::MulAdd(y, uy, hn::Set(d, axis[2]))));
        offset[k] = kLens ? hn::Mul(hn::MulAdd(x, ox, hn::Mul(y, oy)), inverse[k]) : hn::Zero(d);
        VF low = hn::Set(d, framed.low[k]), high = hn::Set(d, framed.high[k]);
        if constexpr (kMoves) {
            low = hn::MulAdd(local, hn::Set(d, framed.low_delta[k]), low);
            high = hn::MulAdd(local, hn::Set(d, framed.high_delta[k]), high);
        }
        const VF a = hn::MulSub(low, inverse[k], offset[k]), b = hn::MulSub(high, inverse[k], offset[k]);
        near = hn::Max(near, hn::Min(a, b)), far = hn::Min(far, hn::Max(a, b));
    }
    met = hn::And(met, hn::Le(near, far));
    const size_t count = hn::CountTrue(d, met);
    if (count == 0) return;
    ActiveRays& to = t.scratch.active;
    const size_t at = to.count;
    const CompactLanes compact(met);
    if constexpr (kLens) compact.store(ox, to.ox + at), compact.store(oy, to.oy + at);
    compact.store(ux, to.ux + at), compact.store(uy, to.uy + at);
    if constexpr (kMoves) compact.store(local, to.local + at);
    for (int k = 0; k < 3; ++k) {
        compact.store(inverse[k], to.inverse[k] + at);
        if constexpr (kLens) compact.store(offset[k], to.offset[k] + at);
    }
    compact.store(limit, to.limit + at);
    const hn::RebindToUnsigned<F32> du;
    compact.store(lane_numbers(du, static_cast<uint32_t>(i)), to.ray + at);
    to.count += count;
    t.scratch.touched.push_back(static_cast<uint32_t>(packet));
}

/// Packets whose intervals meet the grid's axis-aligned box, then those of their rays that meet its
/// oriented one (and, of a moving grid, look in the segment).
template <bool kMoves, bool kLens>
void collect_active(BundleState& t, const MovingBox& box, const WideGrid& grid, int segment,
                    const Candidate& candidate) {
    const F32 d;
    t.scratch.active.count = 0;
    t.scratch.has_frame = false;
    t.scratch.touched.clear();
    t.for_packets(candidate.groups, [&](size_t p) HWY_ATTR {
        auto q = IntervalLanes::of<kMoves, kLens>(
            [&](int row) HWY_ATTR { return hn::Load(d, t.scratch.intervals.row[row] + p); });
        VF low[3], high[3];
        MF looks = hn::FirstN(d, kLanes);
        if constexpr (kMoves) {
            if (grid.has_segments()) looks = to_segment(grid.key_count, segment, q.time);
        }
        for (int k = 0; k < 3; ++k) {
            low[k] = hn::Set(d, box.low[k]), high[k] = hn::Set(d, box.high[k]);
            if constexpr (kMoves) {
                low[k] = lowest(low[k], hn::Set(d, box.low_delta[k]), q.time);
                high[k] = highest(high[k], hn::Set(d, box.high_delta[k]), q.time);
            }
        }
        looks = hn::And(looks, hn::Ge(hn::Load(d, t.scratch.farthest + p), low[2]));
        uint32_t met = mask_bits(hn::And(
            looks, meets<kLens>(d, q, low, high, hn::Set(d, t.nearest_depth), hn::Set(d, t.inverse_focal))));
        for (; met != 0; met &= met - 1)
            collect_packet<kMoves, kLens>(t, grid, box, p + static_cast<size_t>(std::countr_zero(met)),
                                          segment, candidate.depth);
    });
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
