/// Rays against a block of 4 x 4 micropolygons, without a branch on the way: lanes are rays. Every edge of
/// the block is decided once, in sign bits, by the arithmetic of hit_micropolygon(); the exclusive or of a
/// micropolygon's four edges says whether it is hit. Compiled once a target.
#if defined(TRAPEZE_ACCEL_BLOCK_HITS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRAPEZE_ACCEL_BLOCK_HITS_INL_H_
#undef TRAPEZE_ACCEL_BLOCK_HITS_INL_H_
#else
#define TRAPEZE_ACCEL_BLOCK_HITS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>

#include "accel/wide/block_view.h"
#include "accel/wide/two_registers-inl.h"
#include "accel/wide/wide_grid.h"
#include "core/hit_micropolygon-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The least component of a direction across a slab, as in accel/slabs.h: nearer ones are taken as this.
inline constexpr float kLeastDirection = 1e-18f;

/// One over v by an approximation and one Newton step instead of a division. Only for bounds, never for the
/// predicate.
HWY_INLINE VF reciprocal(VF v) {
    const F32 d;
    const VF least = hn::Set(d, kLeastDirection);
    v = hn::IfThenElse(hn::Lt(hn::Abs(v), least), least, v);
    const VF guess = hn::ApproximateReciprocal(v);
    return hn::Mul(guess, hn::NegMulAdd(v, guess, hn::Set(d, 2.0f)));
}

/// A block of up to 4 x 4 micropolygons of a grid in one motion segment, and what its hits are called.
struct SegmentBlock {
    BlockView view;
    int columns;
    Facing facing;
    bool opaque;
    uint32_t id;  ///< of its first micropolygon
    float slack;
};

/// Block (u, v), in blocks, of grid number `index`.
inline SegmentBlock block_of(const WideGrid& grid, int segment, int u, int v, uint32_t index) {
    const int tiles_u = grid.tiles_u(), tiles_v = grid.tiles_v();
    const size_t plane_size = grid.plane_size();
    SegmentBlock block;
    block.view.plane = plane_size;
    block.view.tile = grid.planes + static_cast<size_t>(segment) * 6 * plane_size +
                      static_cast<size_t>(v * tiles_u + u) * 16;
    // To the next tile; where there is none, to the last column and row of this one once more.
    block.view.right = u + 1 < tiles_u ? 16 : 3;
    block.view.down = v + 1 < tiles_v ? tiles_u * 16 : 12;
    block.view.rows = std::min(4, grid.nv - 4 * v);
    block.columns = std::min(4, grid.nu - 4 * u);
    block.facing = static_cast<Facing>(grid.facing);
    block.opaque = grid.opaque != 0;
    // MicropolygonId::packed() of micropolygon (4 u, 4 v).
    block.id = index << 8 | static_cast<uint32_t>(v) << 6 | static_cast<uint32_t>(u) << 2;
    block.slack = grid.slack();
    return block;
}

/// Fetches a block's vertices: up to four tiles of each plane, a cache line each. Inlined, as fetch() is.
HWY_INLINE void fetch_block(const SegmentBlock& block, size_t planes) {
    for (size_t k = 0; k < planes; ++k) {
        const float* tile = block.view.tile + k * block.view.plane;
        __builtin_prefetch(tile);
        __builtin_prefetch(tile + block.view.right);
        __builtin_prefetch(tile + block.view.down);
        __builtin_prefetch(tile + block.view.down + block.view.right);
    }
}

/// Lanes of camera rays: origins (ox, oy, 0), directions (ux, uy, 1). `local` is the time within the grid's
/// motion segment, in [0, 1].
struct RayLanes {
    VF ox, oy, ux, uy, local;
};

/// A vertex moved along the rays to their plane z = 0: the predicate's a and b, and |b|, which all edges at
/// the vertex need.
struct Offset {
    VF a, b, abs_b;
};

