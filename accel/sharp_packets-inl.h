/// Packets of rays through one point that lie close together, against still micropolygons: the rays stay
/// where they are (nothing is compacted), boxes and micropolygons are chosen for the packet as a whole, and
/// only what is left is put to the predicate, lanes being rays. Compiled once a target; AVX-512 alone, where
/// a block's vertices fit two registers and a packet is one vector.
#if defined(TRAPEZE_ACCEL_SHARP_PACKETS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRAPEZE_ACCEL_SHARP_PACKETS_INL_H_
#undef TRAPEZE_ACCEL_SHARP_PACKETS_INL_H_
#else
#define TRAPEZE_ACCEL_SHARP_PACKETS_INL_H_
#endif

#include <hwy/highway.h>

#include "accel/block_hits-inl.h"
#include "accel/bundle_scratch.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET <= HWY_AVX3 && HWY_ARCH_X86

inline constexpr bool kHasSharpPackets = true;

/// The slopes of a packet's rays.
struct PacketSlopes {
    float ux_low, ux_high, uy_low, uy_high;
};

/// The boxes of a grid (at most 16, one a lane) that some ray of a packet may meet: the middle ray against
/// boxes grown by how far others are from it anywhere in the grid's range of depths.
HWY_INLINE uint32_t boxes_met(const WideGrid& grid, const float* planes, const PacketSlopes& slopes,
                              float z_low, float z_high, float farthest) {
    const F32 d;
    const float reach = std::max(std::abs(z_low), std::abs(z_high));
    const float ux = 0.5f * (slopes.ux_low + slopes.ux_high), uy = 0.5f * (slopes.uy_low + slopes.uy_high);
    // A little more than half, for the middle is rounded.
    const float dx = 0.50001f * (slopes.ux_high - slopes.ux_low) + 0x1p-22f * std::abs(ux),
                dy = 0.50001f * (slopes.uy_high - slopes.uy_low) + 0x1p-22f * std::abs(uy);
    const auto boxes = static_cast<size_t>(grid.box_count());
    VF near = hn::Set(d, z_low), far = hn::Set(d, std::min(z_high, farthest + grid.slack));
    for (size_t k = 0; k < 3; ++k) {
        const float* axis = grid.axis[k];
        const VF grow = hn::Set(d, reach * (std::abs(axis[0]) * dx + std::abs(axis[1]) * dy));
        const float along = axis[0] * ux + axis[1] * uy + axis[2];
        const VF inverse = hn::Set(
            d, 1.0f / (std::abs(along) < bundle_detail::kLeastDirection ? bundle_detail::kLeastDirection
                                                                        : along));
        const VF a = hn::Mul(hn::Sub(hn::LoadU(d, planes + k * boxes), grow), inverse);
        const VF b = hn::Mul(hn::Add(hn::LoadU(d, planes + (3 + k) * boxes), grow), inverse);
        near = hn::Max(near, hn::Min(a, b)), far = hn::Min(far, hn::Max(a, b));
    }
    return static_cast<uint32_t>(hn::And(hn::Le(near, far), hn::FirstN(d, boxes)).raw);
}

/// The micropolygons of a block that some ray of a packet may hit. Exact in floats: the predicate's roundings
/// are monotone in the slope.
HWY_INLINE uint32_t micropolygons_met(const BlockView& block, const PacketSlopes& slopes) {
    const F32 d;
    const CornerLookup lookup(block);
    VF own[3], behind[3];
    for (int k = 0; k < 3; ++k) lookup.load(k, own[k], behind[k]);
    VF met_low[2], met_high[2];  // of a, then b, over a micropolygon's corners
    for (int k = 0; k < 2; ++k) {
        const VF from = hn::Set(d, k == 0 ? slopes.ux_low : slopes.uy_low),
                 to = hn::Set(d, k == 0 ? slopes.ux_high : slopes.uy_high);
        const auto offsets = [&](VF x, VF z, VF& low, VF& high) HWY_ATTR {
            const VF p = hn::Mul(from, z), q = hn::Mul(to, z);
            low = hn::Sub(x, hn::Max(p, q)), high = hn::Sub(x, hn::Min(p, q));
        };
        VF low, high, low_behind, high_behind;
        offsets(own[k], own[2], low, high);
        offsets(behind[k], behind[2], low_behind, high_behind);
        met_low[k] = low, met_high[k] = high;
        for (int corner = 1; corner < 4; ++corner) {
            met_low[k] = hn::Min(met_low[k], lookup.corner(corner, low, low_behind));
            met_high[k] = hn::Max(met_high[k], lookup.corner(corner, high, high_behind));
        }
    }
    const VF zero = hn::Zero(d);
    const MF met = hn::And(hn::And(hn::Le(met_low[0], zero), hn::Ge(met_high[0], zero)),
                           hn::And(hn::Le(met_low[1], zero), hn::Ge(met_high[1], zero)));
    return static_cast<uint32_t>(met.raw);
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

#else
inline constexpr bool kHasSharpPackets = false;
#endif

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
