#include "tessellate/surfaces/bezier.h"

#include <algorithm>
#include <cmath>

namespace trapeze {
namespace {

/// sum += p * weight, for all four components.
void add(Control& sum, const Control& p, float weight) {
    for (int k = 0; k < 4; ++k) sum[k] += p[k] * weight;
}

/// The nearer end's value and steps from there: those between equal values are 0, and ends are exact.
float combine(const std::array<float, 4>& c, int degree, const BezierWeights& weights, float t) {
    const float from = c[t < 0.5f ? 0 : degree];
    float steps = 0;
    for (int i = 0; i <= degree; ++i) steps += weights.w[i] * (c[i] - from);
    return from + steps;
}

/// Between two points, exact at both ends.
Control lerp(const Control& a, const Control& b, float t) {
    Control c;
    for (int k = 0; k < 4; ++k) c[k] = a[k] * (1 - t) + b[k] * t;
    return c;
}

/// The blossom of four points a stride apart: de Casteljau's algorithm with a parameter of its own each step.
Control blossom(const Control* p, int stride, int degree, const std::array<float, 3>& t) {
    std::array<Control, 4> q;
    for (int i = 0; i <= degree; ++i) q[i] = p[i * stride];
    for (int step = 0; step < degree; ++step)
        for (int i = 0; i < degree - step; ++i) q[i] = lerp(q[i], q[i + 1], t[step]);
    return q[0];
}

/// Changes degree + 1 control points, a stride apart, into those of the part [lo, hi]: point i of a part is
/// the blossom at lo (degree - i times) and hi (i times).
void restrict_line(Control* p, int stride, int degree, float lo, float hi) {
    std::array<Control, 4> q;
    for (int i = 0; i <= degree; ++i) {
        std::array<float, 3> t;
        for (int step = 0; step < degree; ++step) t[step] = step < degree - i ? lo : hi;
        q[i] = blossom(p, stride, degree, t);
    }
    for (int i = 0; i <= degree; ++i) p[i * stride] = q[i];
}

}  // namespace

/// Bernstein polynomials.
BezierWeights bezier_weights(int degree, float t) {
    const float s = 1 - t;
    if (degree == 1) return {{s, t, 0, 0}, {-1, 1, 0, 0}};
    const float ss = s * s, st = s * t, tt = t * t;
    return {{ss * s, 3 * ss * t, 3 * s * tt, tt * t},
            {-3 * ss, 3 * (ss - 2 * st), 3 * (2 * st - tt), 3 * tt}};
}

/// Along u in each row, then along v: in this order for all, so that patches which share a border row round
/// alike on it.
Control BezierPatch::at(V2f uv) const {
    const BezierWeights u = bezier_weights(degree, uv.x), v = bezier_weights(degree, uv.y);
    Control sum{};
    for (int j = 0; j <= degree; ++j) {
        Control row{};
        for (int i = 0; i <= degree; ++i) add(row, p[j * 4 + i], u.w[i]);
        add(sum, row, v.w[j]);
    }
    return sum;
}

/// As at(), with combine() in place of plain sums, which is what keeps equal values equal.
float BezierPatch::number_at(V2f uv) const {
    const BezierWeights u = bezier_weights(degree, uv.x), v = bezier_weights(degree, uv.y);
    std::array<float, 4> rows{};
    for (int j = 0; j <= degree; ++j) {
        const Control* const row = &p[j * 4];
        rows[j] = combine({row[0][0], row[1][0], row[2][0], row[3][0]}, degree, u, uv.x);
    }
    return combine(rows, degree, v, uv.y);
}

/// Row by row along u, then along v: the sums of each row serve the value and both derivatives.
void BezierPatch::at(V2f uv, Control* value, Control* by_u, Control* by_v) const {
    const BezierWeights u = bezier_weights(degree, uv.x), v = bezier_weights(degree, uv.y);
    *value = *by_u = *by_v = {};
    for (int j = 0; j <= degree; ++j) {
        Control row{}, row_by_u{};
        for (int i = 0; i <= degree; ++i) {
            add(row, p[j * 4 + i], u.w[i]);
            add(row_by_u, p[j * 4 + i], u.d[i]);
        }
        add(*value, row, v.w[j]);
        add(*by_u, row_by_u, v.w[j]);
        add(*by_v, row, v.d[j]);
    }
}

/// The control points of the part, whose hull bounds it far more closely than that of the whole.
BezierPatch BezierPatch::restricted(V2f lo, V2f hi) const {
    // Along u row by row, then along v column by column.
    BezierPatch part = *this;
    for (int j = 0; j <= degree; ++j) restrict_line(&part.p[j * 4], 1, degree, lo.x, hi.x);
    for (int i = 0; i <= degree; ++i) restrict_line(&part.p[i], 4, degree, lo.y, hi.y);
    return part;
}

void BezierCurve::at(float t, Control* value, Control* by_t) const {
    const BezierWeights w = bezier_weights(3, t);
    *value = *by_t = {};
    for (int i = 0; i < 4; ++i) {
        add(*value, p[i], w.w[i]);
        add(*by_t, p[i], w.d[i]);
    }
}

BezierCurve BezierCurve::restricted(float lo, float hi) const {
    BezierCurve part = *this;
    restrict_line(part.p.data(), 1, 3, lo, hi);
    return part;
}

/// Rounded to 0 where a sum is but rounding, so that points which have no weight have none.
M44f bezier_from_basis(const M44f& basis) {
    // The inverse of Bezier's basis; in double, so that Bezier's own comes out as the identity.
    constexpr double kInverse[4][4] = {
        {0, 0, 0, 1}, {0, 0, 1 / 3.0, 1}, {0, 1 / 3.0, 2 / 3.0, 1}, {1, 1, 1, 1}};
    M44f m;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) {
            double sum = 0;
            for (int k = 0; k < 4; ++k) sum += kInverse[i][k] * static_cast<double>(basis[k][j]);
            m[i][j] = std::abs(sum) < 1e-7 ? 0.0f : static_cast<float>(sum);
        }
    return m;
}

