/// Packets of rays through one point that lie close together, against still micropolygons: the rays stay
/// where they are (nothing is compacted), boxes and micropolygons are chosen for the packet as a whole, and
/// only what is left is put to the predicate, lanes being rays. Compiled once a target.
#if defined(TRAPEZE_ACCEL_SHARP_PACKETS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRAPEZE_ACCEL_SHARP_PACKETS_INL_H_
#undef TRAPEZE_ACCEL_SHARP_PACKETS_INL_H_
#else
#define TRAPEZE_ACCEL_SHARP_PACKETS_INL_H_
#endif

#include <hwy/highway.h>

#include <bit>

#include "accel/wide/box_codes-inl.h"
#include "accel/wide/bundle_state-inl.h"
#include "accel/wide/ray_intervals-inl.h"
#include "accel/wide/whole_block-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Whether pinholes are traced by sharp packets: where a packet is more than one ray.
inline constexpr bool kHasSharpPackets = kLanes > 1;

/// The intervals of a packet's slopes. All of its rays start at the origin of camera space.
struct PacketSlopes {
    float ux_low, ux_high, uy_low, uy_high;
};

/// What slopes are grown by, of themselves and besides: a division rounds, as the predicate's product of
/// slope and depth does, by 2^-24 each, and denormal products by 2^-150, over depths of kLeastSlopeDepth and
/// more.
inline constexpr float kSlopeGrowth = 0x1p-21f, kSlopeGrowthAtLeast = 1e-25f, kLeastSlopeDepth = 1e-18f;

/// Bounds the slopes x / z and y / z of the corners of a block's micropolygons. A ray whose slope is on one
/// side of all four passes beside the micropolygon. What comes nearer than kLeastSlopeDepth, or behind the
/// eye, has no bounds.
inline void bound_slopes(const BlockView& block, SlopeBounds& bounds) {
    constexpr size_t kParts = BlockParts::kParts;
    const F32 d;
    const VF infinity = hn::Set(d, HUGE_VALF);
    for (size_t first = 0; first < 16; first += kLanes) {
        const BlockParts lookup(block, static_cast<int>(first));
        VF z[kParts], inverse[kParts];
        MF bounded[kParts];
        lookup.load(2, z);
#pragma GCC unroll 4
        for (size_t i = 0; i < kParts; ++i) {
            inverse[i] = hn::Div(hn::Set(d, 1.0f), z[i]);
            bounded[i] = hn::Ge(z[i], hn::Set(d, kLeastSlopeDepth));
        }
        for (int k = 0; k < 2; ++k) {
            VF low[kParts], high[kParts];
            lookup.load(k, low);
#pragma GCC unroll 4
            for (size_t i = 0; i < kParts; ++i) {
                const VF slope = hn::Mul(low[i], inverse[i]);
                const VF growth =
                    hn::MulAdd(hn::Abs(slope), hn::Set(d, kSlopeGrowth), hn::Set(d, kSlopeGrowthAtLeast));
                low[i] = hn::IfThenElse(bounded[i], hn::Sub(slope, growth), hn::Neg(infinity));
                high[i] = hn::IfThenElse(bounded[i], hn::Add(slope, growth), infinity);
            }
            VF lowest = lookup.corner(k00, low), highest = lookup.corner(k00, high);
#pragma GCC unroll 3
            for (int corner = 1; corner < 4; ++corner) {
                lowest = hn::Min(lowest, lookup.corner(corner, low));
                highest = hn::Max(highest, lookup.corner(corner, high));
            }
            hn::Store(lowest, d, bounds.low[k] + first);
            hn::Store(highest, d, bounds.high[k] + first);
        }
    }
}

