/// Interval arithmetic over bundles of camera rays (Reshetov et al. 2005; Boulos et al. 2006): lanes are
/// boxes for one bundle, or packets of rays for one box. Compiled once a target.
///
/// A ray is at x = ox + ux * z = d * z + o * (1 - z / f) with d = ux + ox / f and o = ox: for rays through
/// one lens d is where they meet the focal distance f, so that both intervals are small.
#if defined(TRAPEZE_ACCEL_RAY_INTERVALS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRAPEZE_ACCEL_RAY_INTERVALS_INL_H_
#undef TRAPEZE_ACCEL_RAY_INTERVALS_INL_H_
#else
#define TRAPEZE_ACCEL_RAY_INTERVALS_INL_H_
#endif

#include <hwy/highway.h>

#include "accel/wide/bundle_scratch.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Lanes of intervals, both ends included.
struct VectorInterval {
    hn::Vec<hn::ScalableTag<float>> low, high;
};

/// What a bundle's or packets' rays hold, as intervals. Made from lanes value(row) of the RayIntervals::Row
/// named.
struct IntervalLanes {
    VectorInterval dx, dy, ox, oy, time;

    template <bool kMotion, bool kLens, class Value>
    static HWY_INLINE IntervalLanes of(const Value& value) {
        IntervalLanes q;
        q.dx = {value(RayIntervals::kDxMin), value(RayIntervals::kDxMax)};
        q.dy = {value(RayIntervals::kDyMin), value(RayIntervals::kDyMax)};
        if constexpr (kLens) {
            q.ox = {value(RayIntervals::kOxMin), value(RayIntervals::kOxMax)};
            q.oy = {value(RayIntervals::kOyMin), value(RayIntervals::kOyMax)};
        }
        if constexpr (kMotion) q.time = {value(RayIntervals::kTimeMin), value(RayIntervals::kTimeMax)};
        return q;
    }
};

/// What a plane of a moving box spans during an interval of time, the low one downwards, the high one
/// upwards: it moves linearly, so that the ends of the interval are enough.
template <class V>
HWY_INLINE V lowest(V low, V delta, const VectorInterval& time) {
    return hn::Min(hn::MulAdd(time.low, delta, low), hn::MulAdd(time.high, delta, low));
}
template <class V>
HWY_INLINE V highest(V high, V delta, const VectorInterval& time) {
    return hn::Max(hn::MulAdd(time.low, delta, high), hn::MulAdd(time.high, delta, high));
}

/// The interval of an interval's products with a number of either sign.
template <class V>
HWY_INLINE VectorInterval times(const VectorInterval& i, V factor) {
    const V a = hn::Mul(i.low, factor), b = hn::Mul(i.high, factor);
    return {hn::Min(a, b), hn::Max(a, b)};
}

/// Lanes where some ray may be between low and high of one axis on its way from depth z0 to z1; k = 1 - z / f
/// at these. A ray is linear in depth, so that what rays span on the way lies between what they span at its
/// ends.
template <bool kLens, class D, class V>
HWY_INLINE hn::Mask<D> passes(D, const VectorInterval& d, const VectorInterval& o, V z0, V z1, V k0, V k1,
                              V low, V high) {
    VectorInterval from = times(d, z0), to = times(d, z1);
    if constexpr (kLens) {
        const VectorInterval from_lens = times(o, k0), to_lens = times(o, k1);
        from = {hn::Add(from.low, from_lens.low), hn::Add(from.high, from_lens.high)};
        to = {hn::Add(to.low, to_lens.low), hn::Add(to.high, to_lens.high)};
    }
    return hn::And(hn::Le(hn::Min(from.low, to.low), high), hn::Ge(hn::Max(from.high, to.high), low));
}

/// Lanes where some ray may pass through a box, whose planes are low and high x, y, z, no nearer than
/// `nearest`. Conservative, and grown by nothing: boxes have been grown when they were built.
template <bool kLens, class D, class V>
HWY_INLINE hn::Mask<D> meets(D d, const IntervalLanes& q, const V* low, const V* high, V nearest,
                             V inverse_focal) {
    const V z0 = hn::Max(low[2], nearest), z1 = high[2], one = hn::Set(d, 1.0f);
    const V k0 = kLens ? hn::NegMulAdd(z0, inverse_focal, one) : one;
    const V k1 = kLens ? hn::NegMulAdd(z1, inverse_focal, one) : one;
    return hn::And(hn::Le(z0, z1), hn::And(passes<kLens>(d, q.dx, q.ox, z0, z1, k0, k1, low[0], high[0]),
                                           passes<kLens>(d, q.dy, q.oy, z0, z1, k0, k1, low[1], high[1])));
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