/// Whether the edge from p to q counts, in the sign bit; the same from q to p, bit for bit.
HWY_INLINE VF edge_bits(const Offset& p, const Offset& q) {
    return predicate_lanes::crossing(p.a, p.b, p.abs_b, q.a, q.b, q.abs_b);
}

/// Vertex (i, j) of a block at the rays' times, moved along them by the predicate's arithmetic. kMotion: the
/// grid moves, kLens: origins are not all 0.
template <bool kMotion, bool kLens>
HWY_INLINE Offset vertex_offset(const BlockView& block, int i, int j, const RayLanes& r) {
    const F32 d;
    const float* p = block.tile + block.offset(i, j);
    const size_t s = block.plane;
    VF x = hn::Set(d, p[0]), y = hn::Set(d, p[s]), z = hn::Set(d, p[2 * s]);
    if constexpr (kMotion) {
        x = position_at(x, hn::Set(d, p[3 * s]), r.local);
        y = position_at(y, hn::Set(d, p[4 * s]), r.local);
        z = position_at(z, hn::Set(d, p[5 * s]), r.local);
    }
    if constexpr (kLens) x = hn::Sub(x, r.ox), y = hn::Sub(y, r.oy);
    const VF a = hn::Sub(x, hn::Mul(r.ux, z)), b = hn::Sub(y, hn::Mul(r.uy, z));
    return {a, b, hn::Abs(b)};
}

/// What rays hit in a block, one answer a lane in the sign bits; the other bits mean nothing.
struct BlockBits {
    VF any, several;                  ///< one micropolygon at least; two at least
    VF column0, column1, row0, row1;  ///< bits of u and v in the block; meaningful for exactly one
};

/// Decides all micropolygons of a block for lanes of rays: each vertex is moved once and each edge decided
/// once for all micropolygons that share it. kColumns: 4, or 1 for the block of a ribbon. Columns past a
/// grid's end have no area: their two sides are the same edge, which cancels. Facing and depth are not looked
/// at.
template <bool kMotion, bool kLens, int kColumns>
HWY_INLINE BlockBits block_bits(const BlockView& block, const RayLanes& r) {
    const VF zero = hn::Zero(F32());
    Offset p[kColumns + 1];
    VF bottom[kColumns];
#pragma GCC unroll 5
    for (int i = 0; i <= kColumns; ++i) p[i] = vertex_offset<kMotion, kLens>(block, i, 0, r);
#pragma GCC unroll 4
    for (int i = 0; i < kColumns; ++i) bottom[i] = edge_bits(p[i], p[i + 1]);

    BlockBits bits{zero, zero, zero, zero, zero, zero};
#pragma GCC unroll 4
    for (int j = 0; j < 4; ++j) {
        if (j >= block.rows) break;
        Offset q[kColumns + 1];
        VF side[kColumns + 1], top[kColumns], hit[kColumns];
#pragma GCC unroll 5
        for (int i = 0; i <= kColumns; ++i) {
            q[i] = vertex_offset<kMotion, kLens>(block, i, j + 1, r);
            side[i] = edge_bits(p[i], q[i]);
        }
#pragma GCC unroll 4
        for (int i = 0; i < kColumns; ++i) top[i] = edge_bits(q[i], q[i + 1]);
#pragma GCC unroll 4
        for (int i = 0; i < kColumns; ++i)
            hit[i] = hn::Xor(hn::Xor3(bottom[i], top[i], side[i]), side[i + 1]);
        // `several`: two in this row, or one here and one in an earlier row. The bits of u and v are joined
        // by or, which tells the place where there is only one.
        VF row = hit[0];
        if constexpr (kColumns == 4) {
            const VF low = hn::Or(hit[0], hit[1]), high = hn::Or(hit[2], hit[3]);
            row = hn::Or(low, high);
            bits.several = hn::OrAnd(hn::OrAnd(bits.several, hit[0], hit[1]), hit[2], hit[3]);
            bits.several = hn::OrAnd(bits.several, low, high);
            bits.column0 = hn::Or3(bits.column0, hit[1], hit[3]);
            bits.column1 = hn::Or(bits.column1, high);
        }
        bits.several = hn::OrAnd(bits.several, bits.any, row);
        bits.any = hn::Or(bits.any, row);
        if (j & 1) bits.row0 = hn::Or(bits.row0, row);
        if (j & 2) bits.row1 = hn::Or(bits.row1, row);
#pragma GCC unroll 5
        for (int i = 0; i <= kColumns; ++i) p[i] = q[i];
#pragma GCC unroll 4
        for (int i = 0; i < kColumns; ++i) bottom[i] = top[i];
    }
    return bits;
}