/// The micropolygons of a block that some ray of a packet may hit, as bits v * 4 + u.
HWY_INLINE uint32_t micropolygons_met(const SlopeBounds& bounds, const PacketSlopes& slopes) {
    const F32 d;
    uint32_t all = 0;
    for (size_t first = 0; first < 16; first += kLanes) {
        const MF x = hn::And(hn::Le(hn::Load(d, bounds.low[0] + first), hn::Set(d, slopes.ux_high)),
                             hn::Ge(hn::Load(d, bounds.high[0] + first), hn::Set(d, slopes.ux_low)));
        const MF y = hn::And(hn::Le(hn::Load(d, bounds.low[1] + first), hn::Set(d, slopes.uy_high)),
                             hn::Ge(hn::Load(d, bounds.high[1] + first), hn::Set(d, slopes.uy_low)));
        all |= mask_bits(hn::And(x, y)) << first;
    }
    return all;
}

/// A vector of packets along the axes of a grid, one packet a lane of each row: one over what the
/// middle ray goes along axis k a unit of depth, and how far others are from it at most anywhere in the
/// grid's range of depths.
struct PacketsInAxes {
    HWY_ALIGN float inverse[3][kLanes], spread[3][kLanes];

    /// `reach`: the largest |depth| of the grid.
    HWY_INLINE PacketsInAxes(const IntervalLanes& q, const GridAxes& axes, float reach) {
        const F32 d;
        // A little more than half, for the middle is rounded.
        const VF half = hn::Set(d, 0.5f), more = hn::Set(d, 0.50001f), rounding = hn::Set(d, 0x1p-22f);
        const VF ux = hn::Mul(half, hn::Add(q.dx.low, q.dx.high)),
                 uy = hn::Mul(half, hn::Add(q.dy.low, q.dy.high));
        const VF dx = hn::MulAdd(rounding, hn::Abs(ux), hn::Mul(more, hn::Sub(q.dx.high, q.dx.low))),
                 dy = hn::MulAdd(rounding, hn::Abs(uy), hn::Mul(more, hn::Sub(q.dy.high, q.dy.low)));
        const VF least = hn::Set(d, kLeastDirection);
        for (size_t k = 0; k < 3; ++k) {
            const VF x = hn::Set(d, axes.axis[k][0]), y = hn::Set(d, axes.axis[k][1]);
            const VF along = hn::MulAdd(x, ux, hn::MulAdd(y, uy, hn::Set(d, axes.axis[k][2])));
            hn::Store(hn::Div(hn::Set(d, 1.0f), hn::IfThenElse(hn::Lt(hn::Abs(along), least), least, along)),
                      d, inverse[k]);
            // At depth z a ray of the packet lies within (dx, dy) * z of the middle ray.
            hn::Store(hn::Mul(hn::Set(d, reach), hn::MulAdd(hn::Abs(x), dx, hn::Mul(hn::Abs(y), dy))), d,
                      spread[k]);
        }
    }
};

/// The boxes of a grid (at most 16, one a lane) that some ray of a packet may meet between the depths z_low
/// and z_high, as bits: the middle ray against boxes grown by how far others are from it.
HWY_INLINE uint32_t boxes_met(const WideGrid& grid, const float* planes, const PacketsInAxes& packets,
                              size_t lane, float z_low, float z_high) {
    const F32 d;
    const auto boxes = static_cast<size_t>(grid.box_count());
    uint32_t met = 0;
    for (size_t b = 0; b < boxes; b += kLanes) {
        VF near = hn::Set(d, z_low), far = hn::Set(d, z_high);
        for (size_t k = 0; k < 3; ++k) {
            const VF spread = hn::Set(d, packets.spread[k][lane]),
                     inverse = hn::Set(d, packets.inverse[k][lane]);
            const float* low = planes + k * BoxPlanes::kMost + b;
            const VF p = hn::Mul(hn::Sub(hn::Load(d, low), spread), inverse);
            const VF q = hn::Mul(hn::Add(hn::Load(d, low + 3 * BoxPlanes::kMost), spread), inverse);
            near = hn::Max(near, hn::Min(p, q)), far = hn::Min(far, hn::Max(p, q));
        }
        met |= mask_bits(hn::And(hn::Le(near, far), hn::FirstN(d, boxes - b))) << b;
    }
    return met;
}

