/// How a micropolygon's steps are mixed to become the axes of an ellipse: what its vertices stand for.
#pragma once

#include "core/math.h"

namespace trapeze {

/// A symmetric matrix: step u becomes uu u + uv v, and step v becomes uv u + vv v.
struct Stretch {
    float uu = 1, uv = 0, vv = 1;

    bool is_finite() const;
};

/// The most that a footprint is longer than its micropolygon; and the most that it is shorter.
inline constexpr float kMostStretch = 4096;

/// For steps that are seen as `u` and `v`, so that no axis of the ellipse that they span is shorter than
/// `least`.
Stretch stretch_to_least(const V2f& u, const V2f& v, float least);

/// For steps that are seen as `u` and `v`: to the ellipse that `a` and `b` span, of which no axis is taken to
/// be shorter than `least`. Not `shrinks`: no axis becomes shorter.
Stretch stretch_to_ellipse(const V2f& u, const V2f& v, const V2f& a, const V2f& b, float least, bool shrinks);

}  // namespace trapeze
