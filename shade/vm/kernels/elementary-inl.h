/// Elementary functions over all floats, on Highway vectors. Largest errors, in units of the last place,
/// against the same functions in doubles (elementary_test.cpp holds them to it):
///
///     sin, cos   2    tan   3    up to |x| = 1e6; beyond 2^30, and for NaN, x is taken as 0
///     asin, acos 3               x is clamped to -1..1
///     atan, atan2 3              atan2(0, 0) = 0
///     exp        2               NaN counts as -infinity
///     log        2               x is taken as at least the least normal float, also for NaN; of infinity,
///     128 ln 2 pow        2               0 for negative x and fractional y; 0 for x = 0 and y > 0
///
/// Steps that need more than a float's digits are done in doubles. Polynomials are those of Cephes' single
/// precision library unless said otherwise.
#if defined(TRAPEZE_SHADE_VM_ELEMENTARY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRAPEZE_SHADE_VM_ELEMENTARY_INL_H_
#undef TRAPEZE_SHADE_VM_ELEMENTARY_INL_H_
#else
#define TRAPEZE_SHADE_VM_ELEMENTARY_INL_H_
#endif

#include "shade/vm/kernels/operands-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze::vm::HWY_NAMESPACE {

inline constexpr float kHalfPi = 1.57079632679f, kPi = 3.14159265359f;

/// The lanes of a V as doubles, in as many vectors as they fill.
#if HWY_TARGET == HWY_SCALAR
using DD = hn::Rebind<double, D>;
struct Doubles {
    hn::Vec<DD> part[1];
};
HWY_INLINE Doubles to_doubles(V x) {
    return {{hn::PromoteTo(DD(), x)}};
}
HWY_INLINE V to_floats(const Doubles& x) {
    return hn::DemoteTo(D(), x.part[0]);
}
HWY_INLINE VI low_words(const Doubles& x) {
    return hn::Set(DI(), static_cast<int32_t>(
                             hn::GetLane(hn::BitCast(hn::RebindToUnsigned<DD>(), x.part[0])) & 0xffffffffu));
}
#else
using DD = hn::Repartition<double, D>;

/// A vector of doubles has half as many lanes as one of floats of the same size: two of them hold a V's.
struct Doubles {
    hn::Vec<DD> part[2];
};
HWY_INLINE Doubles to_doubles(V x) {
    const hn::Half<D> half;
    return {{hn::PromoteTo(DD(), hn::LowerHalf(half, x)), hn::PromoteTo(DD(), hn::UpperHalf(half, x))}};
}
HWY_INLINE V to_floats(const Doubles& x) {
    const hn::Half<D> half;
    return hn::Combine(D(), hn::DemoteTo(half, x.part[1]), hn::DemoteTo(half, x.part[0]));
}
/// The low 32 bits of each double.
HWY_INLINE VI low_words(const Doubles& x) {
    return hn::ConcatEven(DI(), hn::BitCast(DI(), x.part[1]), hn::BitCast(DI(), x.part[0]));
}
#endif
using VD = hn::Vec<DD>;

/// A constant that a float does not hold exactly.
HWY_INLINE VD set_double(double x) {
    return hn::Set(DD(), x);
}

/// Added to a double of magnitude below 2^51 it leaves the nearest whole number in the low bits.
inline constexpr double kRounder = 6755399441055744.0;

/// x = r + quadrant * pi / 2, |r| <= pi / 4; the quadrant modulo 2^32.
struct Angle {
    V r;
    VI quadrant;
};
/// In doubles, by Cody and Waite's two-part pi / 2: an angle in floats has lost what a difference of large
/// numbers would need. Larger angles than 2^30 have no meaningful sine left.
HWY_INLINE Angle reduce_angle(V angle) {
    const Doubles x = to_doubles(hn::IfThenElseZero(hn::Lt(hn::Abs(angle), set(1073741824)), angle));
    Doubles r, quadrants;
    for (size_t k = 0; k < std::size(x.part); ++k) {
        const VD biased =
            hn::Add(hn::Mul(x.part[k], set_double(0.63661977236758134308)), set_double(kRounder));
        const VD n = hn::Sub(biased, set_double(kRounder));
        // pi / 2 in two parts, the first of 33 bits: n times it is exact for n < 2^20.
        const VD rest = hn::Sub(x.part[k], hn::Mul(n, set_double(1.57079632673412561417)));
        r.part[k] = hn::Sub(rest, hn::Mul(n, set_double(6.07710050650619224932e-11)));
        quadrants.part[k] = biased;
    }
    return {to_floats(r), low_words(quadrants)};
}

