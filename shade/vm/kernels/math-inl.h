/// What all kernels build on: vectors of a lane group, and the quick powers that highlights are made of.
/// Included once for each target. Only operations that round alike everywhere: no fused multiply-add, no
/// approximate reciprocals.
#if defined(TRAPEZE_SHADE_VM_MATH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRAPEZE_SHADE_VM_MATH_INL_H_
#undef TRAPEZE_SHADE_VM_MATH_INL_H_
#else
#define TRAPEZE_SHADE_VM_MATH_INL_H_
#endif

#include <hwy/highway.h>

#include "shade/planes/planes.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze::kernels::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Tags and vectors of floats and of integers of the same number of lanes: as many as the target has, at most
/// kLanes, of which planes have a multiple.
using D = hn::CappedTag<float, kLanes>;
using DI = hn::RebindToSigned<D>;
using DU = hn::RebindToUnsigned<D>;
using V = hn::Vec<D>;
using VI = hn::Vec<DI>;
using VU = hn::Vec<DU>;

HWY_INLINE V set(float x) {
    return hn::Set(D(), x);
}

/// max(0, x); 0 for NaN.
HWY_INLINE V positive(V x) {
    return hn::IfThenElseZero(hn::Gt(x, hn::Zero(D())), x);
}

/// `limit` where x is NaN, in this and the next: a comparison with NaN is false.
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

/// The order of the sum is fixed, from x to z, so that all targets and methods round alike.
HWY_INLINE V dot(V ax, V ay, V az, V bx, V by, V bz) {
    return hn::Add(hn::Add(hn::Mul(ax, bx), hn::Mul(ay, by)), hn::Mul(az, bz));
}

/// 0 for a vector without length, so that normalizing it leaves it zero.
HWY_INLINE V inverse_length(V x, V y, V z) {
    const V squared = dot(x, y, z, x, y, z);
    return hn::IfThenElseZero(hn::Gt(squared, hn::Zero(D())), hn::Div(set(1), hn::Sqrt(squared)));
}

/// x = 2^exponent * (1 + f), 1 + f from sqrt(1/2) to sqrt(2) (0x3f3504f3 is the float sqrt(1/2)), for normal
/// positive x.
struct Scientific {
    VI exponent;
    V f;
};

/// Subtracting the bits of sqrt(1/2) first makes the mantissa lie between sqrt(1/2) and sqrt(2), about 1,
/// where the logarithm's series needs fewest terms.
HWY_INLINE Scientific split_exponent(V x) {
    const DI di;
    const VI bits = hn::BitCast(di, x);
    const VI exponent = hn::ShiftRight<23>(hn::Sub(bits, hn::Set(di, 0x3f3504f3)));
    const V mantissa = hn::BitCast(D(), hn::Sub(bits, hn::ShiftLeft<23>(exponent)));
    return {exponent, hn::Sub(mantissa, set(1))};
}

/// ln(1 + f) = f - f^2 / 2 + f^3 * this: the polynomial of Cephes' logf, good to about 1e-7.
HWY_INLINE V logarithm_series(V f) {
    V p = set(7.0376836292e-2f);
    p = step(p, f, -1.1514610310e-1f);
    p = step(p, f, 1.1676998740e-1f);
    p = step(p, f, -1.2420140846e-1f);
    p = step(p, f, 1.4249322787e-1f);
    p = step(p, f, -1.6668057665e-1f);
    p = step(p, f, 2.0000714765e-1f);
    p = step(p, f, -2.4999993993e-1f);
    return step(p, f, 3.3333331174e-1f);
}

/// Binary logarithm of a normal positive number.
HWY_INLINE V log2(V x) {
    const auto [exponent, f] = split_exponent(x);
    const V ff = hn::Mul(f, f);
    const V ln = hn::Add(f, hn::Mul(ff, hn::Sub(hn::Mul(f, logarithm_series(f)), set(0.5f))));
    return hn::Add(hn::ConvertTo(D(), exponent), hn::Mul(ln, set(1.44269504f)));
}

/// 2^x by Cephes' exp2f; 0 for x below -126, and no more than about 2^127.
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

/// 0 for x that is not positive, but anything to the power of 0 is 1.
HWY_INLINE V pow(V x, V y) {
    const V zero = hn::Zero(D());
    const V result = hn::IfThenElseZero(hn::Gt(x, set(1.17549435e-38f)), exp2(hn::Mul(y, log2(x))));
    return hn::IfThenElse(hn::Eq(y, zero), set(1), result);
}

/// a at t = 0, b at t = 1 but for a rounding.
HWY_INLINE V lerp(V t, V a, V b) {
    return hn::Add(a, hn::Mul(t, hn::Sub(b, a)));
}

/// 6 t^5 - 15 t^4 + 10 t^3: flat in first and second derivative at 0 and 1, and so of a noise without
/// creases.
HWY_INLINE V fade(V t) {
    const V p = step(step(set(6), t, -15), t, 10);
    return hn::Mul(hn::Mul(hn::Mul(t, t), t), p);
}

/// +-2^22: the largest coordinates at which floats still have halves, and whole numbers fit into 32 bits.
HWY_INLINE V clamp_to_lattice(V x) {
    return at_least(at_most(x, set(4194304)), set(-4194304));
}

}  // namespace trapeze::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
