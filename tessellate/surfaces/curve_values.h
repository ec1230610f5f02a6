/// Variables along one segment of a curve: cubics in Bezier form, or lines between two values.
#pragma once

#include "core/scene/parameters.h"
#include "tessellate/surfaces/bezier.h"
#include "tessellate/topology/curve_topology.h"

namespace trapeze {

/// A variable's values, in the primitive's arrays, which outlive it; no values: the variable is not there.
struct CurveVariable {
    const float* values = nullptr;
    StorageClass storage = StorageClass::Constant;
    size_t stride = 1;  ///< floats from one value to the next
    int count = 1;      ///< floats wanted of each, up to four

    explicit operator bool() const { return values != nullptr; }
    /// Floats first_component .. first_component + count - 1 of each value; nothing of strings.
    static CurveVariable of(const Parameter* parameter, int first_component, int count);
};

/// A variable over the parameter 0..1 of one segment.
struct CurvePiece {
    bool cubic = false;
    BezierCurve curve;  ///< p[0] and p[1] are the ends of a line

    /// The value at t and its derivative by t.
    void at(float t, Control* value, Control* by_t) const;
    Control at(float t) const;
    /// Goes a share of the way to another piece of the same form: between shape keys.
    void mix(const CurvePiece& other, float share);
    /// Control points, whose hull holds the piece.
    std::span<const Control> hull() const { return {curve.p.data(), cubic ? size_t{4} : size_t{2}}; }
    /// The part from lo to hi, over 0..1 again.
    CurvePiece restricted(float lo, float hi) const;
};

/// Finds the values that shape a segment, by class of variable. Refers to curves and topology, which outlive
/// it.
class CurvePieces {
  public:
    CurvePieces(const Curves& curves, const CurveTopology& topology);

    /// A variable along one segment: constant or linear, and cubic when of class vertex on cubic curves.
    CurvePiece piece(const CurveVariable& variable, int curve, int segment) const;
    /// The value that belongs to a control point of a curve; wraps round periodic ones.
    Control control(const CurveVariable& variable, int curve, int point) const;

  private:
    const Curves& curves_;
    const CurveTopology& topology_;
    /// Set for cubic curves alone.
    M44f bezier_from_basis_;
};

/// Whether segments begin where those before them end, wherever the control points are.
bool joins(const Curves& curves);
/// Whether segments join with one direction and speed whatever the control points are.
bool joins_smoothly(const Curves& curves);

}  // namespace trapeze
