#include "shade/vm/kernels/neighbours.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade/vm/kernels/neighbours.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <cmath>

#include "shade/vm/kernels/operands-inl.h"

// Loops over rows, whose beginnings are not aligned, are left to the compiler to vectorise for each target.
HWY_BEFORE_NAMESPACE();
namespace trapeze::vm::HWY_NAMESPACE {
namespace {

constexpr int kMaxRow = 256;        // GridShape counts in bytes
constexpr double kParallel = 1e-5;  // sine of the angle

/// A row of vertices, one float each, on the stack: no grid is wider than GridShape can say.
struct alignas(64) Row {
    float lanes[kMaxRow];
};
struct Row3 {
    Row component[3];
};

/// Along rows, or from row to row.
enum class Axis { U, V };

/// Differences along an axis of row j of a span's plane. Central inside, one-sided at the two ends, for a
/// grid's neighbours in the surface are not known when it is shaded.
HWY_INLINE void difference_u(const float* HWY_RESTRICT row, int count, float* HWY_RESTRICT out) {
    if (count < 2) {
        out[0] = 0;
        return;
    }
    for (int i = 1; i < count - 1; ++i) out[i] = (row[i + 1] - row[i - 1]) * 0.5f;
    out[0] = row[1] - row[0];
    out[count - 1] = row[count - 1] - row[count - 2];
}

/// Central differences within the grid, one-sided ones at its first and last row; in steps of one row,
/// whatever the parameter's own step is.
HWY_INLINE void difference_v(const float* HWY_RESTRICT row, int count, int j, int rows,
                             float* HWY_RESTRICT out) {
    const float* before = j > 0 ? row - count : row;
    const float* after = j + 1 < rows ? row + count : row;
    const float share = j > 0 && j + 1 < rows ? 0.5f : 1.0f;
    for (int i = 0; i < count; ++i) out[i] = (after[i] - before[i]) * share;
}

/// A row of a span. A view that the loops below pass by value: `first` is where the row begins in the planes
/// of the batch.
struct RowOf {
    const GridSpan& span;
    int j;

    int count() const { return span.shape.vertices_u(); }
    size_t first() const { return span.first + static_cast<size_t>(span.shape.row_index(0, j)); }

