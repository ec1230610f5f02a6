/// Noise on an integer lattice of one to four dimensions, from a hash of the lattice point.
///
/// Gradient noise is Perlin's improved noise [Perlin02] with a hash in place of his table: a polynomial of
/// fifth degree fades between the corners of a cell, and each corner's hash picks a gradient:
/// +-1 to +-8 in one dimension, the (+-1, +-2) and (+-2, +-1) in two, the edges of a cube in three and of a
/// hypercube in four. Sums are scaled to the contrast of other renderers' noise (docs/fidelity.md), a
/// standard deviation of about 0.085 around 0.5, which leaves them within 0.1..0.9. Noise at lattice points
/// is exactly 0.5. Three values come from different bits of one hash.
///
/// Coordinates are clamped to +-2^22, where floats still have halves; NaN is taken as 2^22.
#if defined(TRAPEZE_SHADE_VM_NOISE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRAPEZE_SHADE_VM_NOISE_INL_H_
#undef TRAPEZE_SHADE_VM_NOISE_INL_H_
#else
#define TRAPEZE_SHADE_VM_NOISE_INL_H_
#endif

#include "shade/vm/kernels/operands-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze::vm::HWY_NAMESPACE {

/// A lattice point's hash begins as its coordinates times these, exclusive-ored.
inline constexpr uint32_t kAxisFactors[] = {0x8da6b343u, 0xd8163841u, 0xcb1ab31fu, 0x9e3779b1u};

/// Two rounds of a multiplicative mixer: each of the high bits depends on all bits.
HWY_INLINE VU mix_bits(VU h, uint32_t last_factor = 0x297a2d39u) {
    const DU du;
    h = hn::Mul(hn::Xor(h, hn::ShiftRight<15>(h)), hn::Set(du, 0x2c1b3c6du));
    return hn::Mul(hn::Xor(h, hn::ShiftRight<12>(h)), hn::Set(du, last_factor));
}

/// One coordinate in its cell: what it gives to the hash of the cell's low and high corners, where it is
/// from there, and how much the high one counts.
struct NoiseAxis {
    VU hash[2];
    V offset[2];
    V weight;
};

/// A whole number modulo a whole period, both exact in floats. The quotient may be off by one, which the last
/// two steps correct.
HWY_INLINE V wrap(V x, V period) {
    const V r = hn::Sub(x, hn::Mul(period, hn::Floor(hn::Div(x, period))));
    const V up = hn::Add(r, hn::IfThenElseZero(hn::Lt(r, hn::Zero(D())), period));
    return hn::Sub(up, hn::IfThenElseZero(hn::Ge(up, period), period));
}

/// Finds the cell of a coordinate. `periodic`: the lattice repeats after `period`, a whole number of at
/// least 1. `factor`: multiplies the lattice's whole numbers, a different one on each axis, for the hash.
template <bool periodic>
HWY_INLINE NoiseAxis noise_axis(V coordinate, V period, uint32_t factor) {
    const DI di;
    const DU du;
    const V x = clamp_to_lattice(coordinate);
    const V low = hn::Floor(x), one = set(1);
    const V offset = hn::Sub(x, low);
    VI i = hn::ConvertTo(di, low), j = hn::Add(i, hn::Set(di, 1));
    if constexpr (periodic) {
        const V first = wrap(low, period), next = hn::Add(first, one);
        i = hn::ConvertTo(di, first);
        j = hn::ConvertTo(di, hn::IfThenZeroElse(hn::Ge(next, period), next));
    }
    const VU f = hn::Set(du, factor);
    return {{hn::Mul(hn::BitCast(du, i), f), hn::Mul(hn::BitCast(du, j), f)},
            {offset, hn::Sub(offset, one)},
            fade(offset)};
}

/// x with its sign flipped where the highest bit of `bits` is set.
HWY_INLINE V flip(V x, VU bits) {
    return hn::Xor(x, hn::BitCast(D(), hn::And(bits, hn::Set(DU(), 0x80000000u))));
}
/// `yes` where the highest bit is set.
HWY_INLINE V choose(VU bits, V yes, V no) {
#if HWY_TARGET == HWY_SCALAR  // whose IfNegativeThenElse() compares, and so misses -0 and NaN
    return static_cast<int32_t>(hn::GetLane(bits)) < 0 ? yes : no;
#elif HWY_TARGET == HWY_EMU128  // alike
    const VI signs = hn::BroadcastSignBit(hn::BitCast(DI(), bits));
    return hn::IfThenElse(hn::MaskFromVec(hn::BitCast(D(), signs)), yes, no);
#else
    return hn::IfNegativeThenElse(hn::BitCast(D(), bits), yes, no);
#endif
}

