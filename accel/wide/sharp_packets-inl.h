/// Packets of rays through one point that lie close together, against still micropolygons: the rays stay
/// where they are (nothing is compacted), boxes and micropolygons are chosen for the packet as a whole, and
/// only what is left is put to the predicate, lanes being rays. Compiled once a target; only AVX-512 traces
/// by it (kHasSharpPackets), tests on all others, so that every machine tests it.
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

/// Whether pinholes are traced by sharp packets: where a packet is as many rays as a block has micropolygons.
/// Other targets trace them as they trace all else.
inline constexpr bool kHasSharpPackets = HWY_TARGET <= HWY_AVX3 && HWY_ARCH_X86;

/// The intervals of a packet's slopes. All of its rays start at the origin of camera space.
struct PacketSlopes {
    float ux_low, ux_high, uy_low, uy_high;
};

/// The boxes of a grid (at most 16, one a lane) that some ray of a packet may meet between the depths z_low
/// and z_high and no farther than `farthest`, as bits: the middle ray against boxes grown by how far others
/// are from it anywhere in the grid's range of depths.
HWY_INLINE uint32_t boxes_met(const WideGrid& grid, const FrameAxes& axes, const float* planes,
                              const PacketSlopes& slopes, float z_low, float z_high, float farthest) {
    const F32 d;
    const float reach = std::max(std::abs(z_low), std::abs(z_high));
    const float ux = 0.5f * (slopes.ux_low + slopes.ux_high), uy = 0.5f * (slopes.uy_low + slopes.uy_high);
    // A little more than half, for the middle is rounded.
    const float dx = 0.50001f * (slopes.ux_high - slopes.ux_low) + 0x1p-22f * std::abs(ux),
                dy = 0.50001f * (slopes.uy_high - slopes.uy_low) + 0x1p-22f * std::abs(uy);
    const auto boxes = static_cast<size_t>(grid.box_count());
    uint32_t met = 0;
    for (size_t b = 0; b < BoxPlanes::kMost; b += kLanes) {
        VF near = hn::Set(d, z_low), far = hn::Set(d, std::min(z_high, farthest + grid.slack()));
        for (size_t k = 0; k < 3; ++k) {
            const float* axis = axes.axis[k];
            // At depth z a ray of the packet lies within (dx, dy) * z of the middle ray; this is that along
            // the frame's axis k.
            const VF grow = hn::Set(d, reach * (std::abs(axis[0]) * dx + std::abs(axis[1]) * dy));
            const float along = axis[0] * ux + axis[1] * uy + axis[2];
            const VF inverse =
                hn::Set(d, 1.0f / (std::abs(along) < kLeastDirection ? kLeastDirection : along));
            const float* low = planes + k * BoxPlanes::kMost + b;
            const VF p = hn::Mul(hn::Sub(hn::Load(d, low), grow), inverse);
            const VF q = hn::Mul(hn::Add(hn::Load(d, low + 3 * BoxPlanes::kMost), grow), inverse);
            near = hn::Max(near, hn::Min(p, q)), far = hn::Min(far, hn::Max(p, q));
        }
        met |= mask_bits(hn::And(hn::Le(near, far), hn::FirstN(d, boxes - std::min(boxes, b)))) << b;
    }
    return met;
}