/// sin(r) for |r| <= pi / 4, where rr = r * r: Cephes' sinf.
HWY_INLINE V sine_near_zero(V r, V rr) {
    V p = set(-1.9515295891e-4f);
    p = step(p, rr, 8.3321608736e-3f);
    p = step(p, rr, -1.6666654611e-1f);
    return hn::Add(hn::Mul(hn::Mul(p, rr), r), r);
}

/// cos(r) for |r| <= pi / 4, where rr = r * r: Cephes' cosf.
HWY_INLINE V cosine_near_zero(V rr) {
    V p = set(2.443315711809948e-5f);
    p = step(p, rr, -1.388731625493765e-3f);
    p = step(p, rr, 4.166664568298827e-2f);
    return hn::Add(hn::Sub(hn::Mul(hn::Mul(p, rr), rr), hn::Mul(rr, set(0.5f))), set(1));
}

/// Sine of the angle that is `quadrants` quarter turns beyond the one whose sine and cosine are given.
HWY_INLINE V sine_of(V sine, V cosine, VI quadrants) {
    const DI di;
    const M odd = hn::RebindMask(D(), hn::Ne(hn::And(quadrants, hn::Set(di, 1)), hn::Zero(di)));
    const VI sign = hn::ShiftLeft<30>(hn::And(quadrants, hn::Set(di, 2)));
    return hn::Xor(hn::IfThenElse(odd, cosine, sine), hn::BitCast(D(), sign));
}

/// Both, of one angle.
struct SineCosine {
    V sine, cosine;
};
/// Sine and cosine at once, for rotations: the reduction of the angle costs as much as a polynomial.
HWY_INLINE SineCosine sin_cos(V x) {
    const Angle angle = reduce_angle(x);
    const V rr = hn::Mul(angle.r, angle.r);
    const V s = sine_near_zero(angle.r, rr), c = cosine_near_zero(rr);
    return {sine_of(s, c, angle.quadrant), sine_of(s, c, hn::Add(angle.quadrant, hn::Set(DI(), 1)))};
}
HWY_INLINE V sine(V x) {
    return sin_cos(x).sine;
}
HWY_INLINE V cosine(V x) {
    return sin_cos(x).cosine;
}
/// By its own polynomial, near the poles as -1 over that of the rest, rather than as a quotient of sine and
/// cosine.
HWY_INLINE V tangent(V x) {
    const DI di;
    const Angle angle = reduce_angle(x);
    const V rr = hn::Mul(angle.r, angle.r);
    V p = set(9.38540185543e-3f);
    p = step(p, rr, 3.11992232697e-3f);
    p = step(p, rr, 2.44301354525e-2f);
    p = step(p, rr, 5.34112807005e-2f);
    p = step(p, rr, 1.33387994085e-1f);
    p = step(p, rr, 3.33331568548e-1f);
    const V t = hn::Add(hn::Mul(hn::Mul(p, rr), angle.r), angle.r);
    const M odd = hn::RebindMask(D(), hn::Ne(hn::And(angle.quadrant, hn::Set(di, 1)), hn::Zero(di)));
    return hn::IfThenElse(odd, hn::Div(set(-1), t), t);
}

