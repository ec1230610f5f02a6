#include "tessellate/surfaces/ribbon_rows.h"

#include <algorithm>
#include <array>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tessellate/surfaces/ribbon_rows.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target
#include <hwy/highway.h>

#include "core/simd/simd-inl.h"
#include "tessellate/topology/lane_vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {

using F = hn::CappedTag<float, kRowsAtOnce>;
using Lanes = hn::Vec<F>;

using LaneVector = LaneVectors<F>;

/// A segment's Bezier points in lanes: of several segments, or one and the same.
struct LaneSegment {
    LaneVector P[4];
    Lanes width[4];
    bool cubic_width;
};

/// RibbonRow in lanes, and those that it is right for.
struct LaneRow {
    LaneVector centre, by_t, span, span_by_t;
    hn::Mask<F> ok;
};

/// Bernstein polynomials of degree 3 and their derivatives. Here as below, the order of operations is that of
/// BezierCurve, CurvePiece and CameraFacing for one row.
struct LaneWeights {
    Lanes w[4], d[4];

    explicit LaneWeights(Lanes t) {
        const F f;
        const Lanes two = hn::Set(f, 2), three = hn::Set(f, 3);
        const Lanes s = hn::Sub(hn::Set(f, 1), t);
        const Lanes ss = hn::Mul(s, s), st = hn::Mul(s, t), tt = hn::Mul(t, t);
        w[0] = hn::Mul(ss, s), w[1] = hn::Mul(hn::Mul(three, ss), t);
        w[2] = hn::Mul(hn::Mul(three, s), tt), w[3] = hn::Mul(tt, t);
        d[0] = hn::Mul(hn::Set(f, -3), ss), d[1] = hn::Mul(three, hn::Sub(ss, hn::Mul(two, st)));
        d[2] = hn::Mul(three, hn::Sub(hn::Mul(two, st), tt)), d[3] = hn::Mul(three, tt);
    }
};

HWY_INLINE Lanes combine(const Lanes (&w)[4], Lanes a, Lanes b, Lanes c, Lanes d) {
    const Lanes first = hn::Add(hn::Zero(F()), hn::Mul(a, w[0]));
    return hn::Add(hn::Add(hn::Add(first, hn::Mul(b, w[1])), hn::Mul(c, w[2])), hn::Mul(d, w[3]));
}

HWY_INLINE LaneVector combine(const Lanes (&w)[4], const LaneVector (&p)[4]) {
    return {combine(w, p[0].x, p[1].x, p[2].x, p[3].x), combine(w, p[0].y, p[1].y, p[2].y, p[3].y),
            combine(w, p[0].z, p[1].z, p[2].z, p[3].z)};
}

/// Unit directions across rays and tangents, both in camera space; `ok` loses those that have none at once.
HWY_INLINE LaneVector across(const CameraFacing& facing, const LaneVector& ray, const LaneVector& along,
                             hn::Mask<F>& ok) {
    const F d;
    const Lanes outside = hn::Set(d, facing.outside());
    const LaneVector side = cross(ray, along) * outside;
    constexpr float kParallel = CameraFacing::kParallel;
    const Lanes least = hn::Mul(hn::Mul(hn::Set(d, kParallel * kParallel), ray.length2()), along.length2());
    ok = hn::And(ok, hn::Gt(side.length2(), least));
    const LaneVector object = transformed_vectors(d, facing.object_from_camera(), side);
    const Lanes length2 = object.length2(), length = hn::Sqrt(length2);
    // Imath takes the lengths of tiny vectors another way.
    ok = hn::And(ok, hn::Ge(length2, hn::Set(d, 2 * std::numeric_limits<float>::min())));
    ok = hn::And(ok, hn::Le(length2, hn::Set(d, std::numeric_limits<float>::max())));
    return {hn::Div(object.x, length), hn::Div(object.y, length), hn::Div(object.z, length)};
}

/// The common case of CurvesSurface::across(), for cubic ribbons without normals: lanes where it does not
/// hold lose `ok` and are made again by that.
HWY_INLINE LaneRow row_at(const LaneSegment& segment, const CameraFacing& facing, Lanes t) {
    const F d;
    const LaneWeights weights(t);
    LaneRow row;
    row.centre = combine(weights.w, segment.P);
    row.by_t = combine(weights.d, segment.P);
    const LaneVector chord = difference(segment.P[3], segment.P[0]);
    row.ok = hn::Gt(row.by_t.length2(), hn::Mul(hn::Set(d, kLeastSpeed2), chord.length2()));

    const M44f& m = facing.camera_from_object();
    LaneVector ray = {hn::Zero(d), hn::Zero(d), hn::Set(d, 1)};
    if (facing.is_perspective()) {
        ray = transformed_points(d, m, row.centre);
    }
    const LaneVector unit = across(facing, ray, transformed_vectors(d, m, row.by_t), row.ok);
    const Lanes(&w)[4] = segment.width;
    if (segment.cubic_width) {
        row.span = unit * combine(weights.w, w[0], w[1], w[2], w[3]);
        row.span_by_t = unit * combine(weights.d, w[0], w[1], w[2], w[3]);
    } else {
        const Lanes rest = hn::Sub(hn::Set(d, 1), t);
        row.span = unit * hn::Add(hn::Mul(w[0], rest), hn::Mul(w[1], t));
        row.span_by_t = unit * hn::Sub(w[1], w[0]);
    }
    return row;
}

/// One segment in all lanes.
HWY_INLINE LaneSegment same(const BezierCurve& P, const CurvePiece& width) {
    const F d;
    LaneSegment segment;
    for (int i = 0; i < 4; ++i) {
        segment.P[i] = {hn::Set(d, P.p[i][0]), hn::Set(d, P.p[i][1]), hn::Set(d, P.p[i][2])};
        segment.width[i] = hn::Set(d, width.curve.p[i][0]);
    }
    segment.cubic_width = width.cubic;
    return segment;
}

