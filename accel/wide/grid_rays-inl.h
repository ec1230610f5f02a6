/// The rays of a bundle that may meet a grid (ActiveRays), found in three steps, each for what the one before
/// left: packets by intervals against the axis-aligned box, rays against that box, rays against the oriented
/// box. Compiled once a target.
#if defined(TRAPEZE_ACCEL_GRID_RAYS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRAPEZE_ACCEL_GRID_RAYS_INL_H_
#undef TRAPEZE_ACCEL_GRID_RAYS_INL_H_
#else
#define TRAPEZE_ACCEL_GRID_RAYS_INL_H_
#endif

#include <hwy/highway.h>

#include <bit>

#include "accel/wide/box_codes-inl.h"
#include "accel/wide/bundle_state-inl.h"
#include "accel/wide/compact_lanes-inl.h"
#include "accel/wide/ray_intervals-inl.h"
#include "core/simd/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Whether a time is in a segment, and where. Every time is in one segment alone.
HWY_INLINE MF in_segment(VF time, int key_count, int segment, VF& local) {
    const F32 d;
    const auto at = segments_at(d, time, key_count);
    local = at.local;
    return hn::RebindMask(d, hn::Eq(at.index, hn::Set(I32(), segment)));
}

/// Turns an interval of times of the shutter into one of times local to a segment, cut to [0, 1]; false where
/// none is in the segment.
HWY_INLINE MF to_segment(int key_count, int segment, VectorInterval& time) {
    const F32 d;
    const VF scale = hn::Set(d, static_cast<float>(key_count - 1)),
             start = hn::Set(d, static_cast<float>(segment));
    const VF low = hn::MulSub(time.low, scale, start), high = hn::MulSub(time.high, scale, start);
    const VF zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    time = {hn::Max(low, zero), hn::Min(high, one)};
    // A little more than the segment, for times round.
    return hn::And(hn::Le(low, hn::Set(d, 1.0f + 0x1p-12f)), hn::Ge(high, hn::Set(d, -0x1p-12f)));
}

/// Lanes of rays that pass through a grid's axis-aligned box no farther than their limits: a third of the
/// work that the oriented box is, and of a packet that is wider than a grid most often no ray is left.
template <bool kMotion, bool kLens>
HWY_INLINE MF in_aligned_box(const MovingBox& box, const RayLanes& r, VF limit) {
    const F32 d;
    const auto plane = [&](const float* at, const float* delta, int k) HWY_ATTR {
        const VF value = hn::Set(d, at[k]);
        return kMotion ? hn::MulAdd(r.local, hn::Set(d, delta[k]), value) : value;
    };
    const VF z0 = plane(box.low, box.low_delta, 2), z1 = hn::Min(plane(box.high, box.high_delta, 2), limit);
    // Between the depths of entry and exit in z a ray spans an interval of x (y), which has to meet the
    // box's.
    const auto passes = [&](VF o, VF u, int k) HWY_ATTR {
        const VF from = kLens ? hn::MulAdd(u, z0, o) : hn::Mul(u, z0),
                 to = kLens ? hn::MulAdd(u, z1, o) : hn::Mul(u, z1);
        return hn::And(hn::Le(hn::Min(from, to), plane(box.high, box.high_delta, k)),
                       hn::Ge(hn::Max(from, to), plane(box.low, box.low_delta, k)));
    };
    return hn::And(hn::Le(z0, z1), hn::And(passes(r.ox, r.ux, 0), passes(r.oy, r.uy, 1)));
}

/// Fetches the codes of a grid's boxes, which are needed once all packets of the bundle have been looked at.
template <bool kMotion>
HWY_INLINE void prefetch_boxes(const BundleState& t, const WideGrid& grid, int segment) {
    constexpr size_t kLine = 64;
    const size_t bytes = grid.key_bytes() * (kMotion ? 2 : 1);
    const uint8_t* keys = GridKeys(grid, t.tree.keys_of(grid)).of_key(segment);
    for (size_t i = 0; i < bytes; i += kLine) __builtin_prefetch(keys + i);
    __builtin_prefetch(keys + bytes - 1);
}

