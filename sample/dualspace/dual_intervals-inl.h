/// Clipless dual-space bounds [Laine11]: lanes are columns (or rows) of pixels. Compiled once a target; see
/// Highway's foreach_target.h.
///
/// A ray through the lens point l that crosses the image plane at X misses a vertex (x, z) along the axis by
///     a = x - X w - l (1 - z / F)        w = z for perspective cameras, 1 for orthographic; F in focus
/// which is the predicate's a. A micropolygon can only be hit where its least a is <= 0 and its greatest is
/// >= 0. For given X and l it is linear in time, for given X and time linear in l: no division by depth, so
/// nothing need be clipped at the eye. The least a of several vertices over all that else may vary is concave
/// in what is left, hence nowhere below the chord between the values at its ends: where the chord is
/// positive, nothing is seen.
///
/// Departs from the paper: a is taken at both sides of each column of pixels, not interpolated between two
/// lines for the whole micropolygon. That costs more and bounds tighter, and columns and rows are shared by
/// all pixels of the box.
#if defined(TRAPEZE_SAMPLE_DUAL_INTERVALS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRAPEZE_SAMPLE_DUAL_INTERVALS_INL_H_
#undef TRAPEZE_SAMPLE_DUAL_INTERVALS_INL_H_
#else
#define TRAPEZE_SAMPLE_DUAL_INTERVALS_INL_H_
#endif

#include <hwy/highway.h>

#include <limits>

#include "sample/dualspace/dual_raster.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// A micropolygon's corners at both ends of a part of the shutter (at one, when it does not move), along an
/// axis.
struct DualCorners {
    float at[2][4], w[2][4];
    float lens[2][4];  ///< rim of the lens times 1 - z / F
};

/// What does not depend on the micropolygon: the grid's rounding and the part of the shutter.
struct DualConstants {
    float slack;      ///< of a, by rounding
    int part, parts;  ///< of the shutter
};

/// Places in [0, 1] where a function that is `start` at 0 and `end` at 1 is not positive: min to max.
template <class D, class V>
HWY_INLINE void not_positive(D d, V start, V end, V* min, V* max) {
    const V zero = hn::Zero(d), one = hn::Set(d, 1.0f), beyond = hn::Set(d, 2.0f);
    const V crossing = hn::Div(start, hn::Sub(start, end));
    const auto starts_above = hn::Gt(start, zero), ends_above = hn::Gt(end, zero);
    *min = hn::IfThenElse(starts_above, hn::IfThenElse(ends_above, beyond, crossing), zero);
    *max = hn::IfThenElse(ends_above, hn::IfThenElse(starts_above, hn::Neg(one), crossing), one);
}

/// Stores the first and the last bin of a range of places in [0, 1]; none (first above last) where min > max.
template <class D, class V>
HWY_INLINE void store_bins(D d, V min, V max, int32_t* first, int32_t* last) {
    const hn::RebindToSigned<D> di;
    const V bins = hn::Set(d, static_cast<float>(SampleMasks::kBins)),
            last_bin = hn::Set(d, static_cast<float>(SampleMasks::kBins - 1)), zero = hn::Zero(d);
    const auto bin_of = [&](V place) HWY_ATTR {
        return hn::ConvertTo(di, hn::Min(hn::Max(hn::Mul(place, bins), zero), last_bin));
    };
    const auto none = hn::RebindMask(di, hn::Gt(min, max));
    hn::StoreU(hn::IfThenElse(none, hn::Set(di, SampleMasks::kBins), bin_of(min)), di, first);
    hn::StoreU(hn::IfThenElse(none, hn::Set(di, -1), bin_of(max)), di, last);
}

/// The range of places where both the least a is not positive and the greatest not negative, each given at
/// both ends.
template <class D, class V>
HWY_INLINE void seen_places(D d, const V (&least)[2], const V (&greatest)[2], V slack, V* min, V* max) {
    V low_min, low_max, high_min, high_max;
    not_positive(d, hn::Sub(least[0], slack), hn::Sub(least[1], slack), &low_min, &low_max);
    not_positive(d, hn::Neg(hn::Add(greatest[0], slack)), hn::Neg(hn::Add(greatest[1], slack)), &high_min,
                 &high_max);
    *min = hn::Max(low_min, high_min), *max = hn::Min(low_max, high_max);
}

