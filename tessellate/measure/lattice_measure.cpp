#include "tessellate/measure/lattice_measure.h"

#include <cstdint>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tessellate/measure/lattice_measure.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target
#include <hwy/highway.h>

#include "core/simd/simd-inl.h"
#include "tessellate/topology/lane_vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {

using F = hn::CappedTag<float, FaceLattices::kFaces>;
using Lanes = hn::Vec<F>;

/// Points of as many faces as there are lanes, in camera space, and in units of the image plane. Rows and
/// columns that the lattice does not have hold nothing.
struct Projected {
    HWY_ALIGN float x[FaceLattices::kFaces], y[FaceLattices::kFaces], z[FaceLattices::kFaces];
    HWY_ALIGN float image_x[FaceLattices::kFaces], image_y[FaceLattices::kFaces];
};

using ProjectedLattice = Projected[FaceLattices::kRows][FaceLattices::kColumns];

/// As transform_point(), and ScreenMetric's test of what is in view.
HWY_INLINE hn::Mask<F> project(const float (&P)[3][FaceLattices::kFaces], size_t first, const M44f& m,
                               Lanes least, Projected& out) {
    const F d;
    const LaneVectors<F> object = {hn::Load(d, P[0] + first), hn::Load(d, P[1] + first),
                                   hn::Load(d, P[2] + first)};
    const LaneVectors<F> p = transformed_points(d, m, object);
    const Lanes scale = hn::Div(hn::Set(d, 1), p.z);
    hn::Store(p.x, d, out.x);
    hn::Store(p.y, d, out.y);
    hn::Store(p.z, d, out.z);
    hn::Store(hn::Mul(p.x, scale), d, out.image_x);
    hn::Store(hn::Mul(p.y, scale), d, out.image_y);
    return hn::And(hn::Gt(p.z, hn::Zero(d)), hn::Ge(hn::Mul(p.z, p.z), hn::Mul(least, p.length2())));
}

/// What pieces count: lengths as they are seen, or the least share of those seen square on.
class PieceLengths {
  public:
    PieceLengths(const ScreenMetric& metric, float least_foreshortening)
        : pixels_x_(hn::Set(F(), metric.pixels_x())),
          pixels_y_(hn::Set(F(), metric.pixels_y())),
          pixels_(hn::Set(F(), metric.pixels())),
          least_(hn::Set(F(), least_foreshortening)) {}

    HWY_INLINE Lanes of(const Projected& p, const Projected& q) const {
        const F d;
        const auto difference = [&](const float* to, const float* from) {
            return hn::Sub(hn::Load(d, to), hn::Load(d, from));
        };
        const Lanes x = hn::Mul(difference(q.image_x, p.image_x), pixels_x_);
        const Lanes y = hn::Mul(difference(q.image_y, p.image_y), pixels_y_);
        const Lanes seen = hn::Sqrt(hn::Add(hn::Mul(x, x), hn::Mul(y, y)));
        const Lanes dx = difference(q.x, p.x), dy = difference(q.y, p.y), dz = difference(q.z, p.z);
        const Lanes own = hn::Sqrt(hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz)));
        const Lanes square_on = hn::Div(hn::Mul(hn::Mul(own, pixels_), hn::Set(d, 2)),
                                        hn::Add(hn::Load(d, p.z), hn::Load(d, q.z)));
        const Lanes at_least = hn::Mul(least_, square_on);
        return hn::IfThenElse(hn::Lt(seen, at_least), at_least, seen);
    }

  private:
    Lanes pixels_x_, pixels_y_, pixels_, least_;
};

/// Adds up a line along u (axis 0) or v, of points that are `step` rows or columns apart.
HWY_INLINE void add_up(const ProjectedLattice& lattice, const PieceLengths& lengths, int axis, int number,
                       int step, int pieces, size_t first, LatticeLine& line) {
    const F d;
    const auto point = [&](int i) -> const Projected& {
        return axis == 0 ? lattice[number][i * step] : lattice[i * step][number];
    };
    Lanes sum = hn::Zero(d), longest = hn::Zero(d);
    for (int i = 0; i < pieces; ++i) {
        const Lanes length = lengths.of(point(i), point(i + 1));
        sum = hn::Add(sum, length);
        longest = hn::IfThenElse(hn::Gt(length, longest), length, longest);
    }
    hn::Store(sum, d, line.sum + first);
    hn::Store(longest, d, line.longest + first);
    line.pieces = pieces;
}

/// The order of operations is that of ScreenMetric::perspective_length() and LineMeasure::of(): estimates
/// must not depend on whether a face was measured alone.
void measure_lanes(const FaceLattices& lattices, const M44f& camera_from_object, const ScreenMetric& metric,
                   float least_foreshortening, LatticeLines& lines) {
    const F d;
    const PieceLengths lengths(metric, least_foreshortening);
    const Lanes least = hn::Set(d, metric.view_cosine() * metric.view_cosine());
    ProjectedLattice lattice;
    lines.measured = 0;
    for (size_t first = 0; first < FaceLattices::kFaces; first += hn::Lanes(d)) {
        hn::Mask<F> in_view = hn::FirstN(d, hn::Lanes(d));
        for (int r = 0; r < FaceLattices::kRows; ++r)
            for (int c = 0; c < FaceLattices::kColumns; ++c)
                if (FaceLattices::has(r, c))
                    in_view = hn::And(
                        in_view, project(lattices.P[r][c], first, camera_from_object, least, lattice[r][c]));
        lines.measured |= mask_bits(d, in_view) << first;
        constexpr int kLast = FaceLattices::kColumns - 1;
        for (int axis = 0; axis < 2; ++axis) {
            // Columns are fourths of the face, rows eighths.
            const int across = axis == 0 ? 2 : 1, along = axis == 0 ? 1 : 2;
            for (int i = 0; i < 3; ++i)
                add_up(lattice, lengths, axis, 2 * i * across, 2 * along, 2, first, lines.two[axis][i]);
            for (int i = 0; i < 5; ++i)
                add_up(lattice, lengths, axis, i * across, along, 4, first, lines.four[axis][i]);
        }
        add_up(lattice, lengths, 1, 0, 1, 8, first, lines.eight[0]);
        add_up(lattice, lengths, 1, kLast, 1, 8, first, lines.eight[1]);
    }
    lines.measured &= lattices.there;
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trapeze {

HWY_EXPORT(measure_lanes);

void measure_lattices(const FaceLattices& lattices, const M44f& camera_from_object,
                      const ScreenMetric& metric, float least_foreshortening, LatticeLines& lines) {
    HWY_DYNAMIC_DISPATCH(measure_lanes)(lattices, camera_from_object, metric, least_foreshortening, lines);
}

}  // namespace trapeze
#endif
