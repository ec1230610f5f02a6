/// The vertices of a block of 4 x 4 micropolygons in two registers of sixteen lanes, of which each corner of
/// its micropolygons is one permutation. Compiled once a target. What permutes is a parameter: AVX-512's
/// registers or, so that every machine tests where corners are looked for, arrays (two_registers_test.cpp).
#if defined(TRAPEZE_ACCEL_TWO_REGISTERS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRAPEZE_ACCEL_TWO_REGISTERS_INL_H_
#undef TRAPEZE_ACCEL_TWO_REGISTERS_INL_H_
#else
#define TRAPEZE_ACCEL_TWO_REGISTERS_INL_H_
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

#include "accel/wide/block_view.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Vectors as wide as the target has them, which the -inl.h files of accel/wide share.
using F32 = hn::ScalableTag<float>;
using I32 = hn::RebindToSigned<F32>;
using VF = hn::Vec<F32>;
using VI = hn::Vec<I32>;
using MF = hn::Mask<F32>;

constexpr size_t kLanes = hn::MaxLanes(F32());

/// Looks up a block's vertices for sixteen lanes of micropolygons (u, v): corner 00, 10, 01, 11 of each, in
/// get()'s corners[0 .. 3], from any of the planes x, y, z, dx, dy, dz. Registers: as WideRegisters.
template <class Registers>
class TwoRegisterLookup {
  public:
    using Floats = typename Registers::Floats;
    using Ints = typename Registers::Ints;

    HWY_INLINE TwoRegisterLookup(const BlockView& block, Ints u, Ints v) : block_(block) {
        at_[0] = Registers::number_of(u, v);
        for (int c = 0; c < 3; ++c) at_[1 + c] = Registers::permuted(at_[0], Registers::load(kCorners[c]));
    }
    /// Every lane its own micropolygon, v * 4 + u.
    HWY_INLINE explicit TwoRegisterLookup(const BlockView& block) : block_(block) {
        at_[0] = Registers::numbers();
        for (int c = 0; c < 3; ++c) at_[1 + c] = Registers::load(kCorners[c]);
    }
    HWY_INLINE void load(int plane, Floats& own, Floats& behind) const { load(block_, plane, own, behind); }
    /// The tile's vertices, and the fifth column, row and corner; what is left repeats some of them.
    static HWY_INLINE void load(const BlockView& block, int plane, Floats& own, Floats& behind) {
        const float* tile = block.tile + static_cast<size_t>(plane) * block.plane;
        const Floats down = Registers::load_four(tile + block.down);
        const Floats last =
            Registers::picked(Registers::load_unaligned(tile + block.right), Registers::load(kBehind), down);
        own = Registers::load(tile);
        behind = Registers::with_lane_8(last, tile[block.down + block.right]);
    }
    /// Corner 10, 01 or 11 (1 to 3) of each lane's micropolygon, out of what load() gave.
    HWY_INLINE Floats corner(int corner, Floats own, Floats behind) const {
        return Registers::picked(own, at_[corner], behind);
    }
    HWY_INLINE void get(int plane, Floats* corners) const {
        Floats own, behind;
        load(plane, own, behind);
        corners[0] = Registers::permuted(at_[0], own);
        for (int c = 1; c < 4; ++c) corners[c] = corner(c, own, behind);
    }

  private:
    /// Where micropolygon v * 4 + u has its corners 10, 01 and 11 in two registers: places of 16 and more are
    /// in the second one.
    alignas(64) static constexpr int32_t kCorners[3][16] = {
        {1, 2, 3, 16, 5, 6, 7, 17, 9, 10, 11, 18, 13, 14, 15, 19},
        {4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 20, 21, 22, 23},
        {5, 6, 7, 17, 9, 10, 11, 18, 13, 14, 15, 19, 21, 22, 23, 24},
    };
    /// What the second register takes of the tile to the right (the first of each of its rows) and of the one
    /// below (its first row, at 16 to 19).
    alignas(64) static constexpr int32_t kBehind[16] = {0, 4, 8, 12, 16, 17, 18, 19, 0, 0, 0, 0, 0, 0, 0, 0};

    const BlockView& block_;
    Ints at_[4];
};

#if HWY_TARGET <= HWY_AVX3 && HWY_ARCH_X86
/// AVX-512's registers.
struct WideRegisters {
    using Floats = VF;
    using Ints = VI;

    static HWY_INLINE VF load(const float* at) { return VF{_mm512_load_ps(at)}; }
    static HWY_INLINE VI load(const int32_t* at) { return VI{_mm512_load_si512(at)}; }
    static HWY_INLINE VF load_unaligned(const float* at) { return VF{_mm512_loadu_ps(at)}; }
    /// Four floats in lanes 0 to 3; the others may be anything.
    static HWY_INLINE VF load_four(const float* at) { return VF{_mm512_castps128_ps512(_mm_loadu_ps(at))}; }
    /// The numbers 0 to 15, and v * 4 + u.
    static HWY_INLINE VI numbers() { return hn::Iota(I32(), 0); }
    static HWY_INLINE VI number_of(VI u, VI v) { return hn::Add(hn::ShiftLeft<2>(v), u); }
    /// Each lane the one of `from` that `at` says.
    static HWY_INLINE VI permuted(VI at, VI from) { return VI{_mm512_permutexvar_epi32(at.raw, from.raw)}; }
    static HWY_INLINE VF permuted(VI at, VF from) { return VF{_mm512_permutexvar_ps(at.raw, from.raw)}; }
    /// Each lane the one of a, or from 16 on of b, that `at` says.
    static HWY_INLINE VF picked(VF a, VI at, VF b) {
        return VF{_mm512_permutex2var_ps(a.raw, at.raw, b.raw)};
    }
    static HWY_INLINE VF with_lane_8(VF v, float value) {
        return VF{_mm512_mask_mov_ps(v.raw, 1 << 8, _mm512_set1_ps(value))};
    }
};
#endif

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