/// Loads the rays of a packet; lanes that look in a segment, at times local to it (r.local).
template <bool kMotion, bool kLens>
HWY_INLINE MF rays_in_segment(const BundleState& t, const WideGrid& grid, int segment, size_t packet,
                              RayLanes& r) {
    const F32 d;
    const size_t i = packet * kLanes;
    r.ox = kLens ? hn::Load(d, t.rays.ox + i) : hn::Zero(d);
    r.oy = kLens ? hn::Load(d, t.rays.oy + i) : hn::Zero(d);
    r.ux = hn::Load(d, t.rays.ux + i), r.uy = hn::Load(d, t.rays.uy + i);
    r.local = kMotion ? hn::Load(d, t.rays.time + i) : hn::Zero(d);
    if constexpr (kMotion) {
        if (grid.has_segments()) return in_segment(r.local, grid.key_count, segment, r.local);
    }
    return hn::FirstN(d, kLanes);
}

/// How far the rays of a packet look: to their nearest hit, and the grid's slack beyond, by which a hit may
/// lie before the depth where an oriented box is entered.
HWY_INLINE VF limit_of(const BundleState& t, const WideGrid& grid, size_t packet) {
    const F32 d;
    return hn::Add(hn::Load(d, t.rays.depth + packet * kLanes), hn::Set(d, grid.slack()));
}

/// Keeps those of `count` met packets that have rays which meet the grid's axis-aligned box; how many.
/// Without a branch: about every second packet has none, which cannot be predicted.
template <bool kMotion, bool kLens>
HWY_INLINE size_t keep_aligned(BundleState& t, const WideGrid& grid, const MovingBox& box, int segment,
                               size_t count) {
    MetPackets& met = t.scratch.met_packets;
    size_t kept = 0;
    for (size_t n = 0; n < count; ++n) {
        const uint32_t packet = met.packet[n];
        RayLanes r;
        const MF looks = rays_in_segment<kMotion, kLens>(t, grid, segment, packet, r);
        const VF limit = limit_of(t, grid, packet);
        met.lanes[kept] = mask_bits(hn::And(looks, in_aligned_box<kMotion, kLens>(box, r, limit)));
        met.packet[kept] = packet;
        kept += met.lanes[kept] != 0;
    }
    return kept;
}

/// Adds those rays of a packet to the active ones that meet the grid's oriented box; `lanes` meet the other.
/// Keeps what the rays are in the grid's axes, for its boxes are along those, too.
template <bool kMotion, bool kLens>
HWY_INLINE void collect_packet(BundleState& t, const WideGrid& grid, uint32_t packet, uint32_t lanes,
                               int segment, float depth) {
    const F32 d;
    RayLanes r;
    rays_in_segment<kMotion, kLens>(t, grid, segment, packet, r);
    const VF limit = limit_of(t, grid, packet);
    const OrientedSegment& oriented = t.scratch.oriented;
    const MovingBox& box = oriented.box;
    VF inverse[3], offset[3], near = hn::Set(d, depth), far = limit;
    for (int k = 0; k < 3; ++k) {
        const float* axis = oriented.axes.axis[k];
        const VF x = hn::Set(d, axis[0]), y = hn::Set(d, axis[1]);
        inverse[k] = reciprocal(hn::MulAdd(x, r.ux, hn::MulAdd(y, r.uy, hn::Set(d, axis[2]))));
        offset[k] = kLens ? hn::Mul(hn::MulAdd(x, r.ox, hn::Mul(y, r.oy)), inverse[k]) : hn::Zero(d);
        VF low = hn::Set(d, box.low[k]), high = hn::Set(d, box.high[k]);
        if constexpr (kMotion) {
            low = hn::MulAdd(r.local, hn::Set(d, box.low_delta[k]), low);
            high = hn::MulAdd(r.local, hn::Set(d, box.high_delta[k]), high);
        }
        const VF a = hn::MulSub(low, inverse[k], offset[k]), b = hn::MulSub(high, inverse[k], offset[k]);
        near = hn::Max(near, hn::Min(a, b)), far = hn::Min(far, hn::Max(a, b));
    }
    const MF met = hn::And(mask_of(lanes), hn::Le(near, far));
    const size_t count = hn::CountTrue(d, met);
    if (count == 0) return;
    ActiveRays& to = t.scratch.active;
    const size_t at = to.count;
    const CompactLanes compact(met);
    if constexpr (kLens) compact.store(r.ox, to.ox + at), compact.store(r.oy, to.oy + at);
    compact.store(r.ux, to.ux + at), compact.store(r.uy, to.uy + at);
    if constexpr (kMotion) compact.store(r.local, to.local + at);
    for (int k = 0; k < 3; ++k) {
        compact.store(inverse[k], to.inverse[k] + at);
        if constexpr (kLens) compact.store(offset[k], to.offset[k] + at);
    }
    compact.store(limit, to.limit + at);
    const hn::RebindToUnsigned<F32> du;
    compact.store(lane_numbers(du, static_cast<uint32_t>(packet * kLanes)), to.ray + at);
    to.count += count;
    t.scratch.touched[t.scratch.touched_count++] = packet;
}

