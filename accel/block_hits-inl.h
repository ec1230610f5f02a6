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

#include "core/hit_micropolygon-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using F32 = hn::ScalableTag<float>;
using I32 = hn::RebindToSigned<F32>;
using VF = hn::Vec<F32>;
using VI = hn::Vec<I32>;
using MF = hn::Mask<F32>;

/// A block's vertices in a plane: those of a tile and, where `right` and `down` say, the first column and
/// row of the tiles behind it. At the grid's end, where there is no such tile, they repeat the last ones.
struct BlockView {
    const float* tile;  ///< of the plane x
    size_t plane;       ///< floats to the planes y, z, dx, dy, dz
    int right, down;    ///< offsets of the fifth column and row
    int rows;           ///< of micropolygons

    int offset(int i, int j) const { return (j < 4 ? j * 4 : down) + (i < 4 ? i : right); }
};

/// Lanes of rays; oz is 0. `local` is the time within the grid's motion segment.
struct RayLanes {
    VF ox, oy, ux, uy, local;
};

/// (bi ^ bj) & chosen, in the sign bits.
HWY_INLINE VF crossing_bits(VF bi, VF bj, VF chosen) {
#if HWY_TARGET <= HWY_AVX3 && HWY_ARCH_X86
    return VF{_mm512_castsi512_ps(_mm512_ternarylogic_epi32(
        _mm512_castps_si512(bi.raw), _mm512_castps_si512(bj.raw), _mm512_castps_si512(chosen.raw), 0x28))};
#else
    return hn::And(hn::Xor(bi, bj), chosen);
#endif
}

HWY_INLINE VF edge_bits(VF ai, VF bi, VF aj, VF bj) {
    const VF x = hn::Mul(ai, bj), y = hn::Mul(aj, bi);
    return crossing_bits(bi, bj, predicate_lanes::sign_chosen(bj, hn::Sub(x, y), hn::Sub(y, x)));
}

HWY_INLINE VF or3(VF a, VF b, VF c) {
    return hn::Or3(a, b, c);
}
HWY_INLINE VF xor3(VF a, VF b, VF c) {
    return hn::Xor3(a, b, c);
}

/// A vertex along the rays to their plane.
template <bool kMoves, bool kLens>
HWY_INLINE void vertex_offset(const BlockView& block, int i, int j, const RayLanes& r, VF& a, VF& b) {
    const F32 d;
    const float* p = block.tile + block.offset(i, j);
    const size_t s = block.plane;
    VF x = hn::Set(d, p[0]), y = hn::Set(d, p[s]), z = hn::Set(d, p[2 * s]);
    if constexpr (kMoves) {
        x = position_at(x, hn::Set(d, p[3 * s]), r.local);
        y = position_at(y, hn::Set(d, p[4 * s]), r.local);
        z = position_at(z, hn::Set(d, p[5 * s]), r.local);
    }
    if constexpr (kLens) x = hn::Sub(x, r.ox), y = hn::Sub(y, r.oy);
    a = hn::Sub(x, hn::Mul(r.ux, z));
    b = hn::Sub(y, hn::Mul(r.uy, z));
}

/// What rays hit in a block, in sign bits.
struct BlockBits {
    VF any, several;                  ///< one micropolygon at least; two at least
    VF column0, column1, row0, row1;  ///< bits of u and v in the block; meaningful for exactly one
};

