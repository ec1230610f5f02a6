#include "tessellate/surfaces/face_evaluation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "tessellate/surfaces/between.h"

namespace trapeze {
namespace {

/// Points at once: loops over lanes are what compilers vectorise.
template <size_t n>
using Lanes = std::array<float, n>;

/// Parameters of up to n points, `count` of which count, the first of them number `first`.
template <size_t n>
struct PointBlock {
    Lanes<n> u, v;
    size_t first, count;

    PointBlock(std::span<const V2f> uv, size_t first_point)
        : first(first_point), count(std::min(n, uv.size() - first_point)) {
        for (size_t l = 0; l < n; ++l) {
            const V2f& at = uv[first + std::min(l, count - 1)];
            u[l] = at.x, v[l] = at.y;
        }
    }
};

/// Calls f for blocks of sixteen points; the last one has as few as hold the rest (neighbours of grids ask
/// for a point or two), and is padded with the last point.
template <class F>
void for_blocks(std::span<const V2f> uv, F&& f) {
    size_t first = 0;
    for (; first + 8 < uv.size(); first += 16) f(PointBlock<16>(uv, first));
    if (first + 4 < uv.size())
        f(PointBlock<8>(uv, first));
    else if (first < uv.size())
        f(PointBlock<4>(uv, first));
}

/// Writes a component of a block's points; padding is dropped.
template <size_t n>
void store(const PointBlock<n>& block, const Lanes<n>& values, int component, const ValueSink& sink) {
    for (size_t l = 0; l < block.count; ++l) sink.at(block.first + l, component) = values[l];
}

/// Weights of the uniform cubic B-spline's four control points, and their derivatives.
template <size_t n>
struct CubicWeights {
    Lanes<n> w[4], d[4];

    explicit CubicWeights(const Lanes<n>& t) {
        constexpr float sixth = 1.0f / 6;
        for (size_t l = 0; l < n; ++l) {
            const float x = t[l], y = 1 - x, xx = x * x, yy = y * y;
            w[0][l] = sixth * (yy * y);
            w[1][l] = sixth * (4 - 3 * (xx * (1 + y)));
            w[2][l] = sixth * (4 - 3 * (yy * (1 + x)));
            w[3][l] = sixth * (xx * x);
            d[0][l] = -0.5f * yy;
            d[1][l] = x * (1.5f * x - 2);
            d[2][l] = y * (2 - 1.5f * y);
            d[3][l] = 0.5f * xx;
        }
    }
};

/// The sum of four products in each lane. Both forms add in the same order, and so round alike; in the second
/// one all lanes share the values.
template <size_t n>
inline void combine(const Lanes<n> (&w)[4], const Lanes<n> (&c)[4], Lanes<n>& sum) {
    for (size_t l = 0; l < n; ++l)
        sum[l] = (w[0][l] * c[0][l] + w[1][l] * c[1][l]) + (w[2][l] * c[2][l] + w[3][l] * c[3][l]);
}

/// Sums in pairs: two chains of half the length, in an order that all callers share.
template <size_t n>
inline void combine(const Lanes<n> (&w)[4], const float* c, int stride, Lanes<n>& sum) {
    const float c0 = c[0], c1 = c[stride], c2 = c[2 * stride], c3 = c[3 * stride];
    for (size_t l = 0; l < n; ++l) sum[l] = (w[0][l] * c0 + w[1][l] * c1) + (w[2][l] * c2 + w[3][l] * c3);
}

/// Bernstein polynomials of a degree, and their derivatives: bezier_weights() in lanes.
template <int degree, size_t n>
struct BernsteinLanes {
    Lanes<n> w[degree + 1], d[degree + 1];