/// True of Bezier, B-spline, Catmull-Rom and others at their own steps, whatever points they are given; false
/// for a basis at another's step, where pieces may still meet by their points.
bool pieces_join(const M44f& bezier_from_basis, int step) {
    constexpr float kNone = 1e-6f;
    // Bezier points 0 and 3 are where a piece begins and ends.
    const float *const begin = bezier_from_basis[0], *const end = bezier_from_basis[3];
    for (int i = 0; i < 4 + step; ++i) {  // control points of both pieces
        // The weight of control point i in the end of one piece and in the begin of the next, `step` points
        // further.
        const float by_first = i < 4 ? end[i] : 0.0f, by_next = i >= step ? begin[i - step] : 0.0f;
        if (std::abs(by_first - by_next) > kNone) return false;
    }
    return true;
}

/// The matrix takes control points of the basis to those of Bezier's: the same curve, so that all later work
/// knows one basis.
void to_bezier(const M44f& bezier_from_basis, BezierCurve& curve) {
    const std::array<Control, 4> q = curve.p;
    for (int i = 0; i < 4; ++i) {
        curve.p[i] = {};
        for (int k = 0; k < 4; ++k) add(curve.p[i], q[k], bezier_from_basis[i][k]);
    }
}

/// A basis that is Bezier's already is left alone, to the bit.
void to_bezier(const M44f& u_bezier_from_basis, const M44f& v_bezier_from_basis, BezierPatch& patch) {
    const M44f identity;
    const auto convert = [&](const M44f& m, int along, int across) {
        if (m == identity) return;
        const std::array<Control, 16> q = patch.p;
        for (int line = 0; line < 4; ++line)
            for (int i = 0; i < 4; ++i) {
                Control sum{};
                for (int k = 0; k < 4; ++k) add(sum, q[line * across + k * along], m[i][k]);
                patch.p[line * across + i * along] = sum;
            }
    };
    convert(u_bezier_from_basis, 1, 4);
    convert(v_bezier_from_basis, 4, 1);
}

/// Written as differences from one of the control points: equal numbers stay equal to the bit, while plain
/// weighted sums would be off by rounding.
void numbers_to_bezier(const M44f& u_bezier_from_basis, const M44f& v_bezier_from_basis, BezierPatch& patch) {
    constexpr float kRounding = 1e-6f;
    const auto convert = [&](const M44f& m, int along, int across) {
        for (int line = 0; line < 4; ++line) {
            std::array<float, 4> q;
            for (int k = 0; k < 4; ++k) q[k] = patch.p[line * across + k * along][0];
            for (int i = 0; i < 4; ++i) {
                // From the weightiest, so that patches which share a border begin at the same point.
                const float* const w = m[i];
                const float from = q[std::max_element(w, w + 4) - w];
                float whole = 0, steps = 0;
                for (int k = 0; k < 4; ++k) whole += w[k], steps += w[k] * (q[k] - from);
                // A basis whose weights add up to 1 keeps constants; rounding must not.
                if (std::abs(whole - 1) < kRounding) whole = 1;
                patch.p[line * across + i * along][0] = whole * from + steps;
            }
        }
    };
    convert(u_bezier_from_basis, 1, 4);
    convert(v_bezier_from_basis, 4, 1);
}

}  // namespace trapeze
