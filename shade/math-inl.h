/// Elementary functions on Highway vectors, for kernels.cpp: included once for each target. Only operations
/// that round alike everywhere: no fused multiply-add, no approximate reciprocals. Scalar twins, step by step
/// the same, are in scalar_kernels.h; their constants are explained there.
#if defined(TRAPEZE_SHADE_MATH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRAPEZE_SHADE_MATH_INL_H_
#undef TRAPEZE_SHADE_MATH_INL_H_
#else
#define TRAPEZE_SHADE_MATH_INL_H_
#endif

#include <hwy/highway.h>

#include "shade/planes.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze::kernels::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, kLanes>;
using DI = hn::RebindToSigned<D>;
using DU = hn::RebindToUnsigned<D>;
using V = hn::Vec<D>;
using VI = hn::Vec<DI>;
using VU = hn::Vec<DU>;

HWY_INLINE V set(float x) {
    return hn::Set(D(), x);
}
HWY_INLINE V load(ConstPlane p, size_t i) {
    return hn::Load(D(), p.data() + i);
}
HWY_INLINE void store(V v, Plane p, size_t i) {
    hn::Store(v, D(), p.data() + i);
}

/// max(0, x); 0 for NaN.
HWY_INLINE V positive(V x) {
    return hn::IfThenElseZero(hn::Gt(x, hn::Zero(D())), x);
}
HWY_INLINE V at_most(V x, V limit) {
    return hn::IfThenElse(hn::Lt(x, limit), x, limit);
}
HWY_INLINE V at_least(V x, V limit) {
    return hn::IfThenElse(hn::Gt(x, limit), x, limit);
}

/// c + x * rest: one step of a polynomial.
HWY_INLINE V step(V rest, V x, float c) {
    return hn::Add(hn::Mul(rest, x), set(c));
}

HWY_INLINE V dot(V ax, V ay, V az, V bx, V by, V bz) {
    return hn::Add(hn::Add(hn::Mul(ax, bx), hn::Mul(ay, by)), hn::Mul(az, bz));
}

HWY_INLINE V inverse_length(V x, V y, V z) {
    const V squared = dot(x, y, z, x, y, z);
    return hn::IfThenElseZero(hn::Gt(squared, hn::Zero(D())), hn::Div(set(1), hn::Sqrt(squared)));
}

HWY_INLINE V log2(V x) {
    const DI di;
    const VI bits = hn::Sub(hn::BitCast(di, x), hn::Set(di, 0x3f3504f3));
    const VI exponent = hn::ShiftRight<23>(bits);
    const VI mantissa = hn::Sub(hn::BitCast(di, x), hn::ShiftLeft<23>(exponent));
    const V f = hn::Sub(hn::BitCast(D(), mantissa), set(1));
    V p = set(7.0376836292e-2f);
    p = step(p, f, -1.1514610310e-1f);
    p = step(p, f, 1.1676998740e-1f);
    p = step(p, f, -1.2420140846e-1f);
    p = step(p, f, 1.4249322787e-1f);
    p = step(p, f, -1.6668057665e-1f);
    p = step(p, f, 2.0000714765e-1f);
    p = step(p, f, -2.4999993993e-1f);
    p = step(p, f, 3.3333331174e-1f);
    const V ff = hn::Mul(f, f);
    const V ln = hn::Add(f, hn::Mul(ff, hn::Sub(hn::Mul(f, p), set(0.5f))));
    return hn::Add(hn::ConvertTo(D(), exponent), hn::Mul(ln, set(1.44269504f)));
}

HWY_INLINE V exp2(V x) {
    const DI di;
    const V clamped = at_least(at_most(x, set(127)), set(-126));
    const V whole = hn::Round(clamped);
    const V r = hn::Sub(clamped, whole);
    V p = set(1.535336188319500e-4f);
    p = step(p, r, 1.339887440266574e-3f);
    p = step(p, r, 9.618437357674640e-3f);
    p = step(p, r, 5.550332471162809e-2f);
    p = step(p, r, 2.402264791363012e-1f);
    p = step(p, r, 6.931472028550421e-1f);
    p = step(p, r, 1);
    const VI power = hn::ShiftLeft<23>(hn::Add(hn::ConvertTo(di, whole), hn::Set(di, 127)));
    const V result = hn::Mul(p, hn::BitCast(D(), power));
    return hn::IfThenElseZero(hn::Ge(x, set(-126)), result);
}

HWY_INLINE V pow(V x, V y) {
    const V zero = hn::Zero(D());
    const V result = hn::IfThenElseZero(hn::Gt(x, set(1.17549435e-38f)), exp2(hn::Mul(y, log2(x))));
    return hn::IfThenElse(hn::Eq(y, zero), set(1), result);
}