/// Lists the active rays of a grid in a segment, from the packets of the candidate's groups. `box`: the
/// grid's in camera space during the segment.
template <bool kMotion, bool kLens>
void collect_active(BundleState& t, const MovingBox& box, const WideGrid& grid, int segment,
                    const Candidate& candidate) {
    const F32 d;
    const hn::RebindToUnsigned<F32> du;
    t.scratch.active.count = 0;
    t.scratch.touched_count = 0;
    MetPackets& packets = t.scratch.met_packets;
    size_t count = 0;
    t.for_packets(candidate.groups, [&](size_t p) HWY_ATTR {
        auto q = IntervalLanes::of<kMotion, kLens>(
            [&](int row) HWY_ATTR { return hn::Load(d, t.scratch.intervals.row[row] + p); });
        VF low[3], high[3];
        MF looks = hn::FirstN(d, kLanes);
        if constexpr (kMotion) {
            if (grid.has_segments()) looks = to_segment(grid.key_count, segment, q.time);
        }
        for (int k = 0; k < 3; ++k) {
            low[k] = hn::Set(d, box.low[k]), high[k] = hn::Set(d, box.high[k]);
            if constexpr (kMotion) {
                low[k] = lowest(low[k], hn::Set(d, box.low_delta[k]), q.time);
                high[k] = highest(high[k], hn::Set(d, box.high_delta[k]), q.time);
            }
        }
        // Packets all of whose rays have hit something nearer are out.
        looks = hn::And(looks, hn::Ge(hn::Load(d, t.scratch.farthest + p), low[2]));
        const MF met = hn::And(
            looks, meets<kLens>(d, q, low, high, hn::Set(d, t.nearest_depth), hn::Set(d, t.inverse_focal)));
        CompactLanes(met).store(lane_numbers(du, static_cast<uint32_t>(p)), packets.packet + count);
        count += hn::CountTrue(d, met);
    });
    t.stats.nodes_visited += count * kLanes;
    if (t.rays.nodes)
        for (size_t n = 0; n < count; ++n) count_packet(t.rays.nodes, packets.packet[n] * kLanes, 1);
    count = keep_aligned<kMotion, kLens>(t, grid, box, segment, count);
    if (count == 0) return;
    if constexpr (kMotion)
        read_moving_segment(t.tree, grid, segment, t.scratch.oriented);
    else
        t.tree.read_segment(grid, segment, t.scratch.oriented);
    prefetch_boxes<kMotion>(t, grid, segment);
    for (size_t n = 0; n < count; ++n)
        collect_packet<kMotion, kLens>(t, grid, packets.packet[n], packets.lanes[n], segment,
                                       candidate.depth);
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
