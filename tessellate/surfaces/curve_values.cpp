#include "tessellate/surfaces/curve_values.h"

#include <algorithm>
#include <cmath>

namespace trapeze {

/// A view of the parameter's floats: nothing is copied until a segment asks.
CurveVariable CurveVariable::of(const Parameter* parameter, int first_component, int count) {
    if (!parameter || parameter->is_string()) return {};
    return {parameter->floats.data() + first_component, parameter->declaration.storage,
            static_cast<size_t>(parameter->declaration.floats_per_item()), count};
}

/// t runs from 0 to 1 over the piece, and derivatives are by it.
void CurvePiece::at(float t, Control* value, Control* by_t) const {
    if (cubic) return curve.at(t, value, by_t);
    // A line: its ends are the first two control points.
    for (int k = 0; k < 4; ++k) {
        (*value)[k] = curve.p[0][k] * (1 - t) + curve.p[1][k] * t;
        (*by_t)[k] = curve.p[1][k] - curve.p[0][k];
    }
}

Control CurvePiece::at(float t) const {
    Control value, by_t;
    at(t, &value, &by_t);
    return value;
}

/// Mixing control points mixes the curves, as these are linear in them.
void CurvePiece::mix(const CurvePiece& other, float share) {
    for (size_t i = 0; i < curve.p.size(); ++i)
        for (int k = 0; k < 4; ++k) curve.p[i][k] += (other.curve.p[i][k] - curve.p[i][k]) * share;
}

/// A line stays a line: its two ends move.
CurvePiece CurvePiece::restricted(float lo, float hi) const {
    if (cubic) return {true, curve.restricted(lo, hi)};
    CurvePiece part;
    part.curve.p[0] = at(lo), part.curve.p[1] = at(hi);
    return part;
}

CurvePieces::CurvePieces(const Curves& curves, const CurveTopology& topology)
    : curves_(curves), topology_(topology) {
    if (curves.cubic) bezier_from_basis_ = bezier_from_basis(curves.basis);
}

/// A class vertex value of a curve's point, as the file gave it and not in Bezier's basis.
Control CurvePieces::control(const CurveVariable& variable, int curve, int point) const {
    // Control points of a periodic curve's last segments are its first again.
    const int vertices = topology_.vertices_of(curve), wrapped = point < vertices ? point : point % vertices;
    const float* const from = variable.values + (topology_.first_vertex(curve) + wrapped) * variable.stride;
    Control value{};
    std::copy_n(from, variable.count, value.begin());
    return value;
}

CurvePiece CurvePieces::piece(const CurveVariable& variable, int curve, int segment) const {
    CurvePiece piece;
    std::array<Control, 4>& p = piece.curve.p;
    const auto value = [&](size_t number, Control& out) {
        std::copy_n(variable.values + number * variable.stride, variable.count, out.begin());
    };
    switch (variable.storage) {
        // One value for all curves, or for this one: the same at both ends.
        case StorageClass::Constant:
        case StorageClass::Uniform:
            value(variable.storage == StorageClass::Constant ? 0 : curve, p[0]);
            p[1] = p[0];
            break;
        case StorageClass::Vertex:
            piece.cubic = curves_.cubic;
            for (int i = 0; i < (piece.cubic ? 4 : 2); ++i)
                p[i] = control(variable, curve, segment * (piece.cubic ? curves_.step : 1) + i);
            if (piece.cubic) to_bezier(bezier_from_basis_, piece.curve);
            break;
        default: {
            // Varying: a value at each joint; that of a periodic curve's last joint is its first.
            const int values = curves_.varying(topology_.vertices_of(curve));
            const size_t first = topology_.first_varying(curve);
            value(first + segment, p[0]);
            value(first + (segment + 1) % values, p[1]);
        }
    }
    return piece;
}

/// Curves of lines always join: they share their control points.
bool joins(const Curves& curves) {
    return !curves.cubic || pieces_join(bezier_from_basis(curves.basis), curves.step);
}

/// Weights are compared and not points, so that the answer is the same at all shape keys. Such curves may
/// have several segments in one face, whose parameter then runs on evenly.
bool joins_smoothly(const Curves& curves) {
    if (!curves.cubic) return false;
    const M44f& b = curves.basis;
    const auto differ = [](float x, float y) { return std::abs(x - y) > 1e-5f; };
    // Weights at a segment's end against those at the start of the next one, whose points are a step further.
    for (int i = 0; i < 4 + curves.step; ++i) {
        const int next = i - curves.step;
        const bool here = i < 4, there = next >= 0 && next < 4;
        const float end = here ? b[0][i] + b[1][i] + b[2][i] + b[3][i] : 0.0f;
        const float end_slope = here ? 3 * b[0][i] + 2 * b[1][i] + b[2][i] : 0.0f;
        if (differ(end, there ? b[3][next] : 0.0f) || differ(end_slope, there ? b[2][next] : 0.0f))
            return false;
    }
    return true;
}

}  // namespace trapeze