/// The micropolygon's u and v in the block, 0 .. 3, of lanes that hit exactly one; other lanes get some place
/// within the block.
HWY_INLINE void decode(const BlockBits& bits, VI& u, VI& v) {
    const I32 di;
    const hn::RebindToUnsigned<F32> du;
    const auto top = [&](VF x) HWY_ATTR { return hn::ShiftRight<31>(hn::BitCast(du, x)); };
    u = hn::BitCast(di, hn::Or(top(bits.column0), hn::ShiftLeft<1>(top(bits.column1))));
    v = hn::BitCast(di, hn::Or(top(bits.row0), hn::ShiftLeft<1>(top(bits.row1))));
}

/// Looks up a block's vertices for lanes of micropolygons (u, v): corner 00, 10, 01, 11 of each, in get()'s
/// corners[0 .. 3], from any of the planes x, y, z, dx, dy, dz.
#if HWY_TARGET <= HWY_AVX3 && HWY_ARCH_X86
using CornerLookup = TwoRegisterLookup<WideRegisters>;
#else
class CornerLookup {
  public:
    /// Places of the corners in a plane, from the tile on: four floats a row, and beyond the fourth row or
    /// column where the view leads.
    CornerLookup(const BlockView& block, VI u, VI v) : block_(block) {
        const I32 di;
        const VI three = hn::Set(di, 3), row = hn::ShiftLeft<2>(v);
        const VI next_row =
            hn::IfThenElse(hn::Eq(v, three), hn::Set(di, block.down), hn::Add(row, hn::Set(di, 4)));
        const VI next_column =
            hn::IfThenElse(hn::Eq(u, three), hn::Set(di, block.right), hn::Add(u, hn::Set(di, 1)));
        at_[0] = hn::Add(row, u), at_[1] = hn::Add(row, next_column);
        at_[2] = hn::Add(next_row, u), at_[3] = hn::Add(next_row, next_column);
    }
    HWY_INLINE void get(int plane, VF* corners) const {
        const float* tile = block_.tile + static_cast<size_t>(plane) * block_.plane;
        for (int c = 0; c < 4; ++c) corners[c] = hn::GatherIndex(F32(), tile, at_[c]);
    }

  private:
    const BlockView& block_;
    VI at_[4];
};
#endif

/// Micropolygons (u, v) of the block, each lane its own, moved along the rays: what depth_inside() and
/// inside() read.
template <bool kMotion, bool kLens>
HWY_INLINE QuadLanes<VF> quads_at(const BlockView& block, const RayLanes& r, VI u, VI v) {
    const F32 d;
    const CornerLookup lookup(block, u, v);
    VF c[3][4];
#pragma GCC unroll 3
    for (int k = 0; k < 3; ++k) {
        lookup.get(k, c[k]);
        if constexpr (kMotion) {
            VF delta[4];
            lookup.get(3 + k, delta);
#pragma GCC unroll 4
            for (int corner = 0; corner < 4; ++corner)
                c[k][corner] = position_at(c[k][corner], delta[corner], r.local);
        }
    }
    const auto vertex = [&c](int k, int corner) HWY_ATTR { return c[k][corner]; };
    const VF zero = hn::Zero(d);
    return quad_lanes(kLens ? r.ox : zero, kLens ? r.oy : zero, zero, r.ux, r.uy, vertex);
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