/// asin(s) for s in 0..0.5, where ss = s * s: Cephes' asinf.
HWY_INLINE V arc_sine_near_zero(V s, V ss) {
    V p = set(4.2163199048e-2f);
    p = step(p, ss, 2.4181311049e-2f);
    p = step(p, ss, 4.5470025998e-2f);
    p = step(p, ss, 7.4953002686e-2f);
    p = step(p, ss, 1.6666752422e-1f);
    return hn::Add(hn::Mul(hn::Mul(p, ss), s), s);
}
/// asin |x| for |x| <= 0.5 and else asin sqrt((1 - |x|) / 2), which is half of acos |x|.
struct ArcParts {
    M outer;
    V arc;
};

/// Beyond 1/2 the series would converge badly: there asin(a) = pi/2 - 2 asin(sqrt((1 - a) / 2)) brings the
/// argument back below it.
HWY_INLINE ArcParts arc_parts(V x) {
    const V a = at_most(hn::Abs(x), set(1));
    const M outer = hn::Gt(a, set(0.5f));
    const V half_rest = hn::Mul(hn::Sub(set(1), a), set(0.5f));
    const V ss = hn::IfThenElse(outer, half_rest, hn::Mul(a, a));
    return {outer, arc_sine_near_zero(hn::IfThenElse(outer, hn::Sqrt(half_rest), a), ss)};
}

/// Beyond 1/2 by asin x = pi / 2 - 2 asin sqrt((1 - x) / 2), since the series converges badly near 1.
HWY_INLINE V arc_sine(V x) {
    const ArcParts parts = arc_parts(x);
    const V outer = hn::Sub(set(kHalfPi), hn::Add(parts.arc, parts.arc));
    return hn::CopySign(hn::IfThenElse(parts.outer, outer, parts.arc), x);
}

/// Near 1 and -1 by the small arc, and not as pi / 2 - asin x, where the digits would cancel.
HWY_INLINE V arc_cosine(V x) {
    const ArcParts parts = arc_parts(x);
    const V twice = hn::Add(parts.arc, parts.arc);
    const V outer = hn::IfThenElse(hn::Lt(x, hn::Zero(D())), hn::Sub(set(kPi), twice), twice);
    return hn::IfThenElse(parts.outer, outer, hn::Sub(set(kHalfPi), hn::CopySign(parts.arc, x)));
}

/// atan(n / d) for 0 <= n <= d, both finite; 0 for d = 0. Ratios above tan(pi / 8) are turned back by pi / 4
/// first, to (n - d) / (n + d), so that the polynomial sees no more than tan(pi / 8); `safe` keeps n + d from
/// overflowing.
HWY_INLINE V arc_tangent_of_ratio(V n, V d) {
    const M outer = hn::Gt(n, hn::Mul(d, set(0.414213562f)));  // tan(pi / 8)
    const V safe = hn::IfThenElse(hn::Gt(d, set(1e38f)), set(0.25f), set(1));
    const V sn = hn::Mul(n, safe), sd = hn::Mul(d, safe);
    const V numerator = hn::IfThenElse(outer, hn::Sub(sn, sd), n);
    const V denominator = hn::IfThenElse(outer, hn::Add(sn, sd), d);
    const V a = hn::IfThenElseZero(hn::Gt(d, hn::Zero(D())), hn::Div(numerator, denominator));
    const V aa = hn::Mul(a, a);
    V p = set(8.05374449538e-2f);
    p = step(p, aa, -1.38776856032e-1f);
    p = step(p, aa, 1.99777106478e-1f);
    p = step(p, aa, -3.33329491539e-1f);
    const V arc = hn::Add(hn::Mul(hn::Mul(p, aa), a), a);
    return hn::Add(arc, hn::IfThenElseZero(outer, set(kHalfPi / 2)));
}
/// The angle of (x, y), -pi to pi. The smaller of both magnitudes goes over the larger one; then the octant,
/// the half plane and the sign are put back. Infinities count as the largest float, so that no quotient of
/// two of them arises.
HWY_INLINE V arc_tangent(V y, V x) {
    const V most = set(3.402823466e38f);
    const V ax = at_most(hn::Abs(x), most), ay = at_most(hn::Abs(y), most);
    const V first = arc_tangent_of_ratio(at_most(ax, ay), at_least(ax, ay));
    const V quarter = hn::IfThenElse(hn::Gt(ay, ax), hn::Sub(set(kHalfPi), first), first);
    const V half = hn::IfThenElse(hn::Lt(x, hn::Zero(D())), hn::Sub(set(kPi), quarter), quarter);
    return hn::CopySign(half, y);
}
HWY_INLINE V arc_tangent(V x) {
    return arc_tangent(x, set(1));
}