template <bool kMoves, bool kLens, int kColumns>
HWY_INLINE BlockBits block_bits(const BlockView& block, const RayLanes& r) {
    const VF zero = hn::Zero(F32());
    VF a[kColumns + 1], b[kColumns + 1], bottom[kColumns];
#pragma GCC unroll 5
    for (int i = 0; i <= kColumns; ++i) vertex_offset<kMoves, kLens>(block, i, 0, r, a[i], b[i]);
#pragma GCC unroll 4
    for (int i = 0; i < kColumns; ++i) bottom[i] = edge_bits(a[i], b[i], a[i + 1], b[i + 1]);

    BlockBits bits{zero, zero, zero, zero, zero, zero};
#pragma GCC unroll 4
    for (int j = 0; j < 4; ++j) {
        if (j >= block.rows) break;
        VF na[kColumns + 1], nb[kColumns + 1], side[kColumns + 1], top[kColumns], hit[kColumns];
#pragma GCC unroll 5
        for (int i = 0; i <= kColumns; ++i) {
            vertex_offset<kMoves, kLens>(block, i, j + 1, r, na[i], nb[i]);
            side[i] = edge_bits(a[i], b[i], na[i], nb[i]);
        }
#pragma GCC unroll 4
        for (int i = 0; i < kColumns; ++i) top[i] = edge_bits(na[i], nb[i], na[i + 1], nb[i + 1]);
#pragma GCC unroll 4
        for (int i = 0; i < kColumns; ++i) {
            hit[i] = hn::Xor(xor3(bottom[i], top[i], side[i]), side[i + 1]);
            bits.several = hn::OrAnd(bits.several, bits.any, hit[i]);
            bits.any = hn::Or(bits.any, hit[i]);
        }
        VF row = hit[0];
        if constexpr (kColumns == 4) {
            bits.column0 = or3(bits.column0, hit[1], hit[3]);
            bits.column1 = or3(bits.column1, hit[2], hit[3]);
            row = hn::Or(or3(hit[0], hit[1], hit[2]), hit[3]);
        }
        if (j & 1) bits.row0 = hn::Or(bits.row0, row);
        if (j & 2) bits.row1 = hn::Or(bits.row1, row);
#pragma GCC unroll 5
        for (int i = 0; i <= kColumns; ++i) a[i] = na[i], b[i] = nb[i];
#pragma GCC unroll 4
        for (int i = 0; i < kColumns; ++i) bottom[i] = top[i];
    }
    return bits;
}

/// The micropolygon's u and v in the block, of lanes that hit exactly one.
HWY_INLINE void decode(const BlockBits& bits, VI& u, VI& v) {
    const I32 di;
    const hn::RebindToUnsigned<F32> du;
    const auto top = [&](VF x) HWY_ATTR { return hn::ShiftRight<31>(hn::BitCast(du, x)); };
    u = hn::BitCast(di, hn::Or(top(bits.column0), hn::ShiftLeft<1>(top(bits.column1))));
    v = hn::BitCast(di, hn::Or(top(bits.row0), hn::ShiftLeft<1>(top(bits.row1))));
}

/// Depths of the rays' hits on micropolygon (u, v) of the block, each lane its own; true where the predicate
/// confirms.
template <bool kMoves, bool kLens>
HWY_INLINE MF depth_at(const BlockView& block, const RayLanes& r, VI u, VI v, Facing facing, VF& depth) {
    const F32 d;
    const I32 di;
    const VI three = hn::Set(di, 3), one = hn::Set(di, 1), four = hn::Set(di, 4);
    const VI row = hn::ShiftLeft<2>(v);
    const VI next_row = hn::IfThenElse(hn::Eq(v, three), hn::Set(di, block.down), hn::Add(row, four));
    const VI next_column = hn::IfThenElse(hn::Eq(u, three), hn::Set(di, block.right), hn::Add(u, one));
    const VI at[4] = {hn::Add(row, u), hn::Add(row, next_column), hn::Add(next_row, u),
                      hn::Add(next_row, next_column)};
    VF c[3][4];
#pragma GCC unroll 3
    for (int k = 0; k < 3; ++k)
#pragma GCC unroll 4
        for (int corner = 0; corner < 4; ++corner) {
            const float* plane = block.tile + static_cast<size_t>(k) * block.plane;
            c[k][corner] = hn::GatherIndex(d, plane, at[corner]);
            if constexpr (kMoves)
                c[k][corner] = position_at(c[k][corner],
                                           hn::GatherIndex(d, plane + 3 * block.plane, at[corner]), r.local);
        }
    const auto vertex = [&c](int k, int corner) HWY_ATTR { return c[k][corner]; };
    const VF zero = hn::Zero(d);
    return hit_micropolygon(d, kLens ? r.ox : zero, kLens ? r.oy : zero, zero, r.ux, r.uy, vertex, facing,
                            depth);
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