/// Sets the intervals of columns first to last, on the lens (or in the pixel) and in time; false where the
/// micropolygon is in none. s and t are the two axes of DualIntervals.
template <bool kMotion, bool kLens>
HWY_INLINE bool find_intervals(const DualCorners& corners, const DualConstants& c, int first, int last,
                               DualIntervals& to) {
    const hn::CappedTag<float, DualIntervals::kPadding> d;
    using V = hn::Vec<decltype(d)>;
    const V infinite = hn::Set(d, std::numeric_limits<float>::infinity()), slack = hn::Set(d, c.slack);
    constexpr int kEnds = kMotion ? 2 : 1;
    bool any = false;
    for (int i = first; i <= last; i += static_cast<int>(hn::Lanes(d))) {
        // Both sides of the pixels; s: from one rim of the lens to the other (or from side to side), over all
        // times; t: from one end of the part to the other, over all of the lens.
        const V low = hn::LoadU(d, &to.low[i]), high = hn::LoadU(d, &to.high[i]);
        V s_least[2] = {infinite, infinite}, s_greatest[2] = {hn::Neg(infinite), hn::Neg(infinite)};
        V t_least[2] = {infinite, infinite}, t_greatest[2] = {hn::Neg(infinite), hn::Neg(infinite)};
        for (int end = 0; end < kEnds; ++end)
            for (int corner = 0; corner < 4; ++corner) {
                const V at = hn::Set(d, corners.at[end][corner]), w = hn::Set(d, corners.w[end][corner]);
                const V a = hn::NegMulAdd(w, low, at), b = hn::NegMulAdd(w, high, at);
                V least = hn::Min(a, b), greatest = hn::Max(a, b);
                if constexpr (kLens) {
                    const V lens = hn::Set(d, corners.lens[end][corner]), reach = hn::Abs(lens);
                    s_least[0] = hn::Min(s_least[0], hn::Add(least, lens));
                    s_least[1] = hn::Min(s_least[1], hn::Sub(least, lens));
                    s_greatest[0] = hn::Max(s_greatest[0], hn::Add(greatest, lens));
                    s_greatest[1] = hn::Max(s_greatest[1], hn::Sub(greatest, lens));
                    least = hn::Sub(least, reach), greatest = hn::Add(greatest, reach);
                } else {
                    s_least[0] = hn::Min(s_least[0], a), s_greatest[0] = hn::Max(s_greatest[0], a);
                    s_least[1] = hn::Min(s_least[1], b), s_greatest[1] = hn::Max(s_greatest[1], b);
                }
                if constexpr (kMotion) {
                    t_least[end] = hn::Min(t_least[end], least);
                    t_greatest[end] = hn::Max(t_greatest[end], greatest);
                }
            }
        V s_min, s_max;
        seen_places(d, s_least, s_greatest, slack, &s_min, &s_max);
        auto seen = hn::Le(s_min, s_max);
        if constexpr (kMotion) {
            V t_min, t_max;
            seen_places(d, t_least, t_greatest, slack, &t_min, &t_max);
            seen = hn::And(seen, hn::Le(t_min, t_max));
            const V per_part = hn::Set(d, 1 / static_cast<float>(c.parts)),
                    from = hn::Set(d, static_cast<float>(c.part));
            t_min = hn::IfThenElse(seen, hn::Mul(hn::Add(t_min, from), per_part), infinite);
            store_bins(d, t_min, hn::Mul(hn::Add(t_max, from), per_part), &to.first_t[i], &to.last_t[i]);
        }
        if constexpr (kLens) {  // from [0, 1] of the corners' lens to that of the unit disk
            const V half = hn::Set(d, 0.5f), rim = hn::Set(d, DualIntervals::kLensRim);
            s_min = hn::MulAdd(hn::Sub(s_min, half), rim, half),
            s_max = hn::MulAdd(hn::Sub(s_max, half), rim, half);
        }
        s_min = hn::IfThenElse(seen, s_min, infinite);
        store_bins(d, s_min, s_max, &to.first_s[i], &to.last_s[i]);
        any = any || !hn::AllFalse(d, hn::And(seen, hn::FirstN(d, static_cast<size_t>(last + 1 - i))));
    }
    return any;
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