    void difference(Axis axis, const Operand& value, int k, Row& out) const {
        if (value.lane_mask == 0) {
            std::fill_n(out.lanes, count(), 0.0f);
            return;
        }
        const float* row = value.data + static_cast<size_t>(k) * value.stride + first();
        if (axis == Axis::U)
            difference_u(row, count(), out.lanes);
        else
            difference_v(row, count(), j, span.shape.vertices_v(), out.lanes);
    }
    void differences(Axis axis, const Operand& value, Row3& out) const {
        for (int k = 0; k < 3; ++k) difference(axis, value, k, out.component[k]);
    }
    float* of(const Operand& out, int k = 0) const {
        return out.data + static_cast<size_t>(k) * out.stride + first();
    }
};

/// Calls body(row) for all rows, then gives the lanes after the last vertex its results.
template <class Body>
HWY_INLINE void for_rows(GridSpans spans, size_t lanes, int width, const Operand& out, const Body& body) {
    size_t end = 0;
    for (const GridSpan& span : spans) {
        for (int j = 0; j < span.shape.vertices_v(); ++j) body(RowOf{span, j});
        end = span.first + static_cast<size_t>(span.shape.vertex_count());
    }
    if (end == 0 || end >= lanes) return;
    for (int k = 0; k < width; ++k) {
        float* plane = out.data + static_cast<size_t>(k) * out.stride;
        std::fill(plane + end, plane + lanes, plane[end - 1]);
    }
}

/// a / b for the first `count` vertices of a row; 0 where b is no more than rounding.
HWY_INLINE void divide_rows(const Row& a, const Row& b, float rounding, int count, float* HWY_RESTRICT out) {
    for (int i = 0; i < count; ++i) {
        const bool counts = std::fabs(b.lanes[i]) > rounding;
        const float divisor = counts ? b.lanes[i] : 1;
        out[i] = counts ? a.lanes[i] / divisor : 0;
    }
}

/// A row's derivatives along one parameter, and where they were not found: of two vertices in one place no
/// difference says anything.
struct Derivatives {
    Row3 value;
    bool found[kMaxRow];
    bool all_found;
};

/// Whether p alone changes along an axis, as it does in most rows; and the steps of both parameters.
HWY_INLINE bool is_straight(const RowOf& row, Axis along, const Operand& p, const Operand& q, Row& dp,
                            Row& dq) {
    row.difference(along, p, 0, dp);
    row.difference(along, q, 0, dq);
    int others = 0;
    for (int i = 0; i < row.count(); ++i) others += dq.lanes[i] != 0 || !(dp.lanes[i] != 0);
    return others == 0;
}

/// Where the steps of p are never 0 and q stands still, or the steps of p are known to be equal: a quotient
/// of steps, found everywhere.
HWY_INLINE void straight_derivatives(const RowOf& row, int width, Axis along, const Operand& value,
                                     const Row& dp, float rounding, Derivatives& out) {
    Row step;
    for (int k = 0; k < width; ++k) {
        row.difference(along, value, k, step);
        float* HWY_RESTRICT result = out.value.component[k].lanes;
        for (int i = 0; i < row.count(); ++i)
            result[i] = std::fabs(step.lanes[i]) <= rounding ? 0 : step.lanes[i] / dp.lanes[i];
    }
    out.all_found = true;
}

/// Where borders are snapped to their neighbours' rates, a step along one axis changes both parameters: then
/// the derivatives x_u, x_v solve step_i = x_u du_i + x_v dv_i for the steps along both axes. `p` is the
/// parameter looked for, `q` the other one, `along` the axis that p follows. Steps no greater than `rounding`
/// are none.
HWY_INLINE void row_derivatives(const RowOf& row, int width, Axis along, const Operand& value,
                                const Operand& p, const Operand& q, float rounding, Derivatives& out) {
    constexpr float kLeast = 1e-3f;  // of a determinant, to its terms
    const Axis across = along == Axis::U ? Axis::V : Axis::U;
    Row dp, dq, dp_across, dq_across, step, step_across;
    if (const float over = row.span.steps[along == Axis::U ? 0 : 1]; over != 0) {
        std::fill_n(dp.lanes, row.count(), over);
        return straight_derivatives(row, width, along, value, dp, rounding, out);
    }
    if (is_straight(row, along, p, q, dp, dq))
        return straight_derivatives(row, width, along, value, dp, rounding, out);
    row.difference(across, p, 0, dp_across);
    row.difference(across, q, 0, dq_across);
    bool straight[kMaxRow];
    int missing = 0;
    Row determinant;
    for (int i = 0; i < row.count(); ++i) {
        const float a = dp.lanes[i] * dq_across.lanes[i], b = dp_across.lanes[i] * dq.lanes[i];
        straight[i] = dq.lanes[i] == 0 && dp.lanes[i] != 0;
        out.found[i] = straight[i] || std::fabs(a - b) > kLeast * (std::fabs(a) + std::fabs(b));
        determinant.lanes[i] = straight[i] ? dp.lanes[i] : out.found[i] ? a - b : 1;
        missing += !out.found[i];
    }
    out.all_found = missing == 0;
    for (int k = 0; k < width; ++k) {
        row.difference(along, value, k, step);
        row.difference(across, value, k, step_across);
        for (int i = 0; i < row.count(); ++i) {
            const float solved = step.lanes[i] * dq_across.lanes[i] - step_across.lanes[i] * dq.lanes[i];
            const float top = straight[i] ? step.lanes[i] : solved;
            const float share = straight[i] ? 1 : std::fabs(dq_across.lanes[i]) + std::fabs(dq.lanes[i]);
            const bool counts = out.found[i] && !(std::fabs(top) <= rounding * share);
            out.value.component[k].lanes[i] = counts ? top / determinant.lanes[i] : 0;
        }
    }
}

/// The vertex of a row or column next to one at its end, or one that is inside itself.
int inside_of(int i, int last) {
    if (i > 0 && i < last) return i;
    return i == 0 ? std::min(1, last) : last - 1;
}

/// What is missing at the borders of a grid is as it is inside. At borders a parameter's step may vanish, as
/// at a sphere's pole, and the quotient with it.
void take_from_inside(const Derivatives& inside, const RowOf& row, int width, Derivatives& here) {
    const int last = row.count() - 1;
    for (int i = 0; i <= last; ++i) {
        if (here.found[i]) continue;
        const int from = inside_of(i, last);
        for (int k = 0; k < width; ++k)
            here.value.component[k].lanes[i] = inside.value.component[k].lanes[from];
    }
}

/// Derivatives at all vertices of a row. What is missing in it comes from the row inside the grid.
HWY_INLINE void all_derivatives(const RowOf& row, int width, Axis along, const Operand& value,
                                const Operand& p, const Operand& q, float rounding, Derivatives& here) {
    row_derivatives(row, width, along, value, p, q, rounding, here);
    if (here.all_found) return;
    Derivatives inside;
    row_derivatives({row.span, inside_of(row.j, row.span.shape.vertices_v() - 1)}, width, along, value, p, q,
                    rounding, inside);
    take_from_inside(inside, row, width, here);
}

/// Du or Dv of each component, row by row. `p` is the parameter that `along` follows and `q` the other one:
/// swapped, the same code makes Dv of Du.
HWY_INLINE void differentiate(GridSpans spans, size_t lanes, int width, Axis along, const Operand& value,
                              const Operand& p, const Operand& q, const Operand& out) {
    for_rows(spans, lanes, width, out, [&](const RowOf& row) HWY_ATTR {
        Derivatives here;
        all_derivatives(row, width, along, value, p, q, 0, here);
        for (int k = 0; k < width; ++k)
            std::copy_n(here.value.component[k].lanes, row.count(), row.of(out, k));
    });
}

void along_u(GridSpans spans, size_t lanes, int width, const Operand& value, const Operand& u,
             const Operand& v, const Operand& out) {
    differentiate(spans, lanes, width, Axis::U, value, u, v, out);
}

void along_v(GridSpans spans, size_t lanes, int width, const Operand& value, const Operand& u,
             const Operand& v, const Operand& out) {
    differentiate(spans, lanes, width, Axis::V, value, v, u, out);
}

/// The largest step between a span's values that rounding alone may make, from the largest of them. A uniform
/// value has no steps.
float rounding_of(const GridSpan& span, const Operand& value) {
    if (value.lane_mask == 0) return 0;
    float largest = 0;
    for (const float x : std::span(value.data + span.first, static_cast<size_t>(span.shape.vertex_count())))
        largest = std::max(largest, std::fabs(x));
    return largest * 0x1p-20f;  // some units of the last place
}

/// Where each axis changes one parameter, the quotients of derivatives are those of steps.
void derive_plain_row(const RowOf& row, int width, const Operand& num, const Operand& den, float rounding,
                      const Operand& out) {
    Row of_num, den_u, den_v, first;
    row.difference(Axis::U, den, 0, den_u);
    row.difference(Axis::V, den, 0, den_v);
    for (int k = 0; k < width; ++k) {
        float* HWY_RESTRICT sum = row.of(out, k);
        row.difference(Axis::U, num, k, of_num);
        divide_rows(of_num, den_u, rounding, row.count(), first.lanes);
        row.difference(Axis::V, num, k, of_num);
        divide_rows(of_num, den_v, rounding, row.count(), sum);
        for (int i = 0; i < row.count(); ++i) sum[i] += first.lanes[i];
    }
}

/// Deriv() by the chain rule, where an axis may change both parameters: the sum of (dnum/du) / (dden/du) and
/// (dnum/dv) / (dden/dv) (RISpec 3.2, section 15.1).
void derive_row(const RowOf& row, int width, const Operand& num, const Operand& den, const Operand& u,
                const Operand& v, float rounding, const Operand& out) {
    Derivatives num_u, num_v, den_u, den_v;
    all_derivatives(row, 1, Axis::U, den, u, v, rounding, den_u);
    all_derivatives(row, 1, Axis::V, den, v, u, rounding, den_v);
    all_derivatives(row, width, Axis::U, num, u, v, 0, num_u);
    all_derivatives(row, width, Axis::V, num, v, u, 0, num_v);
    Row first;
    for (int k = 0; k < width; ++k) {
        float* HWY_RESTRICT sum = row.of(out, k);
        divide_rows(num_u.value.component[k], den_u.value.component[0], 0, row.count(), first.lanes);
        divide_rows(num_v.value.component[k], den_v.value.component[0], 0, row.count(), sum);
        for (int i = 0; i < row.count(); ++i) sum[i] += first.lanes[i];
    }
}

/// Deriv(num, den). The rounding of den is measured once for each grid of the batch.
void along_both(GridSpans spans, size_t lanes, int width, const Operand& num, const Operand& den,
                const Operand& u, const Operand& v, const Operand& out) {
    const GridSpan* measured = nullptr;
    float rounding = 0;
    for_rows(spans, lanes, width, out, [&](const RowOf& row) HWY_ATTR {
        if (measured != &row.span) measured = &row.span, rounding = rounding_of(row.span, den);
        Row dp, dq;
        if (is_straight(row, Axis::U, u, v, dp, dq) && is_straight(row, Axis::V, v, u, dp, dq))
            derive_plain_row(row, width, num, den, rounding, out);
        else
            derive_row(row, width, num, den, u, v, rounding, out);
    });
}

/// A triple in doubles.
struct Double3 {
    double x, y, z;
};
HWY_INLINE Double3 at(const Row3& rows, int i) {
    return {rows.component[0].lanes[i], rows.component[1].lanes[i], rows.component[2].lanes[i]};
}
HWY_INLINE double squared(const Double3& v) {
    return v.x * v.x + v.y * v.y + v.z * v.z;
}
/// In doubles, since micropolygons may be slivers.
HWY_INLINE Double3 cross_product(const Double3& a, const Double3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// The length of the product of both differences.
void measure_areas(GridSpans spans, size_t lanes, const Operand& P, const Operand& out) {
    for_rows(spans, lanes, 1, out, [&](const RowOf& row) HWY_ATTR {
        Row3 u, v;
        row.differences(Axis::U, P, u);
        row.differences(Axis::V, P, v);
        float* HWY_RESTRICT area = row.of(out);
        for (int i = 0; i < row.count(); ++i)
            area[i] = static_cast<float>(std::sqrt(squared(cross_product(at(u, i), at(v, i)))));
    });
}

/// Unit normals of a row, zero where the differences are parallel but for rounding. In doubles: differences
/// of neighbouring floats have few digits, and their products fewer.
HWY_INLINE void row_normals(const RowOf& row, const Operand& P, Row3& out) {
    Row3 u, v;
    row.differences(Axis::U, P, u);
    row.differences(Axis::V, P, v);
    const double sign = row.span.reverse_orientation ? -1 : 1;
    for (int i = 0; i < row.count(); ++i) {
        const Double3 a = at(u, i), b = at(v, i), n = cross_product(a, b);
        const double length = squared(n), least = kParallel * kParallel * (squared(a) * squared(b));
        const bool found = length > least;
        const double s = sign / std::sqrt(found ? length : 1);
        out.component[0].lanes[i] = found ? static_cast<float>(n.x * s) : 0;
        out.component[1].lanes[i] = found ? static_cast<float>(n.y * s) : 0;
        out.component[2].lanes[i] = found ? static_cast<float>(n.z * s) : 0;
    }
}

/// Three rows' normals, of which the middle one's gaps are filled from all around.
void fill_gaps(const Row3* above, const Row3& here, const Row3* below, const RowOf& row, const Operand& out) {
    for (int i = 0; i < row.count(); ++i) {
        const Double3 normal = at(here, i);
        if (normal.x != 0 || normal.y != 0 || normal.z != 0) continue;
        Double3 sum{0, 0, 0};
        const auto add_normal = [&](const Row3& from, int at_i) HWY_ATTR {
            const Double3 n = at(from, at_i);
            sum = {sum.x + n.x, sum.y + n.y, sum.z + n.z};
        };
        if (above) add_normal(*above, i);
        if (below) add_normal(*below, i);
        if (i > 0) add_normal(here, i - 1);
        if (i + 1 < row.count()) add_normal(here, i + 1);
        const double length = std::sqrt(squared(sum)), s = length > 0 ? 1 / length : 0;
        row.of(out, 0)[i] = static_cast<float>(sum.x * s);
        row.of(out, 1)[i] = static_cast<float>(sum.y * s);
        row.of(out, 2)[i] = static_cast<float>(sum.z * s);
    }
}

/// Counted without a branch for each vertex: gaps are rare, and this is asked for every row.
HWY_INLINE bool has_gap(const Row3& normals, int count) {
    int gaps = 0;
    for (int i = 0; i < count; ++i)
        gaps += normals.component[0].lanes[i] == 0 && normals.component[1].lanes[i] == 0 &&
                normals.component[2].lanes[i] == 0;
    return gaps > 0;
}

/// Normals of a row from the differences along u and v. Only where some are missing are the rows above and
/// below worked out as well.
void find_normals(GridSpans spans, size_t lanes, const Operand& P, const Operand& out) {
    for_rows(spans, lanes, 3, out, [&](const RowOf& row) HWY_ATTR {
        Row3 here;
        row_normals(row, P, here);
        for (int k = 0; k < 3; ++k) std::copy_n(here.component[k].lanes, row.count(), row.of(out, k));
        if (!has_gap(here, row.count())) return;
        Row3 above, below;
        const bool first = row.j == 0, last = row.j + 1 == row.span.shape.vertices_v();
        if (!first) row_normals({row.span, row.j - 1}, P, above);
        if (!last) row_normals({row.span, row.j + 1}, P, below);
        fill_gaps(first ? nullptr : &above, here, last ? nullptr : &below, row, out);
    });
}

/// |step along u| + |step along v|: how far x goes over one micropolygon. The sum, not the larger: a filter
/// that is too wide blurs, one that is too narrow aliases.
void find_filter_widths(GridSpans spans, size_t lanes, const Operand& x, const Operand& out) {
    for_rows(spans, lanes, 1, out, [&](const RowOf& row) HWY_ATTR {
        Row u, v;
        row.difference(Axis::U, x, 0, u);
        row.difference(Axis::V, x, 0, v);
        float* HWY_RESTRICT width = row.of(out);
        for (int i = 0; i < row.count(); ++i) width[i] = std::fabs(u.lanes[i]) + std::fabs(v.lanes[i]);
    });
}

}  // namespace
}  // namespace trapeze::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trapeze::vm {

HWY_EXPORT(along_u);
HWY_EXPORT(along_v);
HWY_EXPORT(along_both);
HWY_EXPORT(measure_areas);
HWY_EXPORT(find_normals);
HWY_EXPORT(find_filter_widths);

void derivative_u(GridSpans spans, size_t lanes, int width, const Operand& value, const Operand& u,
                  const Operand& v, const Operand& out) {
    HWY_DYNAMIC_DISPATCH(along_u)(spans, lanes, width, value, u, v, out);
}
void derivative_v(GridSpans spans, size_t lanes, int width, const Operand& value, const Operand& u,
                  const Operand& v, const Operand& out) {
    HWY_DYNAMIC_DISPATCH(along_v)(spans, lanes, width, value, u, v, out);
}
void derivative(GridSpans spans, size_t lanes, int width, const Operand& num, const Operand& den,
                const Operand& u, const Operand& v, const Operand& out) {
    HWY_DYNAMIC_DISPATCH(along_both)(spans, lanes, width, num, den, u, v, out);
}
void areas(GridSpans spans, size_t lanes, const Operand& P, const Operand& out) {
    HWY_DYNAMIC_DISPATCH(measure_areas)(spans, lanes, P, out);
}
void calculate_normals(GridSpans spans, size_t lanes, const Operand& P, const Operand& out) {
    HWY_DYNAMIC_DISPATCH(find_normals)(spans, lanes, P, out);
}
void filter_widths(GridSpans spans, size_t lanes, const Operand& x, const Operand& out) {
    HWY_DYNAMIC_DISPATCH(find_filter_widths)(spans, lanes, x, out);
}

}  // namespace trapeze::vm
#endif
