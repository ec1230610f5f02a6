/// Triangles that cover a polygon with holes.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/math.h"

namespace trapeze {

using V2d = Imath::V2d;

/// Ear clipping, with holes joined to the outline by bridges [Eberly, Triangulation by Ear Clipping].
/// `points` are those of all loops, one after another; the first loop is the outline. Loops may run either
/// way; the triangles, of indices into `points`, run the way of the outline.
///
/// No point is left out, so that polygons which share the outline's points share its edges: n points and h
/// holes make n + 2 h - 2 triangles, each side of a loop belongs to one of them and each diagonal to two.
/// Points on a line may thus leave triangles without area. Holes outside the outline are left out.
/// Loops that cross themselves or each other give as many triangles, that cover about the right thing.
std::vector<std::array<int, 3>> triangulate(std::span<const V2d> points, std::span<const int> loop_sizes);

}  // namespace trapeze
