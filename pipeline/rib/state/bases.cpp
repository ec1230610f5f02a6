/// Rows go with powers of u from the third down, columns with the control points (RISpec 5.2).
#include "pipeline/rib/state/bases.h"

namespace trapeze::rib {

M44f bezier_basis() {
    return M44f(-1, 3, -3, 1, 3, -6, 3, 0, -3, 3, 0, 0, 1, 0, 0, 0);
}

/// Hermite's control points are point, tangent, point, tangent, which is why its step is 2; those of the
/// power basis are the coefficients themselves, and no segment shares any.
std::optional<CubicBasis> basis_named(std::string_view name) {
    if (name == "bezier") return CubicBasis{bezier_basis(), 3};
    if (name == "b-spline" || name == "bspline")
        return CubicBasis{M44f(-1, 3, -3, 1, 3, -6, 3, 0, -3, 0, 3, 0, 1, 4, 1, 0) * (1.0f / 6), 1};
    if (name == "catmull-rom")
        return CubicBasis{M44f(-1, 3, -3, 1, 2, -5, 4, -1, -1, 0, 1, 0, 0, 2, 0, 0) * 0.5f, 1};
    if (name == "hermite") return CubicBasis{M44f(2, 1, -2, 1, -3, -2, 3, -1, 0, 1, 0, 0, 1, 0, 0, 0), 2};
    if (name == "power") return CubicBasis{M44f(), 4};
    return {};
}

}  // namespace trapeze::rib
