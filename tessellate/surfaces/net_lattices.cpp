#include "tessellate/surfaces/net_lattices.h"

#include <algorithm>
#include <array>
#include <vector>

#include "tessellate/surfaces/bezier.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tessellate/surfaces/net_lattices.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target
#include <hwy/highway.h>

#ifndef TRAPEZE_TESSELLATE_NET_LATTICES_ONCE
#define TRAPEZE_TESSELLATE_NET_LATTICES_ONCE
namespace trapeze {

/// Weights of up to four control points at a parameter. That of B-splines is CubicWeights
/// (face_evaluation.cpp): the same bits.
using NetWeights = std::array<float, 4>;

inline NetWeights net_weights(NetForm form, float t) {
    const float s = 1 - t, ss = s * s, tt = t * t;
    constexpr float sixth = 1.0f / 6;
    switch (form) {
        case NetForm::Bspline:
            return {sixth * (ss * s), sixth * (4 - 3 * (tt * (1 + s))), sixth * (4 - 3 * (ss * (1 + t))),
                    sixth * (tt * t)};
        case NetForm::Bezier:
            return std::to_array(bezier_weights(3, t).w);
        case NetForm::Corners:
        case NetForm::BezierLines:
            break;
    }
    return std::to_array(bezier_weights(1, t).w);
}

/// A point of lattices: where it goes, and its weights along both axes.
struct PlannedPoint {
    float u = 0;
    int number = 0;
    NetWeights along_u{}, along_v{};
};

/// All points of lattices, sorted by u: rows of control points are summed up along u once for all points of
/// the same u.
struct LatticePlan {
    std::array<PlannedPoint, FaceLattices::kPoints> points;
    size_t count = 0;

    LatticePlan(NetForm form, FaceRuns runs, bool beside) {
        for (; count < (beside ? FaceLattices::kPoints : FaceLattices::kFirstBeside); ++count) {
            const int number = static_cast<int>(count);
            const V2f uv = FaceLattices::uv(runs, number);
            points[count] = {uv.x, number, net_weights(form, uv.x), net_weights(form, uv.y)};
        }
        std::sort(points.begin(), points.begin() + count,
                  [](const PlannedPoint& a, const PlannedPoint& b) { return a.u < b.u; });
    }
    /// Every plan that there is, made once.
    static const LatticePlan& of(NetForm form, FaceRuns runs, bool beside) {
        static const std::vector<LatticePlan> all = [] {
            std::vector<LatticePlan> plans;
            for (int f = 0; f < kNetForms; ++f)
                for (int r = 0; r < kFaceRuns; ++r)
                    for (const bool with : {false, true})
                        plans.emplace_back(static_cast<NetForm>(f), static_cast<FaceRuns>(r), with);
            return plans;
        }();
        return all[(static_cast<size_t>(form) * kFaceRuns + static_cast<size_t>(runs)) * 2 +
                   (beside ? 1 : 0)];
    }
};

}  // namespace trapeze
#endif

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using F = hn::CappedTag<float, FaceLattices::kFaces>;
using Lanes = hn::Vec<F>;

/// How each form sums up control points with weights, here of one coordinate in lanes.
template <NetForm form>
struct NetSum;

template <>
struct NetSum<NetForm::Corners> {
    static constexpr int kPoints = 2;
    static HWY_INLINE Lanes of(const NetWeights& w, const Lanes* c) {
        const F d;
        return hn::Add(hn::Mul(hn::Set(d, w[0]), c[0]), hn::Mul(hn::Set(d, w[1]), c[1]));
    }
    /// Corners go round.
    static constexpr int point(int i, int j) { return j == 0 ? i : 3 - i; }
};

template <>
struct NetSum<NetForm::Bspline> {
    static constexpr int kPoints = 4;
    static HWY_INLINE Lanes of(const NetWeights& w, const Lanes* c) {
        const F d;
        const Lanes low = hn::Add(hn::Mul(hn::Set(d, w[0]), c[0]), hn::Mul(hn::Set(d, w[1]), c[1]));
        return hn::Add(low, hn::Add(hn::Mul(hn::Set(d, w[2]), c[2]), hn::Mul(hn::Set(d, w[3]), c[3])));
    }
    static constexpr int point(int i, int j) { return j * 4 + i; }
};

/// Sums that begin with 0, one product after another.
template <int points>
struct BezierSum {
    static constexpr int kPoints = points;
    static HWY_INLINE Lanes of(const NetWeights& w, const Lanes* c) {
        const F d;
        Lanes sum = hn::Zero(d);
        for (int i = 0; i < points; ++i) sum = hn::Add(sum, hn::Mul(c[i], hn::Set(d, w[i])));
        return sum;
    }
    static constexpr int point(int i, int j) { return j * 4 + i; }
};
template <>
struct NetSum<NetForm::Bezier> : BezierSum<4> {};
template <>
struct NetSum<NetForm::BezierLines> : BezierSum<2> {};

