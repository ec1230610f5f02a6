/// Bases of cubic patches and curves, by their names (RISpec 5.2).
#pragma once

#include <optional>
#include <string_view>

#include "core/math.h"

namespace trapeze::rib {

/// A segment of the four control points p0 to p3 is [u^3 u^2 u 1] matrix [p0 p1 p2 p3]^T for u from 0 to 1.
struct CubicBasis {
    M44f matrix;
    int step = 3;  ///< control points from one segment's first to the next one's
};

/// "bezier", "b-spline" (or "bspline"), "catmull-rom", "hermite" and "power", with the steps that RISpec
/// gives them; nothing for other names.
std::optional<CubicBasis> basis_named(std::string_view name);

/// What patches and curves have unless Basis says otherwise. RISpec's default, with a step of 3: neighbouring
/// segments share an end.
M44f bezier_basis();

}  // namespace trapeze::rib
