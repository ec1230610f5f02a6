/// A bundle in a grid: the rays that may meet it (ActiveRays), the boxes that they meet, the rays of each
/// block. Compiled once a target.
#if defined(TRAPEZE_ACCEL_GRID_RAYS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRAPEZE_ACCEL_GRID_RAYS_INL_H_
#undef TRAPEZE_ACCEL_GRID_RAYS_INL_H_
#else
#define TRAPEZE_ACCEL_GRID_RAYS_INL_H_
#endif

#include <hwy/highway.h>

#include <bit>
#include <cstring>

#include "accel/block_slabs-inl.h"
#include "accel/block_tests-inl.h"
#include "accel/compact_lanes-inl.h"
#include "accel/ray_intervals-inl.h"
#include "core/lane_numbers-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Finding a block's slabs pays for so many rays.
inline constexpr size_t kFewForSlabs = 12;

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

template <bool kMoves, bool kLens>
void collect_packet(BundleState& t, const WideGrid& grid, const SegmentBounds& bounds, size_t packet,
                    int segment, float depth) {
    const F32 d;
    const MovingBox& framed = bounds.framed;
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
    met = hn::And(met, in_aligned_box<kMoves, kLens>(bounds.box, {ox, oy, ux, uy, local}, limit));
    if (hn::AllFalse(d, met)) return;
    VF inverse[3], offset[3], near = hn::Set(d, depth), far = limit;
    for (int k = 0; k < 3; ++k) {
        const float* axis = grid.axis[k];
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
void collect_active(BundleState& t, const SegmentBounds& bounds, const WideGrid& grid, int segment,
                    const Candidate& candidate) {
    const F32 d;
    const MovingBox& box = bounds.box;
    t.scratch.active.count = 0;
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
            collect_packet<kMoves, kLens>(t, grid, bounds, p + static_cast<size_t>(std::countr_zero(met)),
                                          segment, candidate.depth);
    });
}

/// Those of a vector of rays. kAlike: along each axis all look to the same side, so that it is known
/// which plane of a box comes first.
template <bool kMoves, bool kLens, bool kAlike>
void meet_boxes_of(BundleState& t, size_t i, const float* planes, int boxes, const int* sides, uint8_t* met) {
    const F32 d;
    const ActiveRays& active = t.scratch.active;
    const auto stride = static_cast<size_t>(boxes);
    const VF local = kMoves ? hn::Load(d, active.local + i) : hn::Zero(d);
    const VF limit = hn::Load(d, active.limit + i);
    VF inverse[3], offset[3];
    const float *first[3], *last[3];
    for (size_t k = 0; k < 3; ++k) {
        inverse[k] = hn::Load(d, active.inverse[k] + i);
        offset[k] = kLens ? hn::Load(d, active.offset[k] + i) : hn::Zero(d);
        first[k] = planes + (k + (kAlike && sides[k] ? 3 : 0)) * stride;
        last[k] = planes + (k + (kAlike && sides[k] ? 0 : 3)) * stride;
    }
    for (int b = 0; b < boxes; ++b, met += kMetStride) {
        VF near, far;
        for (int k = 0; k < 3; ++k) {
            VF from = hn::Set(d, first[k][b]), to = hn::Set(d, last[k][b]);
            if constexpr (kMoves) {
                from = hn::MulAdd(local, hn::Set(d, first[k][b + 6 * boxes]), from);
                to = hn::MulAdd(local, hn::Set(d, last[k][b + 6 * boxes]), to);
            }
            VF enter = kLens ? hn::MulSub(from, inverse[k], offset[k]) : hn::Mul(from, inverse[k]);
            VF leave = kLens ? hn::MulSub(to, inverse[k], offset[k]) : hn::Mul(to, inverse[k]);
            if constexpr (!kAlike) {
                const VF a = enter;
                enter = hn::Min(a, leave), leave = hn::Max(a, leave);
            }
            near = k == 0 ? enter : hn::Max(near, enter);
            far = k == 0 ? hn::Min(leave, limit) : hn::Min(far, leave);
        }
        hn::StoreMaskBits(d, hn::Le(near, far), met);
    }
}

/// Which active rays meet which boxes: a bit for each ray in a row for each box.
template <bool kMoves, bool kLens>
void meet_boxes(BundleState& t, const float* planes, int boxes) {
    const F32 d;
    const ActiveRays& active = t.scratch.active;
    for (size_t i = 0; i < active.count; i += kLanes) {
        const uint32_t valid = active.count - i < kLanes ? (1u << (active.count - i)) - 1 : kAllLanes;
        int sides[3];
        bool alike = true;
        for (int k = 0; k < 3; ++k) {
            const VF inverse = hn::Load(d, active.inverse[k] + i);
            const uint32_t backward = mask_bits(predicate_lanes::negative(d, inverse)) & valid;
            sides[k] = backward != 0;
            alike = alike && (backward == 0 || backward == valid);
        }
        uint8_t* met = t.scratch.met + i / kLanes * kMaskBytes;
        if (alike)
            meet_boxes_of<kMoves, kLens, true>(t, i, planes, boxes, sides, met);
        else
            meet_boxes_of<kMoves, kLens, false>(t, i, planes, boxes, sides, met);
    }
    t.stats.nodes_visited += active.count * static_cast<size_t>(boxes);
}