/// p * 2^n for whole n of magnitude up to 200, in two steps: each factor is a normal float.
HWY_INLINE V scale_by_power(V p, VI n) {
    const DI di;
    const VI bias = hn::Set(di, 127), first = hn::ShiftRight<1>(n);
    const V a = hn::BitCast(D(), hn::ShiftLeft<23>(hn::Add(first, bias)));
    const V b = hn::BitCast(D(), hn::ShiftLeft<23>(hn::Add(hn::Sub(n, first), bias)));
    return hn::Mul(hn::Mul(p, a), b);
}

/// e^x = 2^n e^r with r = x - n ln 2, |r| <= ln 2 / 2; ln 2 in two parts, of which n times the first is
/// exact.
HWY_INLINE V exponential(V x) {
    const V clamped = at_most(at_least(x, set(-105)), set(89));
    const V n = hn::Round(hn::Mul(clamped, set(1.44269504f)));
    V r = hn::Sub(clamped, hn::Mul(n, set(0.693359375f)));
    r = hn::Sub(r, hn::Mul(n, set(-2.12194440e-4f)));
    V p = set(1.9875691500e-4f);
    p = step(p, r, 1.3981999507e-3f);
    p = step(p, r, 8.3334519073e-3f);
    p = step(p, r, 4.1665795894e-2f);
    p = step(p, r, 1.6666665459e-1f);
    p = step(p, r, 5.0000001201e-1f);
    const V power = hn::Add(hn::Add(hn::Mul(hn::Mul(r, r), p), r), set(1));
    return scale_by_power(power, hn::ConvertTo(DI(), n));
}

/// erfc(z) for z of 1/2 to 11, beyond which it is 0 as a float: t e^(p(t) - z^2) with t = 1 / (1 + z / 2),
/// where p meets the logarithm of what is left at Chebyshev's nodes, within 4e-8 but for rounding.
HWY_INLINE V complement_of_positive(V z) {
    const V t = hn::Div(set(1), hn::Add(set(1), hn::Mul(z, set(0.5f))));
    V p = set(-0.104558485f);
    for (const float c : {0.182130288f, 0.2174479f, -0.598676955f, 0.183372342f, -0.00414934383f,
                          0.391258209f, 0.99838264f, -1.26544551f})
        p = step(p, t, c);
    return hn::Mul(t, exponential(hn::Sub(p, hn::Mul(z, z))));
}

/// erf(x) for |x| < 1/2, by its series.
HWY_INLINE V error_function_near_zero(V x) {
    const V xx = hn::Mul(x, x);
    V p = set(1.0f / 9360);
    for (const float c : {-1.0f / 1320, 1.0f / 216, -1.0f / 42, 1.0f / 10, -1.0f / 3, 1.0f})
        p = step(p, xx, c);
    return hn::Mul(hn::Mul(x, set(1.12837917f)), p);
}

/// erfc(x) = 1 - erf(x), without the loss of that difference where it is small. NaN counts as a large
/// positive x.
HWY_INLINE V complementary_error_function(V x) {
    const V positive = complement_of_positive(at_most(hn::Abs(x), set(11)));
    const V farther = hn::IfThenElse(hn::Lt(x, hn::Zero(D())), hn::Sub(set(2), positive), positive);
    return hn::IfThenElse(hn::Lt(hn::Abs(x), set(0.5f)), hn::Sub(set(1), error_function_near_zero(x)),
                          farther);
}

