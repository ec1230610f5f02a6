/// A block of 4 x 4 micropolygons between three pairs of parallel planes along its own sides. The boxes of a
/// grid are in the axes of the whole grid: where it is curved or sheared, two rays in three that meet a
/// block's box pass the block by. These planes are found anew for every bundle that comes to a block, for
/// they cost less than fetching them from memory would, and let through few rays that miss. Compiled once a
/// target.
#if defined(TRAPEZE_ACCEL_BLOCK_SLABS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRAPEZE_ACCEL_BLOCK_SLABS_INL_H_
#undef TRAPEZE_ACCEL_BLOCK_SLABS_INL_H_
#else
#define TRAPEZE_ACCEL_BLOCK_SLABS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>

#include "accel/wide/block_hits-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The space between two parallel planes: points p of camera space with |axis . p - center| <= half, center
/// and half linear in the segment's local time. Axes are of about unit length (their largest component is 1).
struct BlockSlab {
    float axis[3];
    float center, half, center_delta, half_delta;
};

/// The three slabs whose intersection holds the block's vertices at all times of the segment.
struct BlockSlabs {
    BlockSlab thick;    ///< across the block
    BlockSlab side[2];  ///< along it
};

/// Scales a vector's largest component to 1; false where it has no direction that floats can tell.
HWY_INLINE bool scale_to_one(float* v) {
    const float most = std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
    if (!(most > 1e-30f && most < 1e30f)) return false;
    const float scale = 1 / most;
    v[0] *= scale, v[1] *= scale, v[2] *= scale;
    return true;
}

/// a x b, to `to`; in floats, for an axis that is a little off bounds as well as any other.
HWY_INLINE void cross(const float* a, const float* b, float* to) {
    to[0] = a[1] * b[2] - a[2] * b[1];
    to[1] = a[2] * b[0] - a[0] * b[2];
    to[2] = a[0] * b[1] - a[1] * b[0];
}

/// A block's 25 vertices, in two times sixteen places: whole vectors. The seven places to spare repeat a
/// vertex of the block, which changes no bound.
struct BlockVertices {
    HWY_ALIGN float own[3][16], behind[3][16];

    /// Takes three planes of positions, from first_plane on: 0 positions, 3 how far they move.
    HWY_INLINE void load(const BlockView& block, int first_plane) {
        for (int k = 0; k < 3; ++k) {
#if HWY_TARGET <= HWY_AVX3 && HWY_ARCH_X86
            VF first, others;
            CornerLookup::load(block, first_plane + k, first, others);
            hn::Store(first, F32(), own[k]);
            hn::Store(others, F32(), behind[k]);
#else
            const float* tile = block.tile + static_cast<size_t>(first_plane + k) * block.plane;
            std::copy_n(tile, 16, own[k]);
            for (int i = 0; i < 4; ++i) behind[k][i] = tile[block.right + 4 * i];
            std::copy_n(tile + block.down, 4, behind[k] + 4);
            std::fill_n(behind[k] + 8, 8, tile[block.down + block.right]);
#endif
        }
    }
    /// Moves the vertices, which are at the segment's start, to its end. `delta`: the planes DX DY DZ, loaded
    /// alike.
    HWY_INLINE void add(const BlockVertices& delta) {
        const F32 d;
        for (int k = 0; k < 3; ++k)
            for (size_t i = 0; i < 16; i += hn::Lanes(d)) {
                hn::Store(hn::Add(hn::Load(d, own[k] + i), hn::Load(d, delta.own[k] + i)), d, own[k] + i);
                hn::Store(hn::Add(hn::Load(d, behind[k] + i), hn::Load(d, delta.behind[k] + i)), d,
                          behind[k] + i);
            }
    }
    /// The range of all vertices along an axis, as its middle and half its width.
    HWY_INLINE void span(const float* axis, float& center, float& half_width) const {
        const F32 d;
        const VF x = hn::Set(d, axis[0]), y = hn::Set(d, axis[1]), z = hn::Set(d, axis[2]);
        VF low = hn::Set(d, HUGE_VALF), high = hn::Set(d, -HUGE_VALF);
        for (size_t i = 0; i < 16; i += hn::Lanes(d))
            for (const auto& at : {own, behind}) {
                const VF p =
                    hn::MulAdd(x, hn::Load(d, at[0] + i),
                               hn::MulAdd(y, hn::Load(d, at[1] + i), hn::Mul(z, hn::Load(d, at[2] + i))));
                low = hn::Min(low, p), high = hn::Max(high, p);
            }
        const float least = hn::GetLane(hn::MinOfLanes(d, low)), most = hn::GetLane(hn::MaxOfLanes(d, high));
        center = 0.5f * (least + most), half_width = 0.5f * (most - least);
    }
};