HWY_INLINE V sine_of_turns(V x) {
    const V r = hn::Sub(x, hn::Round(x));
    const V half = hn::CopySign(set(0.5f), r);
    const V folded = hn::IfThenElse(hn::Gt(hn::Abs(r), set(0.25f)), hn::Sub(half, r), r);
    const V a = hn::Mul(folded, set(6.28318531f));
    const V aa = hn::Mul(a, a);
    V p = set(-2.50521084e-8f);
    p = step(p, aa, 2.75573192e-6f);
    p = step(p, aa, -1.98412698e-4f);
    p = step(p, aa, 8.33333333e-3f);
    p = step(p, aa, -1.66666667e-1f);
    p = step(p, aa, 1);
    return hn::Mul(a, p);
}

/// A corner's gradient, one of Perlin's twelve edges of the cube, times the offset (x, y, z) from it.
HWY_INLINE V lattice_gradient(VI ix, VI iy, VI iz, V x, V y, V z) {
    const DU du;
    const DI di;
    VU h = hn::Xor(hn::Xor(hn::Mul(hn::BitCast(du, ix), hn::Set(du, 0x8da6b343u)),
                           hn::Mul(hn::BitCast(du, iy), hn::Set(du, 0xd8163841u))),
                   hn::Mul(hn::BitCast(du, iz), hn::Set(du, 0xcb1ab31fu)));
    h = hn::Mul(hn::Xor(h, hn::ShiftRight<15>(h)), hn::Set(du, 0x2c1b3c6du));
    h = hn::Mul(hn::Xor(h, hn::ShiftRight<12>(h)), hn::Set(du, 0x297a2d39u));
    h = hn::Xor(h, hn::ShiftRight<15>(h));
    const VI edge = hn::BitCast(di, hn::And(h, hn::Set(du, 15)));
    const auto first_x = hn::RebindMask(D(), hn::Lt(edge, hn::Set(di, 8)));
    const auto second_y = hn::RebindMask(D(), hn::Lt(edge, hn::Set(di, 4)));
    const auto second_x = hn::RebindMask(D(), hn::Eq(hn::And(edge, hn::Set(di, 13)), hn::Set(di, 12)));
    const V a = hn::IfThenElse(first_x, x, y);
    const V b = hn::IfThenElse(second_y, y, hn::IfThenElse(second_x, x, z));
    const V sign_a = hn::BitCast(D(), hn::ShiftLeft<31>(h));
    const V sign_b = hn::BitCast(D(), hn::ShiftLeft<31>(hn::ShiftRight<1>(h)));
    return hn::Add(hn::Xor(a, sign_a), hn::Xor(b, sign_b));
}

HWY_INLINE V lerp(V t, V a, V b) {
    return hn::Add(a, hn::Mul(t, hn::Sub(b, a)));
}

HWY_INLINE V fade(V t) {
    const V p = step(step(set(6), t, -15), t, 10);
    return hn::Mul(hn::Mul(hn::Mul(t, t), t), p);
}

HWY_INLINE V clamp_to_lattice(V x) {
    return at_least(at_most(x, set(4194304)), set(-4194304));
}

HWY_INLINE V noise(V x, V y, V z) {
    const DI di;
    const VI one = hn::Set(di, 1);
    x = clamp_to_lattice(x), y = clamp_to_lattice(y), z = clamp_to_lattice(z);
    const V fx = hn::Floor(x), fy = hn::Floor(y), fz = hn::Floor(z);
    const VI ix = hn::ConvertTo(di, fx), iy = hn::ConvertTo(di, fy), iz = hn::ConvertTo(di, fz);
    const VI jx = hn::Add(ix, one), jy = hn::Add(iy, one), jz = hn::Add(iz, one);
    x = hn::Sub(x, fx), y = hn::Sub(y, fy), z = hn::Sub(z, fz);
    const V x1 = hn::Sub(x, set(1)), y1 = hn::Sub(y, set(1)), z1 = hn::Sub(z, set(1));
    const V tx = fade(x), ty = fade(y), tz = fade(z);
    const V low =
        lerp(ty, lerp(tx, lattice_gradient(ix, iy, iz, x, y, z), lattice_gradient(jx, iy, iz, x1, y, z)),
             lerp(tx, lattice_gradient(ix, jy, iz, x, y1, z), lattice_gradient(jx, jy, iz, x1, y1, z)));
    const V high =
        lerp(ty, lerp(tx, lattice_gradient(ix, iy, jz, x, y, z1), lattice_gradient(jx, iy, jz, x1, y, z1)),
             lerp(tx, lattice_gradient(ix, jy, jz, x, y1, z1), lattice_gradient(jx, jy, jz, x1, y1, z1)));
    return lerp(tz, low, high);
}

}  // namespace trapeze::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
