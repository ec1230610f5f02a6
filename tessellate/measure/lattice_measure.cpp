#include "tessellate/measure/lattice_measure.h"

#include <cstdint>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tessellate/measure/lattice_measure.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target
#include <hwy/highway.h>

#include "core/simd/simd-inl.h"
#include "tessellate/topology/lane_vectors-inl.h"

#ifndef TRAPEZE_TESSELLATE_LATTICE_MEASURE_ONCE
#define TRAPEZE_TESSELLATE_LATTICE_MEASURE_ONCE
namespace trapeze {

/// A line's points by their numbers among a lattice's: first + i * step. Those beside it likewise.
struct LineNumbers {
    int first = 0, step = 1, pieces = 4, beside = 0;
};

/// The inner line `number` along an axis, in two pieces or four; beside it lies the one before it, or beside
/// the first one the next (FaceSplitter).
inline LineNumbers inner_line(int axis, int number, int pieces) {
    constexpr int kLines = FaceLattices::kLines;
    const int across = axis == 0 ? kLines : 1, along = axis == 0 ? 1 : kLines;
    const int neighbour = number > 0 ? number - 1 : number + 1;
    return {number * across, along * (4 / pieces), pieces, neighbour * across};
}

/// The edge along a side.
inline LineNumbers side_line(int side, int pieces) {
    return {FaceLattices::side(side, 0), 8 / pieces, pieces, FaceLattices::beside(side, 0)};
}

}  // namespace trapeze
#endif

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {

using F = hn::CappedTag<float, FaceLattices::kFaces>;
using Lanes = hn::Vec<F>;
using LaneVector = LaneVectors<F>;
using LaneMask = hn::Mask<F>;

/// As std::max() and std::min() choose.
HWY_INLINE Lanes larger(Lanes a, Lanes b) {
    return hn::IfThenElse(hn::Lt(a, b), b, a);
}
HWY_INLINE Lanes smaller(Lanes a, Lanes b) {
    return hn::IfThenElse(hn::Lt(b, a), b, a);
}

/// Points of as many faces as there are lanes, at one key: in camera space, and in units of the image plane,
/// where beside ones are not wanted.
struct LaneLattice {
    HWY_ALIGN float at[FaceLattices::kPoints][3][FaceLattices::kFaces];
    HWY_ALIGN float image[FaceLattices::kFirstBeside][2][FaceLattices::kFaces];

    HWY_INLINE LaneVector point(int number) const {
        const F d;
        const float(&p)[3][FaceLattices::kFaces] = at[number];
        return {hn::Load(d, p[0]), hn::Load(d, p[1]), hn::Load(d, p[2])};
    }
};

/// A line's numbers in lanes.
struct LaneEstimate {
    Lanes sum, longest;

    HWY_INLINE LaneEstimate() : sum(hn::Zero(F())), longest(hn::Zero(F())) {}
    HWY_INLINE void add(Lanes length) {
        sum = hn::Add(sum, length);
        longest = hn::IfThenElse(hn::Gt(length, longest), length, longest);
    }
};

/// A piece's lengths: as it is seen, and seen square on.
struct LanePiece {
    Lanes seen, square_on;
};

/// Measures the faces in lanes `first` on. The order of operations is that of ScreenMetric and LineMeasure:
/// estimates must not depend on whether a face was measured alone.
class LaneMeasure {
  public:
    LaneMeasure(std::span<const PlacedLattices> keys, const LatticeMeasure& measure, size_t first,
                LatticeLines& lines)
        : keys_(keys),
          first_(first),
          lines_(lines),
          trusts_(measure.trusts_foreshortening),
          pixels_x_(hn::Set(F(), measure.metric.pixels_x())),
          pixels_y_(hn::Set(F(), measure.metric.pixels_y())),
          pixels_(hn::Set(F(), measure.metric.pixels())),
          least_(hn::Set(F(), measure.least_foreshortening)),
          rate_(hn::Set(F(), measure.pixels_per_segment)),
          flatness_(hn::Set(F(), measure.flatness)),
          lens_radius_(hn::Set(F(), measure.lens_radius)),
          ok_(hn::FirstN(F(), hn::Lanes(F()))) {
        const float cosine = measure.metric.view_cosine();
        for (size_t key = 0; key < keys.size(); ++key) project(keys[key], cosine * cosine, lattices_[key]);
    }

    /// Sets all lines. What no face here asks for is left out: eight pieces where all sides are short,
    /// foreshortening where all pieces are.
    HWY_INLINE void run() {
        const F d;
        Lanes longest = hn::Zero(d), longest_side = hn::Zero(d);
        const auto set = [&](const LineNumbers& numbers, LatticeLine& line) HWY_ATTR {
            const LaneEstimate estimate = length_of(numbers);
            store(estimate, numbers.pieces, line);
            // Of a line as uneven as a split would want it at the least.
            longest =
                larger(longest, hn::Mul(estimate.longest, hn::Set(d, static_cast<float>(numbers.pieces))));
            return estimate.sum;
        };
        for (int axis = 0; axis < 2; ++axis) {
            for (int i = 0; i < 3; ++i) set(inner_line(axis, 2 * i, 2), lines_.two[axis][i]);
            for (int i = 0; i < FaceLattices::kLines; ++i)
                set(inner_line(axis, i, 4), lines_.lengths.four[axis][i]);
        }
        for (int side = 0; side < 4; ++side)
            longest_side = larger(longest_side, set(side_line(side, 4), lines_.lengths.side_four[side]));
        const auto some = [&](Lanes length, float segments) HWY_ATTR {
            return !hn::AllFalse(d, hn::And(hn::Gt(length, hn::Mul(rate_, hn::Set(d, segments))), ok_));
        };
        // A little less than what is asked for, as others divide.
        const bool eight = some(longest_side, 3.99f);
        for (int side = 0; side < 4 && eight; ++side)
            set(side_line(side, 8), lines_.lengths.side_eight[side]);
        if (trusts_ && some(longest, 0.99f)) foreshorten(eight);
        lines_.measured |= mask_bits(d, ok_) << first_;
    }

  private:
    HWY_INLINE void foreshorten(bool eight) {
        for (int axis = 0; axis < 2; ++axis)
            for (int i = 0; i < FaceLattices::kLines; ++i)
                foreshorten(inner_line(axis, i, 4), lines_.seen.four[axis][i]);
        for (int side = 0; side < 4; ++side) {
            foreshorten(side_line(side, 4), lines_.seen.side_four[side]);
            if (eight) foreshorten(side_line(side, 8), lines_.seen.side_eight[side]);
        }
    }

    /// As transform_point(), and ScreenMetric's test of what is in view.
    void project(const PlacedLattices& placed, float least_cosine2, LaneLattice& out) {
        const F d;
        const Lanes least = hn::Set(d, least_cosine2);
        const int points = trusts_ ? FaceLattices::kPoints : FaceLattices::kFirstBeside;
        for (int i = 0; i < points; ++i) {
            const FaceLattices::Point& P = placed.lattices->points[i];
            const LaneVector object = {hn::Load(d, P[0] + first_), hn::Load(d, P[1] + first_),
                                       hn::Load(d, P[2] + first_)};
            const LaneVector p = transformed_points(d, placed.camera_from_object, object);
            hn::Store(p.x, d, out.at[i][0]);
            hn::Store(p.y, d, out.at[i][1]);
            hn::Store(p.z, d, out.at[i][2]);
            if (i >= FaceLattices::kFirstBeside) continue;
            const Lanes scale = hn::Div(hn::Set(d, 1), p.z);
            hn::Store(hn::Mul(p.x, scale), d, out.image[i][0]);
            hn::Store(hn::Mul(p.y, scale), d, out.image[i][1]);
            ok_ = hn::And(ok_, hn::Gt(p.z, hn::Zero(d)));
            ok_ = hn::And(ok_, hn::Ge(hn::Mul(p.z, p.z), hn::Mul(least, p.length2())));
        }
    }

    HWY_INLINE LanePiece piece(const LaneLattice& lattice, int from, int to) const {
        const F d;
        const auto pixels = [&](int axis, Lanes scale) HWY_ATTR {
            return hn::Mul(
                hn::Sub(hn::Load(d, lattice.image[to][axis]), hn::Load(d, lattice.image[from][axis])), scale);
        };
        const Lanes x = pixels(0, pixels_x_), y = pixels(1, pixels_y_);
        const LaneVector p = lattice.point(from), q = lattice.point(to);
        LanePiece piece;
        piece.seen = hn::Sqrt(hn::Add(hn::Mul(x, x), hn::Mul(y, y)));
        const Lanes wide = hn::Mul(hn::Mul(hn::Sqrt(difference(q, p).length2()), pixels_), hn::Set(d, 2));
        piece.square_on = hn::Div(wide, hn::Add(p.z, q.z));
        return piece;
    }

    /// Lengths as they are seen, or the least share of those seen square on.
    HWY_INLINE Lanes counted(const LanePiece& piece) const {
        return larger(piece.seen, hn::Mul(least_, piece.square_on));
    }

    HWY_INLINE LaneEstimate length_of(const LineNumbers& line) const {
        LaneEstimate estimate;
        for (int i = 0; i < line.pieces; ++i) {
            const int from = line.first + i * line.step;
            estimate.add(counted(piece(lattices_[0], from, from + line.step)));
        }
        return estimate;
    }

    HWY_INLINE void store(const LaneEstimate& estimate, int pieces, LatticeLine& line) const {
        const F d;
        hn::Store(estimate.sum, d, line.sum + first_);
        hn::Store(estimate.longest, d, line.longest + first_);
        line.pieces = pieces;
    }

    /// The length of a vector. Imath takes those of tiny ones another way: faces that have such are lost.
    HWY_INLINE Lanes length(const LaneVector& v) {
        const F d;
        const Lanes length2 = v.length2(), zero = hn::Zero(d);
        const LaneMask none = hn::And(hn::And(hn::Eq(v.x, zero), hn::Eq(v.y, zero)), hn::Eq(v.z, zero));
        ok_ = hn::And(ok_, hn::Or(hn::Ge(length2, hn::Set(d, 2 * std::numeric_limits<float>::min())), none));
        return hn::Sqrt(length2);
    }

    /// LineMeasure::slant().
    HWY_INLINE Lanes slant(const LaneVector& p, Lanes distance, const LaneVector& along,
                           const LaneVector& across) const {
        const F d;
        const LaneVector a = cross(p, along), b = cross(p, across);
        const Lanes a2 = dot(a, a), b2 = dot(b, b);
        Lanes lengths = hn::Sqrt(hn::Mul(a2, b2));
        const auto fits = hn::And(hn::Gt(lengths, hn::Zero(d)), hn::Lt(lengths, hn::Set(d, kInfinity)));
        lengths = hn::IfThenElse(fits, lengths, hn::Mul(hn::Sqrt(a2), hn::Sqrt(b2)));
        const Lanes sine = hn::Div(hn::Mul(hn::Abs(dot(p, cross(along, across))), distance), lengths);
        const Lanes root = hn::Sqrt(hn::Div(sine, hn::Set(d, kSlantedSine)));
        const Lanes least = hn::Set(d, kLeastSlant), one = hn::Set(d, 1);
        const Lanes clamped =
            hn::IfThenElse(hn::Lt(root, least), least, hn::IfThenElse(hn::Lt(one, root), one, root));
        return hn::IfThenElse(hn::Gt(lengths, hn::Zero(d)), clamped, one);
    }

    /// How far a line leaves its chord, as bend() of line_measure.cpp.
    HWY_INLINE Lanes bend(const LaneVector& before, const LaneVector& at, const LaneVector& after) {
        const LaneVector chord = difference(after, before);
        const LaneVector second = difference(difference(after, at), difference(at, before));
        const Lanes chord_length = length(chord);
        const LaneMask has_chord = hn::Gt(chord_length, hn::Zero(F()));
        const Lanes over = hn::Div(length(cross(second, chord)), chord_length);
        if (hn::AllTrue(F(), has_chord)) return over;
        return hn::IfThenElse(has_chord, over, length(second));
    }

    /// LineMeasure::foreshortened().
    HWY_INLINE void foreshorten(const LineNumbers& line, LatticeLine& out) {
        const F d;
        constexpr int kMost = LineMeasure::kMostPieces;
        Lanes seen[kMost], least[kMost], most[kMost], scale[kMost];
        const Lanes zero = hn::Zero(d);
        for (int i = 0; i < line.pieces; ++i) least[i] = zero;
        for (size_t key = 0; key < keys_.size(); ++key) {
            const LaneLattice& lattice = lattices_[key];
            const auto number = [&](int i) { return line.first + i * line.step; };
            for (int i = 0; i < line.pieces; ++i) {
                const LanePiece of = piece(lattice, number(i), number(i + 1));
                const LaneVector p = lattice.point(number(i));
                const LaneVector along = difference(lattice.point(number(i + 1)), p);
                const LaneVector across = difference(lattice.point(line.beside + i * line.step), p);
                const Lanes own = length(along), distance = length(p);
                scale[i] = hn::IfThenElseZero(hn::Gt(own, zero), hn::Div(of.square_on, own));
                const Lanes count = hn::Mul(of.seen, slant(p, distance, along, across));
                if (key == 0) seen[i] = count, most[i] = counted(of);
                const Lanes angle = hn::Div(lens_radius_, larger(distance, lens_radius_));
                least[i] = larger(larger(least[i], count), hn::Mul(angle, of.square_on));
            }
            for (int i = 1; i < line.pieces; ++i) {
                const Lanes bent = bend(lattice.point(number(i - 1)), lattice.point(number(i)),
                                        lattice.point(number(i + 1)));
                const Lanes height =
                    hn::Mul(hn::Mul(bent, larger(scale[i - 1], scale[i])), hn::Set(d, 0.125f));
                const Lanes wanted = hn::Mul(rate_, hn::Sqrt(hn::Div(height, flatness_)));
                least[i - 1] = larger(least[i - 1], wanted), least[i] = larger(least[i], wanted);
            }
        }
        LaneEstimate estimate;
        for (int i = 0; i < line.pieces; ++i) estimate.add(larger(seen[i], smaller(most[i], least[i])));
        store(estimate, line.pieces, out);
        const Lanes a = lattices_[0].point(line.first).z,
                    b = lattices_[0].point(line.first + line.pieces * line.step).z;
        const LaneMask deep = hn::Gt(larger(a, b), hn::Mul(hn::Set(d, kDeepestLine), smaller(a, b)));
        out.deep |= mask_bits(d, deep) << first_;
    }

    std::span<const PlacedLattices> keys_;
    size_t first_;
    LatticeLines& lines_;
    bool trusts_;
    Lanes pixels_x_, pixels_y_, pixels_, least_, rate_, flatness_, lens_radius_;
    LaneMask ok_;  ///< measured as others would
    LaneLattice lattices_[LineMeasure::kMostKeys];
};

void measure_lanes(std::span<const PlacedLattices> keys, const LatticeMeasure& measure, LatticeLines& lines) {
    for (size_t first = 0; first < FaceLattices::kFaces; first += hn::Lanes(F()))
        LaneMeasure(keys, measure, first, lines).run();
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trapeze {

HWY_EXPORT(measure_lanes);

void measure_lattices(std::span<const PlacedLattices> keys, const LatticeMeasure& measure,
                      LatticeLines& lines) {
    lines.measured = 0;
    for (LatticeLine& line : lines.seen.side_four) line.deep = 0;
    for (LatticeLine& line : lines.seen.side_eight) line.deep = 0;
    for (auto& axis : lines.seen.four)
        for (LatticeLine& line : axis) line.deep = 0;
    HWY_DYNAMIC_DISPATCH(measure_lanes)(keys, measure, lines);
    for (const PlacedLattices& key : keys) lines.measured &= key.lattices->there;
}

}  // namespace trapeze
#endif
