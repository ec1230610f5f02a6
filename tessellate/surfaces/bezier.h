/// Bilinear and bicubic tensor-product patches in Bezier form, of points with up to four components.
#pragma once

#include <array>
#include <span>

#include "core/math.h"

namespace trapeze {

/// A control point: x y z w, or what components are used. Numbers that are no points use the first components
/// as they like.
using Control = std::array<float, 4>;

/// Its first three components.
inline V3f xyz(const Control& c) {
    return {c[0], c[1], c[2]};
}

/// Weights of the control points of degree 1 or 3 and their derivatives, exact at 0 and 1; unused ones are 0.
struct BezierWeights {
    float w[4], d[4];
};
BezierWeights bezier_weights(int degree, float t);

/// A patch over (u, v) in [0,1]^2, of degree 1 or 3 along both; point (i, j) is p[j * 4 + i], i along u. A
/// bilinear patch uses i and j of 0 and 1 alone, at the same places of the array.
struct BezierPatch {
    int degree = 3;
    std::array<Control, 16> p{};

    /// The point at (u, v) in [0,1]^2; rational patches are divided by w by whoever asks.
    Control at(V2f uv) const;
    /// The point and its derivatives by u and v.
    void at(V2f uv, Control* value, Control* by_u, Control* by_v) const;
    /// The first component of a net of numbers. Where control points are equal along u or along v there is
    /// nothing but their value in between, without rounding, as in between.h.
    float number_at(V2f uv) const;
    /// The same surface over a rectangle of its parameters, which becomes 0..1.
    BezierPatch restricted(V2f lo, V2f hi) const;
};

/// A cubic curve in Bezier form.
struct BezierCurve {
    std::array<Control, 4> p{};

    void at(float t, Control* value, Control* by_t) const;
    /// The same curve over a part of its parameter, which becomes 0..1.
    BezierCurve restricted(float lo, float hi) const;
};

/// The matrix that takes four control points of a basis (RISpec 5.2: P(u) = [u^3 u^2 u 1] * basis * points)
/// to Bezier's.
M44f bezier_from_basis(const M44f& basis);

/// Whether pieces of a basis, `step` control points after each other, begin where the one before ends,
/// wherever the control points are.
bool pieces_join(const M44f& bezier_from_basis, int step);

/// Changes four control points of another basis into Bezier form, in place.
void to_bezier(const M44f& bezier_from_basis, BezierCurve& curve);

/// Changes a 4x4 net of numbers of other bases into Bezier form, for BezierPatch::number_at(): equal control
/// points stay equal, where a basis' weights add up to 1.
void numbers_to_bezier(const M44f& u_bezier_from_basis, const M44f& v_bezier_from_basis, BezierPatch& patch);

/// Changes a 4x4 net of other bases into Bezier form, in place; nets that are in Bezier form keep their bits.
void to_bezier(const M44f& u_bezier_from_basis, const M44f& v_bezier_from_basis, BezierPatch& patch);

}  // namespace trapeze