/// Parameters beyond the last are copies of it, so that lanes hold numbers; bits of the result stand for rows
/// that are left to the caller.
uint32_t rows_of_segment(const BezierCurve& P, const CurvePiece& width, const CameraFacing& facing,
                         std::span<const float> t, std::span<RibbonRow* const> rows) {
    const F d;
    const size_t lanes = hn::Lanes(d);
    HWY_ALIGN float at[kRowsAtOnce];
    HWY_ALIGN float out[12][kRowsAtOnce];
    for (size_t i = 0; i < kRowsAtOnce; ++i) at[i] = t[std::min(i, t.size() - 1)];
    const LaneSegment segment = same(P, width);
    uint32_t ok = 0;
    for (size_t first = 0; first < t.size(); first += lanes) {
        const LaneRow row = row_at(segment, facing, hn::Load(d, at + first));
        const LaneVector* const vectors[] = {&row.centre, &row.by_t, &row.span, &row.span_by_t};
        for (int v = 0; v < 4; ++v) {
            hn::Store(vectors[v]->x, d, out[3 * v] + first);
            hn::Store(vectors[v]->y, d, out[3 * v + 1] + first);
            hn::Store(vectors[v]->z, d, out[3 * v + 2] + first);
        }
        ok |= mask_bits(d, row.ok) << first;
    }
    for (size_t i = 0; i < t.size(); ++i)
        *rows[i] = {{out[0][i], out[1][i], out[2][i]},
                    {out[3][i], out[4][i], out[5][i]},
                    {out[6][i], out[7][i], out[8][i]},
                    {out[9][i], out[10][i], out[11][i]}};
    return ~ok & ((1u << t.size()) - 1);
}

/// The segments of faces from lane `first` on.
HWY_INLINE LaneSegment loaded(const RibbonLanes& lanes, bool cubic_width, size_t first) {
    const F d;
    LaneSegment segment;
    for (int i = 0; i < 4; ++i) {
        segment.P[i] = {hn::Load(d, lanes.P[i][0] + first), hn::Load(d, lanes.P[i][1] + first),
                        hn::Load(d, lanes.P[i][2] + first)};
        segment.width[i] = hn::Load(d, lanes.width[i] + first);
    }
    segment.cubic_width = cubic_width;
    return segment;
}

/// Points of one row, from lane `first` on: `count` of them evenly along u.
HWY_INLINE void store_row(const LaneRow& row, int count, size_t first, FaceLattices::Point* points,
                          int step = 1) {
    const F d;
    for (int i = 0; i < count; ++i) {
        const Lanes u = hn::Set(d, static_cast<float>(i) / static_cast<float>(count - 1) - 0.5f);
        FaceLattices::Point& P = points[i * step];
        hn::Store(hn::Add(row.centre.x, hn::Mul(row.span.x, u)), d, P[0] + first);
        hn::Store(hn::Add(row.centre.y, hn::Mul(row.span.y, u)), d, P[1] + first);
        hn::Store(hn::Add(row.centre.z, hn::Mul(row.span.z, u)), d, P[2] + first);
    }
}

/// Lanes are faces here: the same place of each of sixteen ribbons is made at once.
void lattices_of_segments(std::span<const RibbonLanes> segments, bool cubic_width, const CameraFacing& facing,
                          uint32_t faces, FaceLattices& lattices) {
    const F d;
    using Lattice = FaceLattices;
    constexpr int kLastRow = Lattice::kSidePoints - 1;
    const float count = static_cast<float>(segments.size());
    const int last = static_cast<int>(segments.size()) - 1;
    uint32_t ok = faces;
    for (int r = 0; r <= kLastRow; ++r) {
        const float along = static_cast<float>(r) / kLastRow * count;
        const int number = std::min(static_cast<int>(along), last);
        const Lanes t = hn::Set(d, along - static_cast<float>(number));
        for (size_t first = 0; first < Lattice::kFaces; first += hn::Lanes(d)) {
            const LaneRow row = row_at(loaded(segments[number], cubic_width, first), facing, t);
            ok &= mask_bits(d, row.ok) << first | ~(((1u << hn::Lanes(d)) - 1) << first);
            if (r % 2 == 0)
                store_row(row, Lattice::kLines, first, &lattices.points[Lattice::inner(r / 2, 0)]);
            // The ends of the row lie on the sides u = 0 and u = 1.
            store_row(row, 2, first, &lattices.points[Lattice::side(kLeft, r)],
                      Lattice::side(kRight, 0) - Lattice::side(kLeft, 0));
            if (r == 0 || r == kLastRow)
                store_row(row, Lattice::kSidePoints, first,
                          &lattices.points[Lattice::side(r == 0 ? kBottom : kTop, 0)]);
        }
    }
    lattices.runs = FaceRuns::Upwards;
    lattices.there = ok;
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trapeze {

HWY_EXPORT(rows_of_segment);
HWY_EXPORT(lattices_of_segments);

uint32_t facing_rows(const BezierCurve& P, const CurvePiece& width, const CameraFacing& facing,
                     std::span<const float> t, std::span<RibbonRow* const> rows) {
    return HWY_DYNAMIC_DISPATCH(rows_of_segment)(P, width, facing, t, rows);
}

void facing_lattices(std::span<const RibbonLanes> segments, bool cubic_width, const CameraFacing& facing,
                     uint32_t faces, FaceLattices& lattices) {
    HWY_DYNAMIC_DISPATCH(lattices_of_segments)(segments, cubic_width, facing, faces, lattices);
}

}  // namespace trapeze
#endif