/// The micropolygons of a block that some ray of a packet may hit, as bits v * 4 + u: those whose corners,
/// moved along all slopes of the packet, lie about the ray in a and in b. Exact in floats, with nothing
/// grown: the predicate's roundings are monotone in the slope.
HWY_INLINE uint32_t micropolygons_met(const BlockView& block, const PacketSlopes& slopes) {
    constexpr size_t kParts = BlockParts::kParts;
    const F32 d;
    uint32_t all = 0;
    for (size_t first = 0; first < 16; first += kLanes) {
        const BlockParts lookup(block, static_cast<int>(first));
        VF vertices[3][kParts];
        for (int k = 0; k < 3; ++k) lookup.load(k, vertices[k]);
        VF met_low[2], met_high[2];  // of a, then b, over a micropolygon's corners
        for (int k = 0; k < 2; ++k) {
            const VF from = hn::Set(d, k == 0 ? slopes.ux_low : slopes.uy_low),
                     to = hn::Set(d, k == 0 ? slopes.ux_high : slopes.uy_high);
            VF low[kParts], high[kParts];
#pragma GCC unroll 4
            for (size_t i = 0; i < kParts; ++i) {
                const VF p = hn::Mul(from, vertices[2][i]), q = hn::Mul(to, vertices[2][i]);
                low[i] = hn::Sub(vertices[k][i], hn::Max(p, q));
                high[i] = hn::Sub(vertices[k][i], hn::Min(p, q));
            }
            met_low[k] = lookup.corner(k00, low), met_high[k] = lookup.corner(k00, high);
#pragma GCC unroll 3
            for (int corner = 1; corner < 4; ++corner) {
                met_low[k] = hn::Min(met_low[k], lookup.corner(corner, low));
                met_high[k] = hn::Max(met_high[k], lookup.corner(corner, high));
            }
        }
        const VF zero = hn::Zero(d);
        const MF met = hn::And(hn::And(hn::Le(met_low[0], zero), hn::Ge(met_high[0], zero)),
                               hn::And(hn::Le(met_low[1], zero), hn::Ge(met_high[1], zero)));
        all |= mask_bits(met) << first;
    }
    return all;
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

/// Tests a packet against the micropolygons of a block that it may hit; whether one of its rays looks less
/// far now.
inline bool test_packet(BundleState& t, const SegmentBlock& block, size_t packet,
                        const PacketSlopes& slopes) {
    const F32 d;
    const hn::RebindToUnsigned<F32> du;
    const size_t i = packet * kLanes, rays = std::min(kLanes, t.rays.count - i);
    const VF ux = hn::Load(d, t.rays.ux + i), uy = hn::Load(d, t.rays.uy + i);
    const MF valid = hn::FirstN(d, rays);
    bool nearer = false;
    for (uint32_t met = micropolygons_met(block.view, slopes); met != 0; met &= met - 1) {
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

/// Tests a packet against the boxes of grid number `index`, which are decoded, and the blocks in those it
/// meets. `box`: the grid's in camera space. Whether the packet's farthest depth may have become nearer.
inline bool visit_packet(BundleState& t, uint32_t index, const WideGrid& grid, const FrameAxes& axes,
                         const MovingBox& box, size_t packet) {
    const auto& row = t.scratch.intervals.row;
    const PacketSlopes slopes{row[RayIntervals::kDxMin][packet], row[RayIntervals::kDxMax][packet],
                              row[RayIntervals::kDyMin][packet], row[RayIntervals::kDyMax][packet]};
    uint32_t boxes =
        boxes_met(grid, axes, t.scratch.boxes.values, slopes, std::max(box.low[2], t.nearest_depth),
                  box.high[2], t.scratch.farthest[packet]);
    const auto rays = std::min(kLanes, t.rays.count - packet * kLanes);
    t.stats.nodes_visited += rays;
    if (t.rays.nodes) count_packet(t.rays.nodes, packet * kLanes, 1);
    bool nearer = false;
    const int blocks_u = grid.blocks_u(), per_box = grid.blocks_per_box();
    for (; boxes != 0; boxes &= boxes - 1) {
        const int first = std::countr_zero(boxes) * per_box,
                  last = std::min(first + per_box, grid.block_count());
        for (int b = first; b < last; ++b) {
            t.stats.leaves_visited += rays;
            nearer |= test_packet(t, block_of(grid, 0, b % blocks_u, b / blocks_u, index), packet, slopes);
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
    SegmentFrame& frame = t.scratch.frame;
    VF low[3], high[3];
    for (int k = 0; k < 3; ++k) low[k] = hn::Set(d, box.low[k]), high[k] = hn::Set(d, box.high[k]);
    bool nearer = false, decoded = false;
    t.for_packets(candidate.groups, [&](size_t p) HWY_ATTR {
        const auto q = IntervalLanes::of<false, false>(
            [&](int row) HWY_ATTR { return hn::Load(d, t.scratch.intervals.row[row] + p); });
        const MF looks = hn::Ge(hn::Load(d, t.scratch.farthest + p), low[2]);
        uint32_t met = mask_bits(hn::And(
            looks, meets<false>(d, q, low, high, hn::Set(d, t.nearest_depth), hn::Set(d, t.inverse_focal))));
        if (met != 0 && !decoded) {
            t.tree.read_frame(grid, 0, frame);
            decode_boxes<false>(t.tree, grid, 0, frame, t.scratch.boxes);
            decoded = true;
        }
        for (; met != 0; met &= met - 1)
            nearer |= visit_packet(t, candidate.grid, grid, frame.axes, box,
                                   p + static_cast<size_t>(std::countr_zero(met)));
    });
    if (nearer) t.refresh_farthest();
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