/// The gradient picked by the hash's highest bits, times the offset from the corner.
HWY_INLINE V gradient(VU h, const V (&x)[1]) {
    const VU size = hn::Add(hn::And(hn::ShiftRight<28>(h), hn::Set(DU(), 7)), hn::Set(DU(), 1));
    return flip(hn::Mul(hn::ConvertTo(D(), hn::BitCast(DI(), size)), x[0]), h);
}

/// One bit chooses which axis counts twice, two more the signs.
HWY_INLINE V gradient(VU h, const V (&x)[2]) {
    const VU swap = hn::ShiftLeft<2>(h);
    const V once = choose(swap, x[1], x[0]), twice = choose(swap, x[0], x[1]);
    return hn::Add(flip(once, h), flip(hn::Add(twice, twice), hn::ShiftLeft<1>(h)));
}
/// Perlin's sixteen: the twelve edges, four of them, which form a tetrahedron, twice.
HWY_INLINE V gradient(VU h, const V (&x)[3]) {
    const VU h1 = hn::ShiftLeft<1>(h), h2 = hn::ShiftLeft<2>(h), h3 = hn::ShiftLeft<3>(h);
    const V a = choose(h, x[1], x[0]);
    const V b = choose(hn::Or(h, h1), choose(hn::AndNot(h3, hn::And(h, h1)), x[0], x[2]), x[1]);
    return hn::Add(flip(a, h3), flip(b, h2));
}

/// Two bits choose the axis that is left out, three the signs of the others: the 32 edges' midpoints of a
/// hypercube.
HWY_INLINE V gradient(VU h, const V (&x)[4]) {
    const VU h1 = hn::ShiftLeft<1>(h);
    const V a = choose(hn::And(h, h1), x[1], x[0]);
    const V b = choose(h, x[2], x[1]);
    const V c = choose(hn::Or(h, h1), x[3], x[2]);
    return hn::Add(hn::Add(flip(a, hn::ShiftLeft<4>(h)), flip(b, hn::ShiftLeft<3>(h))),
                   flip(c, hn::ShiftLeft<2>(h)));
}

/// Between the corners of a cell whose coordinates after `axis` are settled: `hash` has their part, and
/// `offset` their offsets.
template <int axis, int dimensions, int width>
HWY_INLINE void blend_corners(const NoiseAxis (&axes)[dimensions], VU hash, V (&offset)[dimensions],
                              V (&out)[width]) {
    if constexpr (axis < 0) {
        const VU h = mix_bits(hash);
        out[0] = gradient(h, offset);
        if constexpr (width == 3) {
            out[1] = gradient(hn::ShiftLeft<5>(h), offset);
            out[2] = gradient(hn::ShiftLeft<10>(h), offset);
        }
    } else {
        V high[width];
        offset[axis] = axes[axis].offset[0];
        blend_corners<axis - 1>(axes, hn::Xor(hash, axes[axis].hash[0]), offset, out);
        offset[axis] = axes[axis].offset[1];
        blend_corners<axis - 1>(axes, hn::Xor(hash, axes[axis].hash[1]), offset, high);
        for (int k = 0; k < width; ++k) out[k] = lerp(axes[axis].weight, out[k], high[k]);
    }
}

/// By dimensions. Deviations are 0.0865, 0.085, 0.088 and 0.088; in planes of the lattice, where shaders
/// often look at three dimensions, 0.081.
inline constexpr float kNoiseScales[] = {0.0703f, 0.1762f, 0.3259f, 0.3006f};

template <int dimensions, int width>
/// The weighted sum over the corners, scaled and moved around 0.5 (see above).
HWY_INLINE void gradient_noise(const NoiseAxis (&axes)[dimensions], V (&out)[width]) {
    V offset[dimensions];
    blend_corners<dimensions - 1>(axes, hn::Zero(DU()), offset, out);
    for (int k = 0; k < width; ++k)
        out[k] = hn::Add(hn::Mul(out[k], set(kNoiseScales[dimensions - 1])), set(0.5f));
}

/// The high 24 bits as a number in [0, 1).
HWY_INLINE V unit_float(VU h) {
    return hn::Mul(hn::ConvertTo(D(), hn::BitCast(DI(), hn::ShiftRight<8>(h))), set(5.9604644775390625e-8f));
}

/// The last round's factors for the components of a triple.
inline constexpr uint32_t kComponentFactors[] = {0x297a2d39u, 0x85ebca6bu, 0xc2b2ae35u};

}  // namespace trapeze::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