/// Of a row of meet_boxes(), whose unused bits are 0.
inline size_t count_bits(const uint8_t* row, size_t bytes) {
    size_t count = 0, i = 0;
    for (; i + 8 <= bytes; i += 8) {
        uint64_t word;
        std::memcpy(&word, row + i, 8);
        count += static_cast<size_t>(std::popcount(word));
    }
    for (; i < bytes; ++i) count += static_cast<size_t>(std::popcount(row[i]));
    return count;
}

/// Lists the active rays whose bits are set in the row of a block's box and that do not pass the block
/// by; how many.
template <bool kMoves, bool kLens>
size_t collect_block(BundleState& t, const Block& block, const uint8_t* met, float rounding) {
    const F32 d;
    const hn::RebindToUnsigned<F32> du;
    const ActiveRays& active = t.scratch.active;
    BlockRays& to = t.scratch.block;
    const size_t candidates = count_bits(met, (active.count + kLanes - 1) / kLanes * kMaskBytes);
    if (candidates == 0) return 0;
    BlockSlabs slabs;
    const bool has_slabs = candidates >= kFewForSlabs && slabs_of<kMoves>(block.view, rounding, slabs);
    if (has_slabs) t.stats.nodes_visited += candidates;
    size_t count = 0;
    for (size_t i = 0; i < active.count; i += kLanes, met += kMaskBytes) {
        uint32_t bits = 0;
        std::memcpy(&bits, met, kMaskBytes);
        if (bits == 0) continue;
        MF here = hn::LoadMaskBits(d, met);
        RayLanes r;
        if constexpr (kLens) r.ox = hn::Load(d, active.ox + i), r.oy = hn::Load(d, active.oy + i);
        r.ux = hn::Load(d, active.ux + i), r.uy = hn::Load(d, active.uy + i);
        if constexpr (kMoves) r.local = hn::Load(d, active.local + i);
        if (has_slabs) {
            here = hn::AndNot(misses<kMoves, kLens>(slabs, r), here);
            bits = mask_bits(here);
            if (bits == 0) continue;
        }
        const CompactLanes compact(here);
        if constexpr (kLens) compact.store(r.ox, to.ox + count), compact.store(r.oy, to.oy + count);
        compact.store(r.ux, to.ux + count), compact.store(r.uy, to.uy + count);
        if constexpr (kMoves) compact.store(r.local, to.local + count);
        compact.store(lane_numbers(du, static_cast<uint32_t>(i)), to.active + count);
        count += static_cast<size_t>(std::popcount(bits));
    }
    return count;
}

inline float absolute_max(const MovingBox& box) {
    float most = 0;
    for (int k = 0; k < 3; ++k)
        for (const float at :
             {box.low[k], box.high[k], box.low[k] + box.low_delta[k], box.high[k] + box.high_delta[k]})
            most = std::max(most, std::abs(at));
    return most;
}

/// The boxes of a grid that active rays meet, and the blocks in them.
template <bool kMoves, bool kLens>
void test_active(BundleState& t, uint32_t index, const WideGrid& grid, int segment) {
    ActiveRays& active = t.scratch.active;
    if (active.count == 0) return;
    const F32 d;
    const float* planes = t.tree.box_planes(grid, segment);
    // Lanes past the end meet nothing, whatever an earlier bundle has left there: infinities would.
    hn::StoreU(hn::Set(d, -HUGE_VALF), d, active.limit + active.count);
    if constexpr (kMoves) hn::StoreU(hn::Zero(d), d, active.local + active.count);
    for (int k = 0; k < 3; ++k) {
        hn::StoreU(hn::Zero(d), d, active.inverse[k] + active.count);
        if constexpr (kLens) hn::StoreU(hn::Zero(d), d, active.offset[k] + active.count);
    }
    const int blocks_u = grid.blocks_u(), boxes = grid.box_count(), per_box = grid.blocks_per_box();
    meet_boxes<kMoves, kLens>(t, planes, boxes);
    const float rounding = t.tree.rounding(absolute_max(t.tree.grid_box(index)));
    for (int b = 0; b < grid.block_count(); ++b) {
        const uint8_t* met = t.scratch.met + static_cast<size_t>(b / per_box) * kMetStride;
        const Block block = block_of(grid, segment, b % blocks_u, b / blocks_u, index);
        const size_t count = collect_block<kMoves, kLens>(t, block, met, rounding);
        if (count != 0) test_block_rays<kMoves, kLens>(t, block, count);
    }
    if (!grid.opaque) return;
    for (const uint32_t packet : t.scratch.touched) t.refresh_packet(packet);
    t.refresh_farthest();
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
