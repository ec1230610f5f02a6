/// The spline() built-in: a curve through, or near, knots that lie at even distances over 0..1 (RISpec 3.2,
/// section 15.1).
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "shade/vm/kernels/kernel.h"

namespace trapeze::vm {

/// In the order of the rules in spline.cpp.
enum class SplineBasis : uint8_t { CatmullRom, Bezier, BSpline, Hermite, Linear, Constant };

/// The basis that shaders call `name`; nothing for an unknown name.
std::optional<SplineBasis> spline_basis(std::string_view name);

/// The basis whose curve PRMan's inverse "solvecatmull-rom" and the like are of; nothing for other names.
/// "constant" has no inverse.
std::optional<SplineBasis> solved_spline_basis(std::string_view name);

/// Operands: out, value, and either the knots one by one or one array of them, all of the output's width (1
/// or 3). The value is clamped to 0..1. A curve starts at the second knot and ends at the last but one (at
/// the first and the last knot for bezier and hermite, where knots are points and tangents in turns). Fewer
/// than 4 knots give 0. Null for other widths.
Kernel find_spline_kernel(SplineBasis basis, int width);

/// The same operands, of width 1: where in 0..1 the curve has the value, which clamps to its ends. The curve
/// has to rise or fall throughout; of others it is one of the places. Null for constant.
Kernel find_spline_inverse(SplineBasis basis);

/// What a shader's spline() with a basis of that name is: find_spline_kernel(), or find_spline_inverse() of
/// one float. Null where there is none.
Kernel find_named_spline(std::string_view name, int width);

}  // namespace trapeze::vm
