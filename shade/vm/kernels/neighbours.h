/// Differences between the vertices of grids, and what the shading language makes of them (RISpec 3.2,
/// sections 15.1 and 15.2). A batch's lanes belong to the grids of `spans`, one after the other; lanes past
/// the last get the last vertex's results. A difference is that to the neighbours on both sides over two
/// steps, or one-sided at a grid's border over one; it is 0 for uniform values and across grids of one row.
///
/// Outputs are other planes than inputs. Differences by 0 count as 0, and nothing gives NaN from finite
/// input of moderate size.
#pragma once

#include <cstddef>
#include <span>

#include "shade/vm/kernels/grid_span.h"
#include "shade/vm/kernels/kernel.h"

namespace trapeze::vm {

using GridSpans = std::span<const GridSpan>;

/// Du and Dv: each component's derivative by u or by v: the one that explains its differences along both
/// axes, for at borders that are snapped to a neighbour's rate both parameters change along each. Where
/// vertices share a place there, that of the vertex inside. Spans that have steps: the difference over them.
void derivative_u(GridSpans spans, size_t lanes, int width, const Operand& value, const Operand& u,
                  const Operand& v, const Operand& out);
void derivative_v(GridSpans spans, size_t lanes, int width, const Operand& value, const Operand& u,
                  const Operand& v, const Operand& out);

/// Deriv(num, den) = Du(num) / Du(den) + Dv(num) / Dv(den), without the term whose denominator is 0 but for
/// the rounding of den.
void derivative(GridSpans spans, size_t lanes, int width, const Operand& num, const Operand& den,
                const Operand& u, const Operand& v, const Operand& out);

/// area(P): of the parallelogram of P's differences, as large as the micropolygons around.
void areas(GridSpans spans, size_t lanes, const Operand& P, const Operand& out);

/// calculatenormal(P): of unit length, along the product of P's differences along u and v, or against it
/// where a span's orientation is reversed. Where they are parallel, as at poles and at borders whose vertices
/// share points, the sum of the normals next to it; zero where those have none either.
void calculate_normals(GridSpans spans, size_t lanes, const Operand& P, const Operand& out);

/// How far x moves across a micropolygon: the sum of its absolute differences along u and v.
void filter_widths(GridSpans spans, size_t lanes, const Operand& x, const Operand& out);

/// filterstep(): the share above `edge` of an interval of `width` * `scale` around x, or from x to x2; a step
/// for an empty one. Lane by lane; outputs may be inputs.
void filter_step(size_t lanes, const Operand& edge, const Operand& x, const Operand& width, float scale,
                 const Operand& out);
/// The same for the interval from the lesser of x and x2 to the greater: filterstep() with four arguments.
void filter_step_between(size_t lanes, const Operand& edge, const Operand& x, const Operand& x2,
                         const Operand& out);

}  // namespace trapeze::vm