/// Finds the axes at the segment's start: the block's normal, and in its plane the normals of the mean edges
/// along u and along v. False where the block has no area that floats can tell.
HWY_INLINE bool slab_axes(const BlockView& block, BlockSlabs& slabs) {
    float u[3], v[3];
    for (size_t k = 0; k < 3; ++k) {
        const float* tile = block.tile + k * block.plane;
        const float p00 = tile[0], p40 = tile[block.right], p04 = tile[block.down],
                    p44 = tile[block.down + block.right];
        u[k] = (p40 - p00) + (p44 - p04);
        v[k] = (p04 - p00) + (p44 - p40);
    }
    float* normal = slabs.thick.axis;
    cross(u, v, normal);
    if (!scale_to_one(normal)) return false;
    cross(normal, u, slabs.side[0].axis);
    cross(normal, v, slabs.side[1].axis);
    return scale_to_one(slabs.side[0].axis) && scale_to_one(slabs.side[1].axis);
}

/// Finds a block's slabs; false where its vertices make no plane. `grow`: what rounds away between a vertex
/// and the test of a ray, WideTree's for vertices and rays like these. Slabs are linear in time between those
/// at the segment's ends, and so hold vertices, which move linearly, at all times.
template <bool kMotion>
HWY_INLINE bool slabs_of(const BlockView& block, float grow, BlockSlabs& slabs) {
    if (!slab_axes(block, slabs)) return false;
    BlockVertices at, delta;
    at.load(block, 0);
    if constexpr (kMotion) delta.load(block, 3);
    BlockSlab* all[3] = {&slabs.thick, &slabs.side[0], &slabs.side[1]};
    // Products of what is tested round, too.
    const auto grown = [grow](float half_width) { return half_width * (1 + 0x1p-12f) + grow; };
    for (BlockSlab* slab : all) {
        at.span(slab->axis, slab->center, slab->half);
        slab->half = grown(slab->half);
    }
    if constexpr (kMotion) {
        at.add(delta);
        for (BlockSlab* slab : all) {
            float center, half_width;
            at.span(slab->axis, center, half_width);
            slab->center_delta = center - slab->center;
            slab->half_delta = grown(half_width) - slab->half;
        }
    }
    return true;
}

/// Lanes of rays that miss the block for certain: from where a ray enters to where it leaves the slab across
/// the block, it is beside one of the slabs along it. Comparisons with NaN leave a ray in.
template <bool kMotion, bool kLens>
HWY_INLINE MF misses(const BlockSlabs& slabs, const RayLanes& r) {
    const F32 d;
    const auto along = [&](const BlockSlab& s) HWY_ATTR {
        return hn::MulAdd(hn::Set(d, s.axis[0]), r.ux,
                          hn::MulAdd(hn::Set(d, s.axis[1]), r.uy, hn::Set(d, s.axis[2])));
    };
    /// The distance along the slab's axis from the ray's origin to the slab's middle.
    const auto distance = [&](const BlockSlab& s) HWY_ATTR {
        VF center = hn::Set(d, s.center);
        if constexpr (kMotion) center = hn::MulAdd(r.local, hn::Set(d, s.center_delta), center);
        if constexpr (kLens)
            center = hn::NegMulAdd(hn::Set(d, s.axis[0]), r.ox,
                                   hn::NegMulAdd(hn::Set(d, s.axis[1]), r.oy, center));
        return center;
    };
    const auto half_of = [&](const BlockSlab& s) HWY_ATTR {
        VF value = hn::Set(d, s.half);
        if constexpr (kMotion) value = hn::MulAdd(r.local, hn::Set(d, s.half_delta), value);
        return value;
    };
    // In the slab across, the depth is within `reach` of `depth`; on that way the ray moves by slope * reach
    // along an axis in the plane.
    const VF inverse = reciprocal(along(slabs.thick));
    const VF depth = hn::Mul(distance(slabs.thick), inverse),
             reach = hn::Abs(hn::Mul(half_of(slabs.thick), inverse));
    const auto beside = [&](const BlockSlab& s) HWY_ATTR {
        const VF slope = along(s);
        return hn::Gt(hn::Abs(hn::MulSub(slope, depth, distance(s))),
                      hn::MulAdd(hn::Abs(slope), reach, half_of(s)));
    };
    return hn::Or(beside(slabs.side[0]), beside(slabs.side[1]));
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