/// All points of the faces in lanes `first` on.
template <NetForm form>
HWY_INLINE void evaluate_lanes(const NetLanes& nets, const LatticePlan& plan, size_t first,
                               FaceLattices& lattices) {
    using Sum = NetSum<form>;
    const F d;
    Lanes rows[3][Sum::kPoints];  // at one u
    for (size_t p = 0; p < plan.count; ++p) {
        const PlannedPoint& point = plan.points[p];
        if (p == 0 || point.u != plan.points[p - 1].u)
            for (int k = 0; k < 3; ++k)
                for (int j = 0; j < Sum::kPoints; ++j) {
                    Lanes c[Sum::kPoints];
                    for (int i = 0; i < Sum::kPoints; ++i)
                        c[i] = hn::Load(d, nets.points[Sum::point(i, j)][k] + first);
                    rows[k][j] = Sum::of(point.along_u, c);
                }
        for (int k = 0; k < 3; ++k)
            hn::Store(Sum::of(point.along_v, rows[k]), d, lattices.points[point.number][k] + first);
    }
}

/// A range of each lane.
struct LaneRange {
    Lanes low, high;

    HWY_INLINE explicit LaneRange(Lanes value) : low(value), high(value) {}
    /// As Box3f takes in points.
    HWY_INLINE void extend(Lanes value) {
        low = hn::IfThenElse(hn::Lt(value, low), value, low);
        high = hn::IfThenElse(hn::Gt(value, high), value, high);
    }
    /// What grown_by_rounding() grows it by.
    HWY_INLINE LaneRange grown() const {
        const F d;
        const Lanes a = hn::Abs(low), b = hn::Abs(high);
        const Lanes margin = hn::Mul(hn::Set(d, 4e-6f), hn::IfThenElse(hn::Lt(a, b), b, a));
        LaneRange range(hn::Sub(low, margin));
        range.high = hn::Add(high, margin);
        return range;
    }
};

/// bezier_of_part() of a whole B-spline segment, by the same steps; in place.
HWY_INLINE void bezier_of_spline(Lanes* controls, int stride) {
    const F d;
    Lanes spline[4];
    for (int i = 0; i < 4; ++i) spline[i] = controls[i * stride];
    for (int k = 0; k < 4; ++k) {
        Lanes p[4] = {spline[0], spline[1], spline[2], spline[3]};
        for (int level = 1; level <= 3; ++level)
            for (int i = 0; i + level < 4; ++i) {
                const float low = static_cast<float>(i - 3 + level), high = static_cast<float>(i + 1);
                const float x = ((level - 1 < k ? 1.0f : 0.0f) - low) / (high - low);
                p[i] = hn::Add(hn::Mul(hn::Set(d, 1 - x), p[i]), hn::Mul(hn::Set(d, x), p[i + 1]));
            }
        controls[k * stride] = p[0];
    }
}

/// One coordinate's bounds of the whole faces from lane `first` on.
template <NetForm form>
HWY_INLINE LaneRange bound_lanes(const NetLanes& nets, int k, size_t first) {
    const F d;
    constexpr int kSide = NetSum<form>::kPoints;
    Lanes c[16];
    for (int j = 0; j < kSide; ++j)
        for (int i = 0; i < kSide; ++i)
            c[j * kSide + i] = hn::Load(d, nets.points[NetSum<form>::point(i, j)][k] + first);
    LaneRange whole(c[0]);
    for (int i = 1; i < kSide * kSide; ++i) whole.extend(c[i]);
    if constexpr (form == NetForm::Bezier || form == NetForm::BezierLines) return whole;
    LaneRange box = whole;
    if constexpr (form == NetForm::Bspline) {
        for (int j = 0; j < 4; ++j) bezier_of_spline(c + j * 4, 1);
        for (int i = 0; i < 4; ++i) bezier_of_spline(c + i, 4);
        box = LaneRange(c[0]);
        for (int i = 1; i < 16; ++i) box.extend(c[i]);
    }
    const LaneRange grown = whole.grown();
    box.low = hn::Sub(box.low, hn::Sub(whole.low, grown.low));
    box.high = hn::Add(box.high, hn::Sub(grown.high, whole.high));
    return box;
}

template <NetForm form>
HWY_INLINE void evaluate_all(const NetLanes& nets, const LatticePlan& plan, FaceLattices& lattices) {
    const F d;
    for (size_t first = 0; first < FaceLattices::kFaces; first += hn::Lanes(d)) {
        evaluate_lanes<form>(nets, plan, first, lattices);
        for (int k = 0; k < 3; ++k) {
            const LaneRange range = bound_lanes<form>(nets, k, first);
            hn::Store(range.low, d, lattices.low[k] + first);
            hn::Store(range.high, d, lattices.high[k] + first);
        }
    }
    lattices.bounded = true;
}

void evaluate_nets(const NetLanes& nets, NetForm form, const LatticePlan& plan, FaceLattices& lattices) {
    switch (form) {
        case NetForm::Corners:
            return evaluate_all<NetForm::Corners>(nets, plan, lattices);
        case NetForm::Bspline:
            return evaluate_all<NetForm::Bspline>(nets, plan, lattices);
        case NetForm::Bezier:
            return evaluate_all<NetForm::Bezier>(nets, plan, lattices);
        case NetForm::BezierLines:
            return evaluate_all<NetForm::BezierLines>(nets, plan, lattices);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trapeze {

HWY_EXPORT(evaluate_nets);

void net_lattices(const NetLanes& nets, NetForm form, bool beside, FaceLattices& lattices) {
    HWY_DYNAMIC_DISPATCH(evaluate_nets)
    (nets, form, LatticePlan::of(form, lattices.runs, beside), lattices);
}

}  // namespace trapeze
#endif