/// erf(x), the integral of 2 / sqrt(pi) e^(-t^2) from 0 to x. NaN as above.
HWY_INLINE V error_function(V x) {
    const V positive = hn::Sub(set(1), complement_of_positive(at_most(hn::Abs(x), set(11))));
    const V farther = hn::IfThenElse(hn::Lt(x, hn::Zero(D())), hn::Neg(positive), positive);
    return hn::IfThenElse(hn::Lt(hn::Abs(x), set(0.5f)), error_function_near_zero(x), farther);
}

/// ln x = e ln 2 + ln(1 + f), the small parts summed first.
HWY_INLINE V logarithm(V x) {
    const Scientific split = split_exponent(at_least(x, set(kLeastNormal)));
    const V f = split.f, e = hn::ConvertTo(D(), split.exponent);
    const V ff = hn::Mul(f, f);
    V rest = hn::Add(hn::Mul(hn::Mul(f, ff), logarithm_series(f)), hn::Mul(e, set(-2.12194440e-4f)));
    rest = hn::Sub(rest, hn::Mul(ff, set(0.5f)));
    return hn::Add(hn::Add(f, rest), hn::Mul(e, set(0.693359375f)));
}

/// x^y for normal positive x. The logarithm is that of doubles, 2 atanh(f / (2 + f)) / ln 2 by its series,
/// since its error is multiplied by y.
HWY_INLINE V power_of_positive(V x, V y) {
    const Scientific split = split_exponent(x);
    const Doubles f = to_doubles(split.f), e = to_doubles(hn::ConvertTo(D(), split.exponent));
    const Doubles exponent = to_doubles(y);
    Doubles whole, rest;
    for (size_t k = 0; k < std::size(f.part); ++k) {
        const VD s = hn::Div(f.part[k], hn::Add(f.part[k], set_double(2)));
        const VD ss = hn::Mul(s, s);
        VD p = set_double(2.88539008177792681 / 11);
        for (int odd = 9; odd > 0; odd -= 2)
            p = hn::Add(hn::Mul(p, ss), set_double(2.88539008177792681 / odd));
        VD t = hn::Mul(exponent.part[k], hn::Add(e.part[k], hn::Mul(s, p)));
        t = hn::IfThenElse(hn::Gt(t, set_double(-160)), t, set_double(-160));
        t = hn::IfThenElse(hn::Lt(t, set_double(160)), t, set_double(160));
        const VD biased = hn::Add(t, set_double(kRounder));
        rest.part[k] = hn::Sub(t, hn::Sub(biased, set_double(kRounder)));
        whole.part[k] = biased;
    }
    const V r = to_floats(rest);
    V p = set(1.535336188319500e-4f);
    p = step(p, r, 1.339887440266574e-3f);
    p = step(p, r, 9.618437357674640e-3f);
    p = step(p, r, 5.550332471162809e-2f);
    p = step(p, r, 2.402264791363012e-1f);
    p = step(p, r, 6.931472028550421e-1f);
    return scale_by_power(step(p, r, 1), low_words(whole));
}

/// x^y as C's powf where that is finite: negative x have powers for whole y alone, and a zero has the power 0
/// for positive y, 1 for y = 0.
HWY_INLINE V power(V x, V y) {
    const V zero = hn::Zero(D());
    const V result = power_of_positive(at_least(hn::Abs(x), set(kLeastNormal)), y);
    const V half = hn::Mul(y, set(0.5f));
    const M whole = hn::Eq(hn::Floor(y), y);
    const V odd_sign = hn::IfThenZeroElse(hn::Eq(hn::Floor(half), half), set(-0.0f));
    const V of_negative = hn::IfThenElseZero(whole, hn::Xor(result, odd_sign));
    const V of_zero = hn::IfThenZeroElse(hn::Gt(y, zero), result);
    return hn::IfThenElse(hn::Lt(x, zero), of_negative, hn::IfThenElse(hn::Eq(x, zero), of_zero, result));
}

}  // namespace trapeze::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
