/// One ray against all micropolygons of a block at once: lanes are micropolygons. Compiled once a target.
#if defined(TRAPEZE_ACCEL_WHOLE_BLOCK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRAPEZE_ACCEL_WHOLE_BLOCK_INL_H_
#undef TRAPEZE_ACCEL_WHOLE_BLOCK_INL_H_
#else
#define TRAPEZE_ACCEL_WHOLE_BLOCK_INL_H_
#endif

#include <hwy/highway.h>

#include "accel/wide/block_hits-inl.h"
#include "core/simd/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The vertices of a block's micropolygons, one a lane from number `first` (v * 4 + u) on, in kParts vectors
/// of which each corner is a shuffle: what is done to vertices is done to the parts.
class BlockParts {
  public:
#if HWY_TARGET <= HWY_AVX3 && HWY_ARCH_X86
    // Sixteen lanes are all of a block: `first` is 0 whenever this is made.
    static constexpr size_t kParts = 2;  ///< the tile, and what lies behind it
    BlockParts(const BlockView& block, int) : lookup_(block) {}
    HWY_INLINE void load(int plane, VF* parts) const {
        lookup_.load(plane, parts[0], parts[1]);
    }
    /// Corner 00, 10, 01 or 11 (0 to 3) of each lane's micropolygon.
    HWY_INLINE VF corner(int corner, const VF* parts) const {
        return corner == 0 ? parts[0] : lookup_.corner(corner, parts[0], parts[1]);
    }

  private:
    CornerLookup lookup_;
#elif HWY_TARGET == HWY_SCALAR
    static constexpr size_t kParts = 4;  ///< the corners
    BlockParts(const BlockView& block, int first) : block_(block), first_(first) {}
    HWY_INLINE void load(int plane, VF* parts) const {
        const float* tile = block_.tile + static_cast<size_t>(plane) * block_.plane;
        for (int c = 0; c < 4; ++c)
            parts[c] = hn::Set(F32(), tile[block_.offset((first_ & 3) + (c & 1), (first_ >> 2) + (c >> 1))]);
    }
    HWY_INLINE VF corner(int corner, const VF* parts) const {
        return parts[corner];
    }

  private:
    const BlockView& block_;
    int first_;
#else
    // Four or eight lanes are one or two rows of a block, from row first / 4 on.
    static constexpr size_t kParts =
        4;  ///< rows, what is right of them, the next rows, what is right of those
    BlockParts(const BlockView& block, int first) : block_(block), first_(first) {}
    HWY_INLINE void load(int plane, VF* parts) const {
        const F32 d;
        const float* tile = block_.tile + static_cast<size_t>(plane) * block_.plane;
        parts[0] = hn::LoadU(d, tile + first_);
        parts[1] = hn::LoadU(d, tile + block_.right + first_);
        parts[2] = next_rows(tile);
        parts[3] = next_rows(tile + block_.right);
    }
    HWY_INLINE VF corner(int corner, const VF* parts) const {
        // A row of four without its first, and the first of what is right of it. The shift is within each 128
        // bits, which are a row.
        return corner & 1 ? hn::CombineShiftRightBytes<4>(F32(), parts[corner], parts[corner - 1])
                          : parts[corner];
    }

  private:
    /// The vertices one row further on: in the same tile, but for its last row, which the first of the tile
    /// below follows.
    HWY_INLINE VF next_rows(const float* tile) const {
        const F32 d;
        static_assert(hn::MaxLanes(d) == 4 || hn::MaxLanes(d) == 8);
        if (first_ + static_cast<int>(hn::MaxLanes(d)) < 16) return hn::LoadU(d, tile + first_ + 4);
#if HWY_TARGET == HWY_AVX2
        const hn::Half<F32> row;
        return hn::Combine(d, hn::LoadU(row, tile + block_.down), hn::LoadU(row, tile + 12));
#else
        return hn::LoadU(d, tile + block_.down);
#endif
    }

    const BlockView& block_;
    int first_;
#endif
};

/// A ray as a block's micropolygons are tested against it.
struct BlockRay {
    AxisRay axis;
    int planes[3] = {0, 1, 2};  ///< which coordinates of space the axes are (TurnedRay)
    float local = 0;            ///< time in the grid's motion segment
};

/// Which of the block's micropolygons from number `first` on the ray hits, a bit each, and the predicate's
/// depths of those; at most as many as there are lanes.
template <bool kMotion>
HWY_INLINE uint32_t hit_micropolygons(const BlockView& block, int columns, Facing facing, int first,
                                      const BlockRay& ray, VF& depth) {
    constexpr size_t kParts = BlockParts::kParts;
    const F32 d;
    const BlockParts lookup(block, first);
    // A coordinate of the turned axes. Vertices are moved in time before corners are taken of them: each is
    // moved once, and not for each of its micropolygons.
    const auto load = [&](int k, VF* parts) HWY_ATTR {
        lookup.load(ray.planes[k], parts);
        if constexpr (kMotion) {
            VF delta[kParts];
            lookup.load(3 + ray.planes[k], delta);
#pragma GCC unroll 4
            for (size_t p = 0; p < kParts; ++p)
                parts[p] = position_at(parts[p], delta[p], hn::Set(d, ray.local));
        }
    };
    VF a[kParts], b[kParts], z[kParts];
    load(0, a), load(1, b), load(2, z);
#pragma GCC unroll 4
    for (size_t p = 0; p < kParts; ++p) {
        const VF dz = hn::Sub(z[p], hn::Set(d, ray.axis.oz));
        a[p] = predicate_lanes::offset(a[p], hn::Set(d, ray.axis.ox), hn::Set(d, ray.axis.ux), dz);
        b[p] = predicate_lanes::offset(b[p], hn::Set(d, ray.axis.oy), hn::Set(d, ray.axis.uy), dz);
    }
    QuadLanes<VF> q;
    q.a00 = lookup.corner(k00, a), q.b00 = lookup.corner(k00, b);
    q.a10 = lookup.corner(k10, a), q.b10 = lookup.corner(k10, b);
    q.a01 = lookup.corner(k01, a), q.b01 = lookup.corner(k01, b);
    q.a11 = lookup.corner(k11, a), q.b11 = lookup.corner(k11, b);
    const MF hit = inside(d, q);
    if (hn::AllFalse(d, hit)) return 0;
    q.z00 = lookup.corner(k00, z), q.z10 = lookup.corner(k10, z);
    q.z01 = lookup.corner(k01, z), q.z11 = lookup.corner(k11, z);
    // Places past the grid's end repeat vertices: they are no micropolygons.
    const uint32_t real = (0x1111u * ((1u << columns) - 1) & ((1u << 4 * block.rows) - 1)) >> first;
    return mask_bits(d, hn::And(hit, depth_inside(d, q, facing, depth))) & real;
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