/// The corners of one micropolygon of a block against rays through the origin.
HWY_INLINE QuadLanes<VF> quad_from_origin(const BlockView& block, int u, int v, VF ux, VF uy) {
    const F32 d;
    const int at[4] = {block.offset(u, v), block.offset(u + 1, v), block.offset(u, v + 1),
                       block.offset(u + 1, v + 1)};
    const auto vertex = [&](int k, int corner) HWY_ATTR {
        return hn::Set(d, block.tile[static_cast<size_t>(k) * block.plane + static_cast<size_t>(at[corner])]);
    };
    const VF zero = hn::Zero(d);
    return quad_lanes(zero, zero, zero, ux, uy, vertex);
}

/// Keeps hits on a grid that is not opaque; `first`: the number of the ray in lane 0. Whether a ray looks
/// less far now.
inline bool add_layers(BundleState& t, size_t first, MF hit, VF depth, uint32_t id) {
    bool nearer = false;
    HWY_ALIGN float depths[kLanes];
    hn::Store(depth, F32(), depths);
    for (uint32_t lanes = mask_bits(hit); lanes != 0; lanes &= lanes - 1) {
        const int lane = std::countr_zero(lanes);
        nearer |=
            t.keep_layer(static_cast<uint32_t>(first) + static_cast<uint32_t>(lane), {depths[lane], id});
    }
    return nearer;
}

/// Tests a packet against those of a block's micropolygons that `met` says; whether one of its rays looks
/// less far now.
inline bool test_packet(BundleState& t, const SegmentBlock& block, size_t packet, uint32_t met) {
    const F32 d;
    const hn::RebindToUnsigned<F32> du;
    const size_t i = packet * kLanes, rays = std::min(kLanes, t.rays.count - i);
    const VF ux = hn::Load(d, t.rays.ux + i), uy = hn::Load(d, t.rays.uy + i);
    const MF valid = hn::FirstN(d, rays);
    bool nearer = false;
    for (; met != 0; met &= met - 1) {
        const int m = std::countr_zero(met), u = m & 3, v = m >> 2;
        t.stats.predicate_tests += rays;
        if (t.rays.tests) count_packet(t.rays.tests, i, 1);
        const QuadLanes<VF> quad = quad_from_origin(block.view, u, v, ux, uy);
        MF hit = hn::And(inside(d, quad), valid);
        if (hn::AllFalse(d, hit)) continue;
        VF depth;
        hit = hn::And(hit, depth_inside(d, quad, block.facing, depth));
        hit = hn::And(
            hit, hn::And(hn::Ge(depth, hn::Set(d, t.range.min)), hn::Le(depth, hn::Set(d, t.range.max))));
        t.stats.predicate_hits += hn::CountTrue(d, hit);
        const VF nearest = hn::Load(d, t.rays.depth + i);
        const auto ids = hn::Load(du, t.rays.id + i),
                   id = hn::Set(du, block.id + static_cast<uint32_t>(v << 4 | u));
        // As BundleState::keep_hit(), in lanes.
        const MF kept =
            hn::And(hit, hn::Or(hn::Lt(depth, nearest),
                                hn::And(hn::Eq(depth, nearest), hn::RebindMask(d, hn::Lt(id, ids)))));
        if (!block.opaque) {
            nearer |= add_layers(t, i, hn::And(hit, hn::Le(depth, nearest)), depth,
                                 block.id + static_cast<uint32_t>(v << 4 | u));
            continue;
        }
        if (hn::AllFalse(d, kept)) continue;
        hn::Store(hn::IfThenElse(kept, depth, nearest), d, t.rays.depth + i);
        hn::Store(hn::IfThenElse(hn::RebindMask(du, kept), id, ids), du, t.rays.id + i);
        nearer = true;
    }
    return nearer;
}