    explicit BernsteinLanes(const Lanes<n>& at) {
        for (size_t l = 0; l < n; ++l) {
            const float t = at[l], s = 1 - t;
            if constexpr (degree == 1) {
                w[0][l] = s, w[1][l] = t, d[0][l] = -1, d[1][l] = 1;
            } else {
                const float ss = s * s, st = s * t, tt = t * t;
                w[0][l] = ss * s, w[1][l] = 3 * ss * t, w[2][l] = 3 * s * tt, w[3][l] = tt * t;
                d[0][l] = -3 * ss, d[1][l] = 3 * (ss - 2 * st), d[2][l] = 3 * (2 * st - tt), d[3][l] = 3 * tt;
            }
        }
    }
};

/// Sums one after another from 0, as BezierPatch::at() does.
template <size_t m, size_t n>
inline void add_up(const Lanes<n> (&w)[m], const Lanes<n> (&c)[m], Lanes<n>& sum) {
    sum = {};
    for (size_t i = 0; i < m; ++i)
        for (size_t l = 0; l < n; ++l) sum[l] += c[i][l] * w[i][l];
}
template <size_t m, size_t n>
inline void add_up(const Lanes<n> (&w)[m], const float* c, int stride, Lanes<n>& sum) {
    sum = {};
    for (size_t i = 0; i < m; ++i)
        for (size_t l = 0; l < n; ++l) sum[l] += c[i * stride] * w[i][l];
}

/// A block of points of a Bezier patch; degree is the patch's.
template <int degree, size_t n>
void evaluate_block(const BezierPatch& patch, const PointBlock<n>& b, const ValueSink& value,
                    const ValueSink& du, const ValueSink& dv) {
    constexpr int kFloats = std::tuple_size_v<Control>;
    const BernsteinLanes<degree, n> u(b.u), v(b.v);
    for (int k = 0; k < 3; ++k) {
        const auto control = [&](int row) { return &patch.p[static_cast<size_t>(row) * 4][0] + k; };
        Lanes<n> row[degree + 1], sum;
        for (int j = 0; j <= degree; ++j) add_up(u.w, control(j), kFloats, row[j]);
        add_up(v.w, row, sum);
        store(b, sum, k, value);
        if (!du) continue;
        add_up(v.d, row, sum);
        store(b, sum, k, dv);
        for (int j = 0; j <= degree; ++j) add_up(u.d, control(j), kFloats, row[j]);
        add_up(v.w, row, sum);
        store(b, sum, k, du);
    }
}

/// Cubic Bezier control points of the part [a, b] of a uniform B-spline segment, by its blossom: the B-spline
/// point i is the blossom at three successive knots out of -2 .. 3. In place if wanted.
void bezier_of_part(const float* spline, int stride, float a, float b, float* bezier) {
    const std::array<float, 4> controls = {spline[0], spline[stride], spline[2 * stride], spline[3 * stride]};
    for (int k = 0; k < 4; ++k) {
        std::array<float, 3> t;
        for (int i = 0; i < 3; ++i) t[i] = i < k ? b : a;
        std::array<float, 4> p = controls;
        for (int level = 1; level <= 3; ++level)
            for (int i = 0; i + level < 4; ++i) {
                // Knots i - 3 + level and i + 1 bound the span of this step.
                const float low = static_cast<float>(i - 3 + level), high = static_cast<float>(i + 1);
                const float x = (t[level - 1] - low) / (high - low);
                p[i] = (1 - x) * p[i] + x * p[i + 1];
            }
        bezier[k * stride] = p[0];
    }
}

}  // namespace

/// Midpoints and centre are averages of the mesh face's corners, taken in one order for all pieces, so that
/// pieces which share one agree.
void piece_corners(const FacePiece& piece, const float* values, int size, float* corners) {
    if (!piece.cut) {
        std::copy_n(values, 4 * size, corners);
        return;
    }
    // Corner i, the midpoint of side i, the centre, the midpoint of side i - 1: see mesh_topology.h.
    const float* here = values + piece.piece * size;
    const float* next = values + piece.next() * size;
    const float* previous = values + piece.previous() * size;
    for (int k = 0; k < size; ++k) {
        float sum = 0;
        for (int i = 0; i < piece.size; ++i) sum += values[i * size + k];
        corners[k] = here[k];
        corners[size + k] = 0.5f * (here[k] + next[k]);
        corners[2 * size + k] = sum / static_cast<float>(piece.size);
        corners[3 * size + k] = 0.5f * (here[k] + previous[k]);
    }
}

/// Both weights of a direction are written out, and not one value and a difference: corners come out exact.
void evaluate_bilinear(const float* corners, int size, std::span<const V2f> uv, ValueSink value, ValueSink du,
                       ValueSink dv) {
    for_blocks(uv, [&]<size_t n>(const PointBlock<n>& b) {
        for (int k = 0; k < size; ++k) {
            const float c0 = corners[k], c1 = corners[size + k], c2 = corners[2 * size + k],
                        c3 = corners[3 * size + k];
            Lanes<n> sum;
            for (size_t l = 0; l < n; ++l)
                sum[l] = (1 - b.v[l]) * ((1 - b.u[l]) * c0 + b.u[l] * c1) +
                         b.v[l] * ((1 - b.u[l]) * c3 + b.u[l] * c2);
            if (value) store(b, sum, k, value);
            if (!du) continue;
            for (size_t l = 0; l < n; ++l) sum[l] = (1 - b.v[l]) * (c1 - c0) + b.v[l] * (c2 - c3);
            store(b, sum, k, du);
            for (size_t l = 0; l < n; ++l) sum[l] = (1 - b.u[l]) * (c3 - c0) + b.u[l] * (c2 - c1);
            store(b, sum, k, dv);
        }
    });
}

void evaluate_linear_piece(const FacePiece& piece, const float* values, int size, std::span<const V2f> uv,
                           ValueSink value, ValueSink du, ValueSink dv) {
    // Most values have few floats: no allocation for them.
    std::array<float, 4 * 16> few;
    std::vector<float> many;
    float* corners = few.data();
    if (size > 16) {
        many.resize(4 * size);
        corners = many.data();
    }
    piece_corners(piece, values, size, corners);
    evaluate_bilinear(corners, size, uv, value, du, dv);
}

void values_on_piece(const FacePiece& piece, const float* corners, std::span<const V2f> uv,
                     std::span<float> values) {
    float c[4];  // going round
    piece_corners(piece, corners, 1, c);
    for (size_t i = 0; i < uv.size(); ++i)
        values[i] = between_corners(c[0], c[1], c[3], c[2], uv[i].x, uv[i].y);
}

/// Rows first, then the column of their results: the derivative by v needs the rows only once.
void evaluate_bspline(const float* controls, int size, std::span<const V2f> uv, ValueSink value, ValueSink du,
                      ValueSink dv) {
    for_blocks(uv, [&]<size_t n>(const PointBlock<n>& b) {
        const CubicWeights<n> u(b.u), v(b.v);
        for (int k = 0; k < size; ++k) {
            // Rows along u first, then the column of rows along v, with the weights of values or of
            // derivatives.
            Lanes<n> row[4], sum;
            for (int j = 0; j < 4; ++j) combine(u.w, controls + j * 4 * size + k, size, row[j]);
            combine(v.w, row, sum);
            if (value) store(b, sum, k, value);
            if (!du) continue;
            combine(v.d, row, sum);
            store(b, sum, k, dv);
            for (int j = 0; j < 4; ++j) combine(u.d, controls + j * 4 * size + k, size, row[j]);
            combine(v.w, row, sum);
            store(b, sum, k, du);
        }
    });
}

void evaluate_bezier(const BezierPatch& patch, std::span<const V2f> uv, ValueSink value, ValueSink du,
                     ValueSink dv) {
    for_blocks(uv, [&]<size_t n>(const PointBlock<n>& b) {
        if (patch.degree == 1)
            evaluate_block<1>(patch, b, value, du, dv);
        else
            evaluate_block<3>(patch, b, value, du, dv);
    });
}

/// Some 32 roundings of a float, by the largest coordinate: more than the few operations of an evaluation can
/// be off.
Box3f grown_by_rounding(Box3f box) {
    if (box.isEmpty()) return box;
    for (int k = 0; k < 3; ++k) {
        const float margin = 4e-6f * std::max(std::abs(box.min[k]), std::abs(box.max[k]));
        box.min[k] -= margin, box.max[k] += margin;
    }
    return box;
}

/// A bilinear rectangle lies in the hull of its own four corners.
Box3f bilinear_bound(const float* corners, V2f lo, V2f hi) {
    const V2f uv[4] = {lo, {hi.x, lo.y}, hi, {lo.x, hi.y}};
    V3f points[4];
    evaluate_bilinear(corners, 3, uv, sink_of(points), {}, {});
    Box3f box;
    for (const V3f& p : points) box.extendBy(p);
    // Rounding is relative to the whole face.
    Box3f whole = box;
    for (int i = 0; i < 4; ++i) whole.extendBy(V3f(corners[3 * i], corners[3 * i + 1], corners[3 * i + 2]));
    const Box3f grown = grown_by_rounding(whole);
    return {box.min - (whole.min - grown.min), box.max + (grown.max - whole.max)};
}

/// By the Bezier control points of the part alone, which lie far closer to it than the B-spline's own. The
/// margins go by the largest coordinates of the whole, as its roundings do.
Box3f bspline_bound(const float* controls, V2f lo, V2f hi) {
    // The rectangle's own Bezier control points, three floats each: their hull holds the surface.
    std::array<float, 48> part;
    Box3f whole;
    for (int i = 0; i < 16; ++i)
        whole.extendBy(V3f(controls[3 * i], controls[3 * i + 1], controls[3 * i + 2]));
    for (int j = 0; j < 4; ++j)
        for (int k = 0; k < 3; ++k)
            bezier_of_part(controls + j * 12 + k, 3, lo.x, hi.x, part.data() + j * 12 + k);
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 3; ++k)
            bezier_of_part(part.data() + i * 3 + k, 12, lo.y, hi.y, part.data() + i * 3 + k);
    Box3f box;
    for (int i = 0; i < 16; ++i) box.extendBy(V3f(part[3 * i], part[3 * i + 1], part[3 * i + 2]));
    const Box3f grown = grown_by_rounding(whole);
    return {box.min - (whole.min - grown.min), box.max + (grown.max - whole.max)};
}

}  // namespace trapeze
