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

/// Knots that a spline of `count` of them uses: 4 + a multiple of 3 (bezier) or 2 (hermite) or any number
/// from 4. 0 for fewer than 4.
int used_knots(SplineBasis basis, int count);

/// Operands: out, value, and either the knots one by one or one array of them, all of the output's width (1
/// or 3). The value is clamped to 0..1. A curve starts at the second knot and ends at the last but one (at
/// the first and the last knot for bezier and hermite, where knots are points and tangents in turns). Fewer
/// than 4 knots give 0. Null for other widths.
Kernel find_spline_kernel(SplineBasis basis, int width);

}  // namespace trapeze::vm