/// Tests a packet against the blocks in the boxes that it meets of grid number `index`. Whether the packet's
/// farthest depth may have become nearer.
inline bool visit_packet(BundleState& t, uint32_t index, const WideGrid& grid, size_t packet,
                         uint32_t boxes) {
    const auto& row = t.scratch.intervals.row;
    const PacketSlopes slopes{row[RayIntervals::kDxMin][packet], row[RayIntervals::kDxMax][packet],
                              row[RayIntervals::kDyMin][packet], row[RayIntervals::kDyMax][packet]};
    const auto rays = std::min(kLanes, t.rays.count - packet * kLanes);
    bool nearer = false;
    const int blocks_u = grid.blocks_u(), per_box = grid.blocks_per_box();
    for (; boxes != 0; boxes &= boxes - 1) {
        const int first = std::countr_zero(boxes) * per_box,
                  last = std::min(first + per_box, grid.block_count());
        for (int b = first; b < last; ++b) {
            t.stats.leaves_visited += rays;
            const auto block = [&] { return block_of(grid, 0, b % blocks_u, b / blocks_u, index); };
            SlopeBounds& bounds = t.scratch.slopes[b];
            if (!(t.scratch.slopes_known >> b & 1)) {
                bound_slopes(block().view, bounds);
                t.scratch.slopes_known |= 1u << b;
            }
            if (const uint32_t met = micropolygons_met(bounds, slopes); met != 0)
                nearer |= test_packet(t, block(), packet, met);
        }
    }
    if (nearer) t.refresh_packet(packet);
    return nearer;
}

/// Tests all packets of the candidate's groups whose intervals meet the grid's axis-aligned box, one by one
/// as they lie. The grid's boxes are decoded when the first packet has come.
inline void visit_sharp(BundleState& t, const Candidate& candidate, const WideGrid& grid) {
    const F32 d;
    const MovingBox box = t.tree.grid_box(grid);
    const float z_low = std::max(box.low[2], t.nearest_depth), z_high = box.high[2],
                reach = std::max(std::abs(z_low), std::abs(z_high));
    OrientedSegment& oriented = t.scratch.oriented;
    VF low[3], high[3];
    for (int k = 0; k < 3; ++k) low[k] = hn::Set(d, box.low[k]), high[k] = hn::Set(d, box.high[k]);
    bool nearer = false, decoded = false;
    t.for_packets(candidate.groups, [&](size_t p) HWY_ATTR {
        const auto q = IntervalLanes::of<false, false>(
            [&](int row) HWY_ATTR { return hn::Load(d, t.scratch.intervals.row[row] + p); });
        const MF looks = hn::Ge(hn::Load(d, t.scratch.farthest + p), low[2]);
        uint32_t met = mask_bits(hn::And(
            looks, meets<false>(d, q, low, high, hn::Set(d, t.nearest_depth), hn::Set(d, t.inverse_focal))));
        if (met == 0) return;
        if (!decoded) {
            t.tree.read_segment(grid, 0, oriented);
            decode_boxes<false>(t.tree, grid, 0, oriented, t.scratch.boxes);
            t.scratch.slopes_known = 0;
            decoded = true;
        }
        const PacketsInAxes packets(q, oriented.axes, reach);
        for (; met != 0; met &= met - 1) {
            const auto lane = static_cast<size_t>(std::countr_zero(met));
            const size_t packet = p + lane, rays = std::min(kLanes, t.rays.count - packet * kLanes);
            t.stats.nodes_visited += rays;
            if (t.rays.nodes) count_packet(t.rays.nodes, packet * kLanes, 1);
            const uint32_t boxes = boxes_met(grid, t.scratch.boxes.values, packets, lane, z_low,
                                             std::min(z_high, t.scratch.farthest[packet] + grid.slack()));
            if (boxes != 0) nearer |= visit_packet(t, candidate.grid, grid, packet, boxes);
        }
    });
    if (nearer) t.refresh_farthest();
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
